// SIGINT, SIGTERM and SIGHUP end the program at once, whatever it is at: files that are not
// finished are removed, and the exit code is 128 + the signal's number. Nothing is lost by that:
// what is finished has its final name, and long work goes on from there (core/task_manifest.h).
#pragma once

#include <csignal>

namespace retrolux {

// The signals that end the program; without those that were ignored when it was started (nohup).
// The calling thread, and those that it makes from then on, no longer take them.
sigset_t BlockEndingSignals();

// Starts the thread that waits for them. To be called once, before other threads are made.
void EndOnSignals(const sigset_t& signals);

}  // namespace retrolux
