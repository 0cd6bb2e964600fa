#include "core/task_locks.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "core/error.h"

namespace retrolux {

namespace {

// Byte 0 of the file says that a process is there, byte 1 + id that it is at that task.
constexpr off_t kPresence = 0;

off_t ByteOf(const std::string& id) {
  uint64_t number = 0;
  std::from_chars(id.data(), id.data() + id.size(), number, 16);
  return 1 + static_cast<off_t>(number >> 2);  // of 62 bits, so that it is a place in a file
}

// Whether the lock is ours now. On a file system without locks: yes.
bool Lock(int fd, short type, off_t byte) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return ::fcntl(fd, F_OFD_SETLK, &lock) == 0 || (errno != EAGAIN && errno != EACCES);
}

}  // namespace

TaskLocks::TaskLocks(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "tasks" / ".lock";
  fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd_ < 0) {
    throw InputError::At(file, "", fmt::format("cannot be opened ({})", std::strerror(errno)),
                         "a place that can be written to");
  }
  Lock(fd_, F_RDLCK, kPresence);
}

TaskLocks::~TaskLocks() {
  ::close(fd_);
}

bool TaskLocks::Alone() const {
  const bool alone = Lock(fd_, F_WRLCK, kPresence);
  Lock(fd_, F_RDLCK, kPresence);
  return alone;
}

bool TaskLocks::TryHold(const std::string& id) const {
  return Lock(fd_, F_WRLCK, ByteOf(id));
}

void TaskLocks::Release(const std::string& id) const {
  Lock(fd_, F_UNLCK, ByteOf(id));
}

}  // namespace retrolux
