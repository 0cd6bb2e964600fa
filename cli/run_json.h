// run.json of a study: what was run, when, on what, how fast.
#pragma once

#include <chrono>
#include <filesystem>

#include "cli/commands.h"
#include "core/task_manifest.h"
#include "core/thread_limit.h"

namespace retrolux::cli {

// What has become of a study's tasks, for run.json and --json.
nlohmann::json TasksJson(const TaskReport& report);

// The threads that a command works on, and why.
ThreadLimit ThreadsOf(const GlobalOptions& global);

// Times a study from its making; after a crash that it got over, from the beginning of the process
// that went on.
class StudyRun {
 public:
  explicit StudyRun(const GlobalOptions& global);
  double Seconds() const;
  // run.json into `folder`, which is that of --out or below it, with the study's own figures merged
  // in.
  void Write(const std::filesystem::path& folder, const nlohmann::json& figures) const;

 private:
  const GlobalOptions& global_;
  std::string started_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace retrolux::cli
