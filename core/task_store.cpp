#include "core/task_store.h"

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kResultSchema = "retrolux/task-1";
constexpr const char* kFailureSchema = "retrolux/task-failure-1";

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

}  // namespace

Json TaskHeading(const char* schema) {
  return {{"schema", schema},
          {"version", RETROLUX_VERSION},
          {"units", "mm, deg, s"},
          {"pixel_origin", "center"}};
}

bool IsResultName(const fs::path& name) {
  const std::string stem = name.stem().string();
  return name.extension() == ".json" && stem.size() == 16 &&
         stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

TaskStore::TaskStore(fs::path folder, std::string study, Json options)
    : folder_(std::move(folder)), study_(std::move(study)), options_(std::move(options)) {}

StoredTask TaskStore::Place(const Task& task) const {
  StoredTask stored{task.name,
                    {{"study", study_},
                     {"version", RETROLUX_VERSION},
                     {"options", options_},
                     {"task", task.definition}},
                    ""};
  stored.id = HexHash(HashBytes(stored.definition.dump()));
  return stored;
}

fs::path TaskStore::ResultFile(const StoredTask& task) const {
  return folder_ / "tasks" / (task.id + ".json");
}

fs::path TaskStore::FailureFile(const StoredTask& task) const {
  return folder_ / "tasks" / (task.id + ".failure.json");
}

bool TaskStore::HasResult(const StoredTask& task) const {
  return fs::exists(ResultFile(task));
}

Json TaskStore::Read(const StoredTask& task) const {
  const fs::path file = ResultFile(task);
  const std::string text = ReadTextFile(file);
  if (!IsSealed(text)) throw InputError::At(file, "", "damaged", "a whole file");
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  const bool is_result = json.is_object() && json.value("schema", Json()) == kResultSchema &&
                         json.value("id", Json()) == task.id &&
                         json.value("definition", Json()).dump() == task.definition.dump() &&
                         json.contains("result");
  if (!is_result) throw InputError::At(file, "", "not of this task", "the result of " + task.name);
  return std::move(json["result"]);
}

Json TaskStore::Write(const StoredTask& task, const Json& result) const {
  Json json = TaskHeading(kResultSchema);
  json["id"] = task.id;
  json["definition"] = task.definition;
  json["result"] = result;
  const std::string text = Sealed(json);
  Json written = std::move(Json::parse(text)["result"]);
  RETROLUX_CHECK(written == result, "task '{}': a result that JSON cannot hold (NaN?)", task.name);
  WriteTextFile(ResultFile(task), text);
  return written;
}

std::string TaskStore::Failure(const StoredTask& task) const {
  const fs::path file = FailureFile(task);
  if (!fs::exists(file)) return "";
  const Json json = Json::parse(ReadTextFile(file), nullptr, /*allow_exceptions=*/false);
  return json.is_object() ? json.value("failure", "") : "";
}

void TaskStore::WriteFailure(const StoredTask& task, const std::string& what) const {
  Json json = TaskHeading(kFailureSchema);
  json["id"] = task.id;
  json["name"] = task.name;
  json["failure"] = what;
  WriteTextFile(FailureFile(task), json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void TaskStore::ClearFailure(const StoredTask& task) const {
  std::error_code ignored;  // it may never have been there
  fs::remove(FailureFile(task), ignored);
}

}  // namespace retrolux
