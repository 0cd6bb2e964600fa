// Long work that goes on where it was: every study cuts its work into tasks and runs them here.
//
// A task is deterministic, independent of all others, and named by the hash of everything that
// defines it; its result is a file of its own (core/task_store.h). So a run may be killed at any
// time, and the same run again does what is missing. Several runs may share a folder: none does
// what another one is at (core/task_locks.h). FOLDER/manifest.json lists the tasks and what they
// have in common: work with other options is refused, so that a folder never mixes results.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/task_store.h"

namespace retrolux {

class TaskLocks;

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
  // tasks that leave more files than their result. Asked of chosen tasks. Null: every result is
  // good.
  std::function<bool(const nlohmann::json& result)> usable;
  // Which tasks this run is to do, by index. Null: all.
  std::function<bool(size_t task)> chosen;
  // No task is begun later than that.
  std::optional<std::chrono::steady_clock::time_point> until;
};

// What has become of the tasks of all stages so far.
struct TaskReport {
  int64_t done_before = 0;            // whose results were there
  int64_t done_now = 0;               // run by this object
  int64_t done_elsewhere = 0;         // by other processes meanwhile
  int64_t out_of_time = 0;            // not begun before TaskLoop::until
  int64_t others = 0;                 // results in the folder that are of no task of this work
  std::vector<std::string> warnings;  // one for each result that was there and could not be used

  // "skipped 4 of 18 tasks (done before); 7 results of other work left alone"; empty if there is
  // nothing to say.
  std::string Text() const;
};

class TaskManifest {
 public:
  // Returns the result of the task of that index. Called from any thread; must give the same result
  // on any number of threads. A result must survive being written as JSON: finite numbers, UTF-8.
  using Work = std::function<nlohmann::json(size_t task)>;

  // For `options` see TaskStore. Makes the folder and its manifest. InputError if it can't be
  // written to, and as CheckSameWork.
  TaskManifest(std::filesystem::path folder, std::string study, nlohmann::json options);
  explicit TaskManifest(TaskStore store);
  ~TaskManifest();

  // Runs those tasks of a stage that are not done and returns the results of all, in their order,
  // as they stand in the files: the same bits whether a task was run now or before. Stages are
  // called one after the other; the tasks of one may follow from the results of those before. Two
  // tasks of a stage must not be defined the same; a task of an earlier stage may come again and is
  // not run again. Must not be called with `chosen` or `until`.
  //
  // If a task fails, the others are still run and kept, and then TasksFailed is thrown. Where the
  // machine gives out (TryAgainError, bad_alloc) no further tasks are begun, and that is thrown on.
  std::vector<nlohmann::json> Run(const std::string& stage, const std::vector<Task>& tasks,
                                  const Work& work, Progress& progress = NoProgress(),
                                  const TaskLoop& loop = {});

  // The same, for results that are too many to be held: returns which tasks are done.
  std::vector<bool> Do(const std::string& stage, const std::vector<Task>& tasks, const Work& work,
                       Progress& progress = NoProgress(), const TaskLoop& loop = {});

  const TaskStore& Store() const { return store_; }
  TaskReport Report() const;

 private:
  class Stage;

  void Settle(bool alone) const;
  std::vector<StoredTask> Enter(const std::string& stage, const std::vector<Task>& tasks);

  TaskStore store_;
  std::unique_ptr<TaskLocks> locks_;
  nlohmann::json manifest_;
  std::set<std::string> ids_;
  TaskReport report_;
};

// InputError if the store's folder holds results of another study, version or of other options; the
// message says what changed. A TaskManifest also refuses where another process is at such work and
// has no result yet.
void CheckSameWork(const TaskStore& store);

// What FOLDER/manifest.json says, null if there is none or it can't be read.
nlohmann::json ReadManifest(const std::filesystem::path& folder);

// How two JSON values differ, for people: "/spp: was 8, is 4; /seed: ..."; empty if they are equal.
std::string Changes(const nlohmann::json& before, const nlohmann::json& now);

}  // namespace retrolux
