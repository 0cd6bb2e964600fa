// The subcommands of `retrolux`, a file each. To add one: write cli/NAME.cpp with an options
// struct, a SetUpNAME that declares it, a RunNAME that does it; declare SetUpNAME here and call it
// in main.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/parallel.h"
#include "core/say.h"

namespace retrolux::cli {

// Options that every subcommand shares.
struct GlobalOptions {
  int threads = 0;  // 0: all that the process may use
  uint64_t seed = 1;
  std::optional<uint64_t> noise_seed;  // default: the seed
  bool quiet = false;
  bool json = false;
  std::vector<std::string> arguments;  // as they were typed, without the program's name
  std::string command_line;            // the same in one line
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
  std::string progress =
      "auto";  // auto: a bar if stderr is a terminal; json: lines for a log; none

  uint64_t NoiseSeed() const { return noise_seed.value_or(seed); }
};

// Exit codes; 1 (our fault) is main.cpp's, 128 + signal (129, 130, 143) core/interrupt.h's.
inline constexpr int kExitGood = 0;
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitCheckFailed = 3;
inline constexpr int kExitTasksFailed = 4;
inline constexpr int kExitTryAgain = 75;

// What the chosen subcommand does; returns the exit code.
using Run = std::function<int()>;

void SetUpBench(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpRender(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpScene(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpClassify(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpCompletion(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpDataset(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpDiff(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpEvaluate(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpGoniometer(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpManual(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpMaterial(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpMask(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpReport(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpStereo(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpStudy(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpTags(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpValidate(CLI::App& app, const GlobalOptions& global, Run& run);
void SetUpView(CLI::App& app, const GlobalOptions& global, Run& run);

// The progress bar or log that the global options ask for.
std::unique_ptr<Progress> MakeProgress(const GlobalOptions& global);

// Tells the result: the summary as JSON on stdout with --json, else `text` unless --quiet.
// TryAgainError if stdout can't be written to; a reader that has gone wants no more.
void PrintResult(const GlobalOptions& global, const nlohmann::json& summary,
                 const std::string& text);

}  // namespace retrolux::cli
