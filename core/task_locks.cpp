#include "core/task_locks.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace retrolux {

namespace {

// Byte 0 of the file says that a process is there, byte 1 that one is beginning, byte 2 + id that
// it is at that task.
constexpr off_t kPresence = 0, kBeginning = 1;

off_t ByteOf(const std::string& id) {
  uint64_t number = 0;
  std::from_chars(id.data(), id.data() + id.size(), number, 16);
  return 2 + static_cast<off_t>(number >> 2);  // of 62 bits, so that it is a place in a file
}

enum class IfHeld { kGiveUp, kWait };

// Whether the lock is ours now. On a file system without locks: yes.
bool Lock(int fd, short type, off_t byte, IfHeld if_held = IfHeld::kGiveUp) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  while (::fcntl(fd, if_held == IfHeld::kWait ? F_OFD_SETLKW : F_OFD_SETLK, &lock) != 0) {
    if (errno != EINTR) return errno != EAGAIN && errno != EACCES;
  }
  return true;
}

// Closed at the end of its scope unless it is kept.
struct OpenFile {
  int fd = -1;
  ~OpenFile() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

TaskLocks::TaskLocks(const std::filesystem::path& folder,
                     const std::function<void(bool alone)>& begin) {
  const std::filesystem::path path = folder / "tasks" / ".lock";
  OpenFile file{::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)};
  if (file.fd < 0) {
    throw InputError::At(path, "", fmt::format("cannot be opened ({})", std::strerror(errno)),
                         "a place that can be written to");
  }
  Lock(file.fd, F_WRLCK, kBeginning, IfHeld::kWait);
  begin(Lock(file.fd, F_WRLCK, kPresence));
  Lock(file.fd, F_RDLCK, kPresence);  // shared with the others from here on
  Lock(file.fd, F_UNLCK, kBeginning);
  fd_ = std::exchange(file.fd, -1);
}

TaskLocks::~TaskLocks() {
  ::close(fd_);
}

bool TaskLocks::TryHold(const std::string& id) const {
  return Lock(fd_, F_WRLCK, ByteOf(id));
}

void TaskLocks::Release(const std::string& id) const {
  Lock(fd_, F_UNLCK, ByteOf(id));
}

}  // namespace retrolux
