// The results of tasks as files: FOLDER/tasks/ID.json, where ID is the hash of everything that
// defines the task. A result appears whole or not at all and ends in its checksum, so that whether
// a task is done is known from its file and from nothing else.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace retrolux {

struct Task {
  std::string name;  // for people, e.g. "camera front-left, pose start"; no part of what defines it
  nlohmann::json definition;  // what tells it from the other tasks of the study
};

// A task with its place in a folder.
struct StoredTask {
  std::string name;
  nlohmann::json definition;  // whole: study, version, options and the task's own
  std::string id;             // hash of it, 16 hex digits
};

class TaskStore {
 public:
  // `options` holds every input that the tasks share: scene hash, seeds, options of the study. The
  // version of the program is added here. Touches no file.
  TaskStore(std::filesystem::path folder, std::string study, nlohmann::json options);

  const std::filesystem::path& Folder() const { return folder_; }
  const std::string& Study() const { return study_; }
  const nlohmann::json& Options() const { return options_; }

  StoredTask Place(const Task& task) const;
  std::filesystem::path ResultFile(const StoredTask& task) const;
  bool HasResult(const StoredTask& task) const;

  // InputError if what is there is not the whole result of this task.
  nlohmann::json Read(const StoredTask& task) const;
  // Returns what Read will. A result must survive being written as JSON: finite numbers, UTF-8.
  nlohmann::json Write(const StoredTask& task, const nlohmann::json& result) const;

  // Why the task failed when it was last tried, FOLDER/tasks/ID.failure.json; empty if it did not,
  // or has been done since. For people: nothing is decided by it.
  std::string Failure(const StoredTask& task) const;
  void WriteFailure(const StoredTask& task, const std::string& what) const;
  void ClearFailure(const StoredTask& task) const;

 private:
  std::filesystem::path FailureFile(const StoredTask& task) const;

  std::filesystem::path folder_;
  std::string study_;
  nlohmann::json options_;
};

// Whether a file of that name in FOLDER/tasks is a result.
bool IsResultName(const std::filesystem::path& name);

// First keys of the JSON files that tasks leave.
nlohmann::json TaskHeading(const char* schema);

}  // namespace retrolux
