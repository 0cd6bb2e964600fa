#include "core/interrupt.h"

#include <unistd.h>

#include <array>
#include <thread>

#include "core/atomic_file.h"
#include "core/say.h"

namespace retrolux {

namespace {

[[noreturn]] void WaitAndEnd(const sigset_t& signals) {
  int signal = 0;
  while (::sigwait(&signals, &signal) != 0) {
  }
  RemoveUnfinishedFiles();
  if (::isatty(STDERR_FILENO) != 0) Say("\n");  // leaves the progress bar's line
  Tell("interrupted; what is finished is kept, the same command goes on from there");
  ::_exit(128 + signal);
}

}  // namespace

sigset_t BlockEndingSignals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) ::sigaddset(&signals, signal);
  }
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void EndOnSignals(const sigset_t& signals) {
  std::thread([signals] { WaitAndEnd(signals); }).detach();
}

}  // namespace retrolux
