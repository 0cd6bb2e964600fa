// Long work that goes on where it was: every study cuts its work into tasks and runs them here.
//
// A task is deterministic, independent of all others, and named by the hash of everything that
// defines it. Its result is a file of its own, FOLDER/tasks/ID.json, that appears whole or not at
// all; which tasks are done is known from these files and from nothing else. So a run may be killed
// at any time, and the same run again does what is missing. A folder may hold results of other
// work: tasks that are defined the same are taken over, all other files are left alone.
// FOLDER/manifest.json lists the tasks for people; it is written and never read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/parallel.h"

namespace retrolux {

struct Task {
  std::string name;  // for people, e.g. "camera front-left, pose start"; no part of what defines it
  nlohmann::json definition;  // what tells it from the other tasks of the study
};

// How the tasks of a stage are run.
struct TaskLoop {
  // Several tasks at once, for many small ones; else one after the other, for tasks that use all
  // threads themselves (a killed run then loses one task at most). The work may call ParallelFor
  // either way.
  bool parallel = true;
  // What progress counts. 0 steps: tasks. Else every task has that many steps, and the work itself
  // tells of each by Progress::Advance.
  std::string unit = "tasks";
  int64_t steps_per_task = 0;
  // A result that is there, but no longer good for anything: false, and the task is done again. For
  // tasks that leave more files than their result. Null: every result is good.
  std::function<bool(const nlohmann::json& result)> usable;
  // Which tasks this run is to do, by index; of the others the results that are there are taken,
  // and null stands for those that are not. Null: all.
  std::function<bool(size_t task)> chosen;
};

// What has become of the tasks of all stages so far.
struct TaskReport {
  int64_t done_before = 0;            // whose results were there
  int64_t done_now = 0;               // run by this object
  int64_t others = 0;                 // results in the folder that are of no task of this work
  std::vector<std::string> warnings;  // one for each result that was there and could not be used

  // "4 of 18 tasks were done before; 7 results of other work left alone"; empty if there is nothing
  // to say.
  std::string Text() const;
};

class TaskManifest {
 public:
  // Returns the result of the task of that index. Called from any thread; must give the same result
  // on any number of threads. A result must survive being written as JSON: finite numbers, UTF-8.
  using Work = std::function<nlohmann::json(size_t task)>;

  // `options` holds every input that the tasks share: scene hash, seeds, options of the study. The
  // version of the program is added here. Makes the folder; InputError if it can't be written to.
  TaskManifest(std::filesystem::path folder, std::string study, nlohmann::json options);

  // Runs those tasks of a stage that are not done (of those that the loop has chosen) and returns
  // the results of all, in their order, as they stand in the files: the same bits whether a task
  // was run now or before. Stages are called one after the other; the tasks of one may follow from
  // the results of those before. Two tasks of a stage must not be defined the same; a task of an
  // earlier stage may come again and is not run again.
  //
  // If a task throws, the others are still run and kept, and then the first failure is thrown on:
  // InputError and TryAgainError as such, others as std::runtime_error. Where the machine gives out
  // (TryAgainError, bad_alloc) no further tasks are begun.
  std::vector<nlohmann::json> Run(const std::string& stage, const std::vector<Task>& tasks,
                                  const Work& work, Progress& progress = NoProgress(),
                                  const TaskLoop& loop = {});

  TaskReport Report() const;

 private:
  struct Entry {
    std::string name;
    nlohmann::json definition;  // whole: study, version, options and the task's own
    std::string id;             // hash of it, 16 hex digits
    bool again = false;         // was a task of an earlier stage too
  };
  std::vector<Entry> Enter(const std::string& stage, const std::vector<Task>& tasks);
  std::filesystem::path ResultFile(const Entry& entry) const;
  nlohmann::json ReadResult(const Entry& entry) const;
  nlohmann::json WriteResult(const Entry& entry, const nlohmann::json& result) const;
  std::vector<size_t> Missing(const std::vector<Entry>& entries, const TaskLoop& loop,
                              std::vector<nlohmann::json>& results);

  std::filesystem::path folder_;
  nlohmann::json manifest_;
  std::set<std::string> ids_;
  TaskReport report_;
};

}  // namespace retrolux
