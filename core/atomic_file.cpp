#include "core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>

#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void ThrowErrno(const fs::path& path, const char* doing, int error) {
  const std::string message =
      fmt::format("{}: cannot {}: {}", path.string(), doing, std::strerror(error));
  if (error == ENOSPC || error == EDQUOT || error == EFBIG || error == ENOMEM) {
    throw TryAgainError(message);
  }
  throw InputError(message + "; expected a place that can be written to");
}

// The temporary files there are. Whoever makes, commits or removes one holds the lock.
struct Unfinished {
  std::mutex lock;
  std::set<fs::path> files;
};

Unfinished& AllUnfinished() {
  static auto* unfinished = new Unfinished;  // never destroyed: threads may outlive main
  return *unfinished;
}

// ".STEM.PID-N.partEXT"
fs::path TemporaryBeside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string name = fmt::format(".{}.{}-{}.part{}", path.stem().string(), ::getpid(),
                                       counter++, path.extension().string());
  return path.parent_path() / name;
}

void SyncFile(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) ThrowErrno(path, "open", errno);
  const int result = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  if (result != 0) ThrowErrno(path, "sync", error);
}

// The process that a temporary file of that name is of; nothing for other names.
std::optional<pid_t> OwnerOf(const std::string& name) {
  const size_t part = name.rfind(".part");
  if (!name.starts_with('.') || part == std::string::npos || part == 0) return std::nullopt;
  const size_t dot = name.rfind('.', part - 1);
  pid_t pid = 0;
  const char* end = name.data() + part;
  const auto [rest, error] = std::from_chars(name.data() + dot + 1, end, pid);
  if (error != std::errc{} || rest == end || *rest != '-') return std::nullopt;
  return pid;
}

// Dead ones that nobody has waited for (zombies) are gone, too.
bool IsAlive(pid_t pid) {
  if (pid <= 0 || (::kill(pid, 0) != 0 && errno == ESRCH)) return false;
  std::ifstream stream(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(stream, text);
  const size_t state = text.rfind(") ");  // after the name, which may hold anything
  return state == std::string::npos || text.size() < state + 3 || text[state + 2] != 'Z';
}

}  // namespace

AtomicFile::AtomicFile(fs::path final_path)
    : final_(std::move(final_path)), temporary_(TemporaryBeside(final_)) {
  std::error_code error;
  const fs::file_status status = fs::status(final_, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    // Renaming over it would replace a device or a pipe.
    throw InputError::At(final_, "", "is no regular file", "the name of a file");
  }
  const std::lock_guard held(AllUnfinished().lock);
  AllUnfinished().files.insert(temporary_);
}

AtomicFile::~AtomicFile() {
  const std::lock_guard held(AllUnfinished().lock);
  AllUnfinished().files.erase(temporary_);
  if (committed_) return;
  std::error_code ignored;  // a destructor can do no more than try
  fs::remove(temporary_, ignored);
}

void AtomicFile::Commit() {
  SyncFile(temporary_);
  const std::lock_guard held(AllUnfinished().lock);
  if (std::rename(temporary_.c_str(), final_.c_str()) != 0) ThrowErrno(final_, "rename", errno);
  committed_ = true;
}

void RemoveUnfinishedFiles() {
  AllUnfinished().lock.lock();  // for good
  for (const fs::path& file : AllUnfinished().files) ::unlink(file.c_str());
}

void RemoveLeftovers(const fs::path& folder) {
  std::error_code error;
  for (auto file = fs::recursive_directory_iterator(folder, error);
       !error && file != fs::recursive_directory_iterator(); file.increment(error)) {
    const std::optional<pid_t> owner = OwnerOf(file->path().filename().string());
    std::error_code ignored;
    if (owner && !IsAlive(*owner)) fs::remove(file->path(), ignored);
  }
}

void WriteTextFile(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  const int fd = ::open(file.Temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) ThrowErrno(path, "create", errno);
  size_t written = 0;
  while (written < text.size()) {
    const ssize_t n = ::write(fd, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      ::close(fd);
      ThrowErrno(path, "write", error);
    }
    written += static_cast<size_t>(n);
  }
  ::close(fd);
  file.Commit();
}

std::string ReadTextFile(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw InputError::At(path, "", "is a folder", "a file");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError::At(path, "", fmt::format("cannot be read ({})", std::strerror(errno)),
                         "a readable file");
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void EnsureWritableFolder(const fs::path& folder) {
  if (folder.empty()) throw InputError("an empty path; expected the name of a folder");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) ThrowErrno(folder, "make the folder", error.value());
  const fs::path probe = TemporaryBeside(folder / "probe");
  const int fd = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) ThrowErrno(folder, "write into the folder", errno);
  ::close(fd);
  ::unlink(probe.c_str());
}

}  // namespace retrolux
