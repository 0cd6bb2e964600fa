#include "cli/run_json.h"

#include <ctime>

#include "core/atomic_file.h"

namespace retrolux::cli {

namespace {

// "2026-11-22T10:00:00Z"
std::string UtcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace

nlohmann::json TasksJson(const TaskReport& report) {
  return {{"done_before", report.done_before},
          {"done_now", report.done_now},
          {"done_elsewhere", report.done_elsewhere},
          {"out_of_time", report.out_of_time}};
}

ThreadLimit ThreadsOf(const GlobalOptions& global) {
  if (global.threads > 0) return {global.threads, "--threads"};
  return UsableThreads();
}

StudyRun::StudyRun(const GlobalOptions& global)
    : global_(global), started_(UtcNow()), start_(std::chrono::steady_clock::now()) {}

double StudyRun::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

namespace {

// Of `folder` below the folder that --out names: "." or, in studies of several rooms, "1a".
std::string BelowOut(const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder) {
  for (size_t i = 0; i < arguments.size(); ++i) {
    std::string out;
    if (arguments[i] == "--out" && i + 1 < arguments.size()) out = arguments[i + 1];
    if (arguments[i].starts_with("--out=")) out = arguments[i].substr(6);
    if (out.empty()) continue;
    return (folder / "")
        .lexically_normal()
        .lexically_relative((std::filesystem::path(out) / "").lexically_normal());
  }
  return ".";
}

}  // namespace

void StudyRun::Write(const std::filesystem::path& folder, const nlohmann::json& figures) const {
  nlohmann::json run = {{"schema", "retrolux/run-1"},
                        {"version", RETROLUX_VERSION},
                        {"units", "s"},
                        {"pixel_origin", "center"},
                        {"command", global_.command_line},
                        {"arguments", global_.arguments},
                        {"below_out", BelowOut(global_.arguments, folder)},
                        {"seed", global_.seed},
                        {"noise_seed", global_.NoiseSeed()},
                        {"started", started_},
                        {"seconds", Seconds()},
                        {"threads", ThreadsOf(global_).threads},
                        {"threads_from", ThreadsOf(global_).source}};
  run.update(figures);
  WriteTextFile(folder / "run.json", run.dump(2) + "\n");
}

}  // namespace retrolux::cli
