// Outputs appear whole or not at all: written beside their final name, synced, then renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace retrolux {

// Writes to Temporary(); Commit() gives it its final name. If never committed, the temporary file
// is removed. Throws InputError if the folder can't be written to, TryAgainError if the disk is
// full.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // The extension is that of the final name, so that writers which choose a format by it work.
  const std::filesystem::path& Temporary() const { return temporary_; }
  void Commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

// Removes the temporary files of all AtomicFiles, and holds up everyone who would make or commit
// one: for a process that is about to end without running destructors.
void RemoveUnfinishedFiles();

// Removes, in the folder and below it, the temporary files of processes that are known to be gone
// (of this host and this container, killed), and those that nobody has written to for a day.
void RemoveLeftovers(const std::filesystem::path& folder);

// Writes a file piece by piece. TryAgainError if the disk is full.
class FileWriter {
 public:
  explicit FileWriter(const std::filesystem::path& path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void Append(std::string_view text);
  void Commit();

 private:
  std::filesystem::path path_;
  AtomicFile file_;
  int fd_ = -1;
};

void WriteTextFile(const std::filesystem::path& path, std::string_view text);

// The whole file. InputError if it can't be read or is no ordinary file.
std::string ReadTextFile(const std::filesystem::path& path);

// Makes the folder and its parents and tries that files can be made in it. InputError if not:
// commands call this before the work, not after it.
void EnsureWritableFolder(const std::filesystem::path& folder);

}  // namespace retrolux
