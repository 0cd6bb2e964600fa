#include "core/task_manifest.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kManifestSchema = "retrolux/manifest-1";
constexpr const char* kResultSchema = "retrolux/task-1";

Json Heading(const char* schema) {
  return {{"schema", schema},
          {"version", RETROLUX_VERSION},
          {"units", "mm, deg, s"},
          {"pixel_origin", "center"}};
}

// A result file ends in the checksum of all bytes before it: that finds damage without reading the
// JSON.
std::string Seal(std::string_view body) {
  return fmt::format(",\"checksum\":\"{}\"}}\n", HexHash(HashBytes(body)));
}

std::string Sealed(const Json& object) {
  std::string text = object.dump();
  text.pop_back();  // the closing brace
  return text + Seal(text);
}

bool IsSealed(std::string_view text) {
  const size_t length = Seal("").size();
  if (text.size() < length) return false;
  return text.substr(text.size() - length) == Seal(text.substr(0, text.size() - length));
}

bool IsResultName(const fs::path& name) {
  const std::string stem = name.stem().string();
  return name.extension() == ".json" && stem.size() == 16 &&
         stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// The failures of a stage, by task.
class Failures {
 public:
  explicit Failures(size_t tasks) : errors_(tasks) {}

  // In a catch block.
  void Add(size_t task) {
    errors_[task] = std::current_exception();
    try {
      throw;
    } catch (const TryAgainError&) {
      stop_ = true;
    } catch (const std::bad_alloc&) {
      stop_ = true;
    } catch (...) {  // of this task alone
    }
  }

  // The machine has given out.
  bool Stop() const { return stop_; }

  // The first one, with the task's name. Nothing if there was none.
  void Throw(const std::vector<Task>& tasks) const {
    const auto failed = [](const std::exception_ptr& error) { return error != nullptr; };
    const auto first = std::find_if(errors_.begin(), errors_.end(), failed);
    if (first == errors_.end()) return;
    const std::string what = fmt::format("task '{}' failed ({} of {} did; what is done is kept): ",
                                         tasks[static_cast<size_t>(first - errors_.begin())].name,
                                         std::count_if(first, errors_.end(), failed), tasks.size());
    try {
      std::rethrow_exception(*first);
    } catch (const InputError& error) {
      throw InputError(what + error.what());
    } catch (const TryAgainError& error) {
      throw TryAgainError(what + error.what());
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw std::runtime_error(what + error.what());
    }
  }

 private:
  std::vector<std::exception_ptr> errors_;
  std::atomic<bool> stop_ = false;
};

std::string StageText(const std::string& stage, size_t tasks, size_t done) {
  if (done == 0) return stage;
  return fmt::format("{}, {} of {} tasks were done before", stage, done, tasks);
}

size_t CountDone(const std::vector<Json>& results) {
  return static_cast<size_t>(std::count_if(results.begin(), results.end(),
                                           [](const Json& result) { return !result.is_null(); }));
}

}  // namespace

std::string TaskReport::Text() const {
  std::string text;
  if (done_before > 0)
    text = fmt::format("{} of {} tasks were done before", done_before, done_before + done_now);
  if (others > 0) {
    text += fmt::format("{}{} results of other work left alone", text.empty() ? "" : "; ", others);
  }
  return text;
}

TaskManifest::TaskManifest(fs::path folder, std::string study, Json options)
    : folder_(std::move(folder)), manifest_(Heading(kManifestSchema)) {
  EnsureWritableFolder(folder_ / "tasks");
  manifest_["study"] = std::move(study);
  manifest_["options"] = std::move(options);
  manifest_["stages"] = Json::array();
}

std::vector<Json> TaskManifest::Run(const std::string& stage, const std::vector<Task>& tasks,
                                    const Work& work, Progress& progress, const TaskLoop& loop) {
  const std::vector<Entry> entries = Enter(stage, tasks);
  std::vector<Json> results(tasks.size());
  const std::vector<size_t> missing = Missing(entries, loop, results);

  Failures failures(tasks.size());
  std::atomic<int64_t> done = 0;
  const auto run = [&](int64_t i) {
    if (failures.Stop()) return;
    const size_t task = missing[static_cast<size_t>(i)];
    // Nothing may leave the loop: that would cancel the inner loops of other tasks, silently.
    try {
      results[task] = WriteResult(entries[task], work(task));
      ++done;
    } catch (...) {
      failures.Add(task);
    }
    if (loop.steps_per_task == 0) progress.Advance(1);
  };
  const auto count = static_cast<int64_t>(missing.size());
  progress.Begin(StageText(stage, tasks.size(), CountDone(results)),
                 count * std::max<int64_t>(loop.steps_per_task, 1), loop.unit);
  if (loop.parallel) {
    ParallelFor(count, run);
  } else {
    for (int64_t i = 0; i < count; ++i) run(i);
  }
  progress.End();
  report_.done_now += done;
  failures.Throw(tasks);
  return results;
}

TaskReport TaskManifest::Report() const {
  TaskReport report = report_;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_ / "tasks")) {
    const fs::path name = file.path().filename();
    if (IsResultName(name) && !ids_.contains(name.stem().string())) ++report.others;
  }
  return report;
}

// Gives the tasks their ids and lists them in the manifest.
std::vector<TaskManifest::Entry> TaskManifest::Enter(const std::string& stage,
                                                     const std::vector<Task>& tasks) {
  std::vector<Entry> entries;
  std::set<std::string> ids;
  Json listed = Json::array();
  for (const Task& task : tasks) {
    Entry entry{task.name,
                {{"study", manifest_["study"]},
                 {"version", manifest_["version"]},
                 {"options", manifest_["options"]},
                 {"task", task.definition}},
                "",
                false};
    entry.id = HexHash(HashBytes(entry.definition.dump()));
    entry.again = ids_.contains(entry.id);
    RETROLUX_CHECK(ids.insert(entry.id).second, "stage '{}': task '{}' is defined as another one",
                   stage, task.name);
    listed.push_back({{"id", entry.id}, {"name", task.name}, {"definition", task.definition}});
    entries.push_back(std::move(entry));
  }
  ids_.merge(ids);
  manifest_["stages"].push_back({{"stage", stage}, {"tasks", std::move(listed)}});
  WriteTextFile(folder_ / "manifest.json", manifest_.dump(2) + "\n");
  return entries;
}

fs::path TaskManifest::ResultFile(const Entry& entry) const {
  return folder_ / "tasks" / (entry.id + ".json");
}

// InputError if what is there is not the result of this task.
Json TaskManifest::ReadResult(const Entry& entry) const {
  const fs::path file = ResultFile(entry);
  const std::string text = ReadTextFile(file);
  if (!IsSealed(text)) throw InputError::At(file, "", "damaged", "a whole file");
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  const Json* result = nullptr;
  if (json.is_object() && json.value("schema", Json()) == kResultSchema &&
      json.value("id", Json()) == entry.id &&
      json.value("definition", Json()).dump() == entry.definition.dump() &&
      json.contains("result")) {
    result = &json["result"];
  }
  if (!result) throw InputError::At(file, "", "not of this task", "the result of " + entry.name);
  return *result;
}

// Returns what ReadResult will.
Json TaskManifest::WriteResult(const Entry& entry, const Json& result) const {
  Json json = Heading(kResultSchema);
  json["id"] = entry.id;
  json["definition"] = entry.definition;
  json["result"] = result;
  const std::string text = Sealed(json);
  Json written = Json::parse(text)["result"];
  RETROLUX_CHECK(written == result, "task '{}': a result that JSON cannot hold (NaN?)", entry.name);
  WriteTextFile(ResultFile(entry), text);
  return written;
}

// The tasks that have to be run; of the others, the results.
std::vector<size_t> TaskManifest::Missing(const std::vector<Entry>& entries, const TaskLoop& loop,
                                          std::vector<Json>& results) {
  std::vector<size_t> missing;
  for (size_t i = 0; i < entries.size(); ++i) {
    const fs::path file = ResultFile(entries[i]);
    bool done = false;
    if (fs::exists(file)) {
      try {
        results[i] = ReadResult(entries[i]);
        done = !loop.usable || loop.usable(results[i]);
        if (!done) {
          results[i] = nullptr;
          throw InputError::At(file, "", "no longer usable", "all that the task has left");
        }
      } catch (const InputError& error) {
        report_.warnings.push_back(
            fmt::format("{}; '{}' is done again", error.what(), entries[i].name));
      }
    }
    if (!done) {
      if (!loop.chosen || loop.chosen(i)) missing.push_back(i);
    } else if (!entries[i].again) {
      ++report_.done_before;
    }
  }
  return missing;
}

}  // namespace retrolux
