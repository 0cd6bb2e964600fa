#include "core/task_manifest.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/supervisor.h"
#include "core/task_locks.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kManifestSchema = "retrolux/manifest-1";

std::string WhatOf(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "unknown failure";
  }
}

// The failures of a stage, by task.
class Failures {
 public:
  explicit Failures(size_t tasks) : errors_(tasks) {}

  // In a catch block. False: the machine has given out, which is not the task's fault.
  bool Add(size_t task) {
    errors_[task] = std::current_exception();
    try {
      throw;
    } catch (const TryAgainError&) {
      stop_ = true;
    } catch (const std::bad_alloc&) {
      stop_ = true;
    } catch (...) {  // of this task alone
    }
    return !stop_;
  }

  // The machine has given out.
  bool Stop() const { return stop_; }

  // What ends the stage, with the tasks' names. Nothing if there was no failure.
  void Throw(const std::vector<StoredTask>& tasks) const {
    std::vector<std::string> failures;
    for (size_t i = 0; i < errors_.size(); ++i) {
      if (!errors_[i]) continue;
      if (stop_) ThrowOnIfGivenOut(errors_[i], tasks[i].name);
      failures.push_back(fmt::format("{} (number {}): {}", tasks[i].name, i, WhatOf(errors_[i])));
    }
    if (failures.empty()) return;
    const std::string what =
        fmt::format("{} of {} tasks failed; what is done is kept", failures.size(), tasks.size());
    throw TasksFailed(what, std::move(failures));
  }

 private:
  static void ThrowOnIfGivenOut(const std::exception_ptr& error, const std::string& name) {
    try {
      std::rethrow_exception(error);
    } catch (const TryAgainError& e) {
      throw TryAgainError(fmt::format("'{}': {} (what is done is kept)", name, e.what()));
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {  // another task's own
    }
  }

  std::vector<std::exception_ptr> errors_;
  std::atomic<bool> stop_ = false;
};

std::string Shown(const Json& value) {
  const std::string text = value.dump();
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

Json HeadingOf(const TaskStore& store) {
  Json heading = TaskHeading(kManifestSchema);
  heading["study"] = store.Study();
  heading["options"] = store.Options();
  heading["stages"] = Json::array();
  return heading;
}

// Whether a task that the manifest lists is done.
bool HasResults(const Json& manifest, const fs::path& folder) {
  for (const Json& stage : manifest.value("stages", Json::array())) {
    for (const Json& task : stage.value("tasks", Json::array())) {
      if (fs::exists(folder / "tasks" / (task.value("id", "") + ".json"))) return true;
    }
  }
  return false;
}

std::string StageText(const std::string& stage, size_t tasks, size_t done) {
  if (done == 0) return stage;
  return fmt::format("{}, skipped {} of {} (done before)", stage, done, tasks);
}

}  // namespace

Json ReadManifest(const fs::path& folder) {
  const fs::path file = folder / "manifest.json";
  if (!fs::exists(file)) return nullptr;
  Json json = Json::parse(ReadTextFile(file), nullptr, /*allow_exceptions=*/false);
  return json.is_discarded() ? Json() : json;
}

namespace {

// How the work that the folder was begun with differs; empty: not at all, or there is none.
std::string ChangesOf(const Json& before, const TaskStore& store) {
  if (!before.is_object()) return "";
  const Json now = HeadingOf(store);
  std::vector<std::string> changes;
  for (const char* key : {"study", "version", "options"}) {
    const std::string change = Changes(before.value(key, Json()), now.at(key));
    if (!change.empty()) changes.push_back(fmt::format("{}: {}", key, change));
    if (before.value("study", Json()) != now.at("study")) break;  // with options of its own
  }
  return fmt::format("{}", fmt::join(changes, "; "));
}

}  // namespace

void CheckSameWork(const TaskStore& store) {
  const Json before = ReadManifest(store.Folder());
  const std::string changes = ChangesOf(before, store);
  if (changes.empty() || !HasResults(before, store.Folder())) return;
  throw InputError::At(store.Folder(), "", "holds results of other work; " + changes,
                       "another folder, or the options that this one was begun with");
}

std::string Changes(const Json& before, const Json& now) {
  constexpr size_t kShown = 6;
  const Json steps = Json::diff(before, now);
  std::vector<std::string> changes;
  for (const Json& step : steps) {
    const std::string path = step.at("path");
    const Json::json_pointer place(path);
    const std::string was = before.contains(place) ? "was " + Shown(before.at(place)) : "was not";
    const std::string is = now.contains(place) ? "is " + Shown(now.at(place)) : "is no more";
    changes.push_back(fmt::format("{}{}{}, {}", path, path.empty() ? "" : " ", was, is));
  }
  const size_t more = changes.size() > kShown ? changes.size() - kShown : 0;
  changes.resize(changes.size() - more);
  std::string text = fmt::format("{}", fmt::join(changes, "; "));
  if (more > 0) text += fmt::format("; and {} more", more);
  return text;
}

std::string TaskReport::Text() const {
  std::vector<std::string> parts;
  const int64_t all = done_before + done_now + done_elsewhere + out_of_time;
  if (done_before > 0)
    parts.push_back(fmt::format("skipped {} of {} tasks (done before)", done_before, all));
  if (done_elsewhere > 0)
    parts.push_back(fmt::format("{} were done by other processes meanwhile", done_elsewhere));
  if (out_of_time > 0)
    parts.push_back(fmt::format("the time was over before {} of {}", out_of_time, all));
  if (others > 0) parts.push_back(fmt::format("{} results of other work left alone", others));
  return fmt::format("{}", fmt::join(parts, "; "));
}

// The tasks of one stage on their way.
class TaskManifest::Stage {
 public:
  using Sink = std::function<void(size_t task, Json&& result)>;

  Stage(TaskManifest& manifest, const std::vector<StoredTask>& tasks, const Work& work,
        Progress& progress, const TaskLoop& loop, Sink sink)
      : manifest_(manifest),
        store_(manifest.store_),
        tasks_(tasks),
        work_(work),
        progress_(progress),
        loop_(loop),
        sink_(std::move(sink)),
        done_(tasks.size()),
        bad_(tasks.size()),
        failures_(tasks.size()) {}

  std::vector<bool> Run(const std::string& stage, const std::set<std::string>& earlier) {
    std::vector<size_t> missing, suspects;
    for (size_t i = 0; i < tasks_.size(); ++i) {
      if (TakeOver(i)) {
        if (!earlier.contains(tasks_[i].id)) ++manifest_.report_.done_before;
      } else if (!loop_.chosen || loop_.chosen(i)) {
        (TaskWatch::IsSuspect(tasks_[i].id) ? suspects : missing).push_back(i);
      }
    }
    const size_t left = missing.size() + suspects.size();
    progress_.Begin(StageText(stage, tasks_.size(), CountDone()),
                    static_cast<int64_t>(left) * std::max<int64_t>(loop_.steps_per_task, 1),
                    loop_.unit);
    if (loop_.parallel) {
      ParallelFor(static_cast<int64_t>(missing.size()),
                  [&](int64_t i) { Try(missing[static_cast<size_t>(i)]); });
    } else {
      for (const size_t task : missing) Try(task);
    }
    for (const size_t task : suspects) Try(task);  // alone: if it crashes, it is known which
    WaitForOthers();
    progress_.End();
    manifest_.report_.done_now += now_;
    manifest_.report_.done_elsewhere += elsewhere_;
    manifest_.report_.out_of_time += late_;
    failures_.Throw(tasks_);
    return {done_.begin(), done_.end()};
  }

 private:
  size_t CountDone() const {
    return static_cast<size_t>(std::count(done_.begin(), done_.end(), 1));
  }

  // Whether the task's result is there and good, and hands it on.
  bool TakeOver(size_t task) {
    if (!store_.HasResult(tasks_[task])) return false;
    try {
      Json result = store_.Read(tasks_[task]);
      if (loop_.usable && (!loop_.chosen || loop_.chosen(task)) && !loop_.usable(result)) {
        throw InputError::At(store_.ResultFile(tasks_[task]), "", "no longer usable",
                             "all that the task has left");
      }
      sink_(task, std::move(result));
    } catch (const InputError& error) {
      const bool ours = !loop_.chosen || loop_.chosen(task);
      const std::lock_guard held(lock_);
      manifest_.report_.warnings.push_back(fmt::format(
          "{}; '{}' is {} again", error.what(), tasks_[task].name, ours ? "done" : "to be done"));
      bad_[task] = 1;
      return false;
    }
    done_[task] = 1;
    return true;
  }

  // Does the task, unless another process is at it or it is too late.
  void Try(size_t task) {
    if (failures_.Stop()) return;
    if (loop_.until && std::chrono::steady_clock::now() >= *loop_.until) {
      ++late_;
      return;
    }
    if (!manifest_.locks_->TryHold(tasks_[task].id)) {
      const std::lock_guard held(lock_);
      with_others_.push_back(task);
      return;
    }
    Do(task);
    manifest_.locks_->Release(tasks_[task].id);
    if (loop_.steps_per_task == 0) progress_.Advance(1);
  }

  // Nothing may leave it: that would cancel the inner loops of other tasks, silently.
  void Do(size_t task) {
    const StoredTask& stored = tasks_[task];
    try {
      // Another process may have done it since the results were looked through.
      if (!bad_[task] && TakeOver(task)) {
        ++elsewhere_;
        return;
      }
      const std::string crash = TaskWatch::Crash(stored.id);
      if (!crash.empty()) throw std::runtime_error(crash);
      const TaskWatch watch(stored.id);
      sink_(task, store_.Write(stored, work_(task)));
      store_.ClearFailure(stored);
      done_[task] = 1;
      ++now_;
    } catch (...) {
      if (failures_.Add(task)) NoteFailure(task);
    }
  }

  void NoteFailure(size_t task) {
    try {
      store_.WriteFailure(tasks_[task], WhatOf(std::current_exception()));
    } catch (const std::exception&) {  // the stage's own list has it
    }
  }

  // The tasks that other processes were at: takes their results, or does what they left undone.
  void WaitForOthers() {
    constexpr auto kPause = std::chrono::milliseconds(200);
    while (!with_others_.empty() && !failures_.Stop()) {
      std::vector<size_t> tasks;
      tasks.swap(with_others_);
      for (const size_t task : tasks) Try(task);
      if (with_others_.size() == tasks.size()) std::this_thread::sleep_for(kPause);
    }
  }

  TaskManifest& manifest_;
  const TaskStore& store_;
  const std::vector<StoredTask>& tasks_;
  const Work& work_;
  Progress& progress_;
  const TaskLoop& loop_;
  const Sink sink_;
  std::vector<char> done_, bad_;  // by task; bad: what was there could not be used
  Failures failures_;
  std::atomic<int64_t> now_ = 0, elsewhere_ = 0, late_ = 0;
  std::mutex lock_;  // of what follows, and of the report's warnings
  std::vector<size_t> with_others_;
};

TaskManifest::TaskManifest(fs::path folder, std::string study, Json options)
    : TaskManifest(TaskStore(std::move(folder), std::move(study), std::move(options))) {}

TaskManifest::TaskManifest(TaskStore store)
    : store_(std::move(store)), manifest_(HeadingOf(store_)) {
  CheckSameWork(store_);  // before there is a folder
  EnsureWritableFolder(store_.Folder() / "tasks");
  locks_ = std::make_unique<TaskLocks>(store_.Folder(), [&](bool alone) { Settle(alone); });
  RemoveLeftovers(store_.Folder());
}

// A killed process may still have been there when this one began.
TaskManifest::~TaskManifest() {
  RemoveLeftovers(store_.Folder());
}

// What this folder is for is settled by the first who begins, before it has any result.
void TaskManifest::Settle(bool alone) const {
  CheckSameWork(store_);
  const Json before = ReadManifest(store_.Folder());
  const std::string changes = ChangesOf(before, store_);
  if (before.is_object() && changes.empty()) return;
  if (before.is_object() && !alone) {
    throw InputError::At(store_.Folder(), "", "another process is at other work here; " + changes,
                         "another folder, or its options");
  }
  WriteTextFile(store_.Folder() / "manifest.json", manifest_.dump(2) + "\n");
}

std::vector<Json> TaskManifest::Run(const std::string& stage, const std::vector<Task>& tasks,
                                    const Work& work, Progress& progress, const TaskLoop& loop) {
  RETROLUX_CHECK(!loop.chosen && !loop.until, "stage '{}': all results, but not all tasks", stage);
  std::vector<Json> results(tasks.size());
  const std::set<std::string> earlier = ids_;
  const std::vector<StoredTask> stored = Enter(stage, tasks);
  Stage(*this, stored, work, progress, loop, [&](size_t task, Json&& result) {
    results[task] = std::move(result);
  }).Run(stage, earlier);
  return results;
}

std::vector<bool> TaskManifest::Do(const std::string& stage, const std::vector<Task>& tasks,
                                   const Work& work, Progress& progress, const TaskLoop& loop) {
  const std::set<std::string> earlier = ids_;
  const std::vector<StoredTask> stored = Enter(stage, tasks);
  return Stage(*this, stored, work, progress, loop, [](size_t, Json&&) {}).Run(stage, earlier);
}

TaskReport TaskManifest::Report() const {
  TaskReport report = report_;
  for (const fs::directory_entry& file : fs::directory_iterator(store_.Folder() / "tasks")) {
    const fs::path name = file.path().filename();
    if (IsResultName(name) && !ids_.contains(name.stem().string())) ++report.others;
  }
  return report;
}

// Gives the tasks their ids and lists them in the manifest.
std::vector<StoredTask> TaskManifest::Enter(const std::string& stage,
                                            const std::vector<Task>& tasks) {
  std::vector<StoredTask> stored;
  std::set<std::string> ids;
  Json listed = Json::array();
  for (const Task& task : tasks) {
    stored.push_back(store_.Place(task));
    const std::string& id = stored.back().id;
    RETROLUX_CHECK(ids.insert(id).second, "stage '{}': task '{}' is defined as another one", stage,
                   task.name);
    listed.push_back({{"id", id}, {"name", task.name}, {"definition", task.definition}});
  }
  ids_.merge(ids);
  manifest_["stages"].push_back({{"stage", stage}, {"tasks", std::move(listed)}});
  WriteTextFile(store_.Folder() / "manifest.json", manifest_.dump(2) + "\n");
  return stored;
}

}  // namespace retrolux
