#include "core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/hash.h"

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

// Six hex digits that stand for a text.
std::string Token(const std::string& text) {
  return HexHash(HashBytes(text)).substr(0, 6);
}

std::string FirstLine(const char* file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

// Where a process lives: a host since it was started, and the namespace that its number is of
// (containers have their own).
struct Home {
  std::string boot, space;
};

const Home& OwnHome() {
  static const Home home = [] {
    std::error_code ignored;
    return Home{Token(FirstLine("/proc/sys/kernel/random/boot_id")),
                Token(fs::read_symlink("/proc/self/ns/pid", ignored).string())};
  }();
  return home;
}

// ".STEM.BOOT-SPACE-PID-RANDOM.partEXT": nobody else's, whoever shares the folder.
fs::path TemporaryBeside(const fs::path& path) {
  const Home& home = OwnHome();
  uint32_t random = 0;
  if (::getentropy(&random, sizeof(random)) != 0) throw std::runtime_error("no random number");
  const std::string name =
      fmt::format(".{}.{}-{}-{}-{:08x}.part{}", path.stem().string(), home.boot, home.space,
                  ::getpid(), random, path.extension().string());
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

struct Owner {
  Home home;
  pid_t pid = 0;
};

// Whose temporary file a name is; nothing for other names.
std::optional<Owner> OwnerOf(const std::string& name) {
  const size_t part = name.rfind(".part");
  if (!name.starts_with('.') || part == std::string::npos || part == 0) return std::nullopt;
  const size_t dot = name.rfind('.', part - 1);
  std::istringstream text(name.substr(dot + 1, part - dot - 1));
  Owner owner;
  std::string pid, random;
  for (std::string* field : {&owner.home.boot, &owner.home.space, &pid, &random})
    std::getline(text, *field, '-');
  const auto [end, error] = std::from_chars(pid.data(), pid.data() + pid.size(), owner.pid);
  if (error != std::errc{} || end != pid.data() + pid.size() || random.size() != 8)
    return std::nullopt;
  return owner;
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

// What is not known to be gone may be at work.
bool IsKnownToBeGone(const Owner& owner) {
  const Home& home = OwnHome();
  return owner.home.boot == home.boot && owner.home.space == home.space && !IsAlive(owner.pid);
}

// The time of the file system, which is that of no host: by a file made now.
std::optional<fs::file_time_type> FileSystemNow(const fs::path& folder) {
  const fs::path probe = TemporaryBeside(folder / "probe");
  const int fd = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) return std::nullopt;
  ::close(fd);
  std::error_code error;
  const fs::file_time_type now = fs::last_write_time(probe, error);
  ::unlink(probe.c_str());
  return error ? std::nullopt : std::optional(now);
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
  constexpr auto kDay = std::chrono::hours(24);
  const std::optional<fs::file_time_type> now = FileSystemNow(folder);
  std::error_code error;
  for (auto file = fs::recursive_directory_iterator(folder, error);
       !error && file != fs::recursive_directory_iterator(); file.increment(error)) {
    const std::optional<Owner> owner = OwnerOf(file->path().filename().string());
    if (!owner) continue;
    std::error_code ignored, no_time;
    const fs::file_time_type written = file->last_write_time(no_time);
    const bool old = now && !no_time && *now - written > kDay;
    if (old || IsKnownToBeGone(*owner)) fs::remove(file->path(), ignored);
  }
}

FileWriter::FileWriter(const fs::path& path) : path_(path), file_(path) {
  fd_ = ::open(file_.Temporary().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd_ < 0) ThrowErrno(path_, "create", errno);
}

FileWriter::~FileWriter() {
  if (fd_ >= 0) ::close(fd_);
}

void FileWriter::Append(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ThrowErrno(path_, "write", errno);
    text.remove_prefix(static_cast<size_t>(written));
  }
}

void FileWriter::Commit() {
  if (::fsync(fd_) != 0) ThrowErrno(path_, "sync", errno);
  // Some file systems tell only here that a write has failed.
  if (::close(std::exchange(fd_, -1)) != 0) ThrowErrno(path_, "close", errno);
  file_.Commit();
}

void WriteTextFile(const fs::path& path, std::string_view text) {
  FileWriter file(path);
  file.Append(text);
  file.Commit();
}

std::string ReadTextFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw InputError::At(path, "", "is a folder", "a file");
  // A device or a pipe could keep us reading for ever.
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw InputError::At(path, "", "is no ordinary file", "a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError::At(path, "", fmt::format("cannot be read ({})", std::strerror(errno)),
                         "a readable file");
  }
  std::string text;
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
    text.append(block.data(), static_cast<size_t>(stream.gcount()));
  if (stream.bad()) {
    throw TryAgainError(
        fmt::format("{}: cannot be read to its end ({})", path.string(), std::strerror(errno)));
  }
  return text;
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
