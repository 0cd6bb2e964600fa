// Who is at which task of a folder. Several processes, on one machine or on several that share the
// folder, may work on the same tasks; none does what another one is at. The locks are the kernel's
// (fcntl, open file description): they are gone with their process, however it ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace retrolux {

class TaskLocks {
 public:
  // Opens FOLDER/tasks/.lock. InputError if it can't be made. While `begin` is called no other
  // process can begin here; `alone`: none is here. What it throws goes on.
  TaskLocks(const std::filesystem::path& folder, const std::function<void(bool alone)>& begin);
  ~TaskLocks();
  TaskLocks(const TaskLocks&) = delete;
  TaskLocks& operator=(const TaskLocks&) = delete;

  // True: the task is this process's until Release. False: another process is at it. Always true on
  // a file system without locks (then work may be done twice; it gives the same files).
  bool TryHold(const std::string& id) const;
  void Release(const std::string& id) const;

 private:
  int fd_ = -1;
};

}  // namespace retrolux
