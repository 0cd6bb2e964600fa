// Work that survives a crash of one of its tasks. The work is done in a child process; when that
// dies of a signal, another one goes on. Which tasks it was at is known from memory that both
// share: each of them is tried once more, alone and after all others, and given up if it crashes
// then, too.
#pragma once

#include <functional>
#include <string>

namespace retrolux {

// Runs `work` in a child process, again as long as it crashes, and returns its exit code. A crash
// outside of every task is not tried again: exit code 1, or 75 if it was a SIGKILL from outside.
// Ending signals are handed on to the child (128 + signal). What `work` prints must be flushed when
// it returns. To be called before the process has made threads.
int Supervise(const std::function<int()>& work);

// What the tasks of a supervised process tell and ask. Without a supervisor nothing is told, and no
// task is under suspicion.
class TaskWatch {
 public:
  // While it lives, this process is at the task of that id (16 hex digits).
  explicit TaskWatch(const std::string& id);
  ~TaskWatch();
  TaskWatch(const TaskWatch&) = delete;
  TaskWatch& operator=(const TaskWatch&) = delete;

  // Whether a process died while it was at this task: to be tried alone.
  static bool IsSuspect(const std::string& id);
  // How this task alone has made a process die, e.g. "crashed (Segmentation fault)"; else empty.
  static std::string Crash(const std::string& id);

 private:
  size_t slot_;
};

}  // namespace retrolux
