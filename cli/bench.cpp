// retrolux bench [--seconds S]
#include <fmt/format.h>

#include "analysis/rates.h"
#include "cli/run_json.h"

namespace retrolux::cli {

namespace {

struct BenchCommand {
  double seconds = 0.3;
};

// 12345678 as 12.3 M.
std::string Short(double rate) {
  if (rate >= 1e6) return fmt::format("{:.1f} M", rate * 1e-6);
  if (rate >= 1e3) return fmt::format("{:.1f} k", rate * 1e-3);
  return fmt::format("{:.1f}", rate);
}

int RunBench(const BenchCommand& command, const GlobalOptions& global) {
  const auto progress = MakeProgress(global);
  const int threads = ThreadsOf(global).threads;
  const std::vector<Rate> rates = MeasureRates(command.seconds, threads, *progress);
  nlohmann::json summary = {{"schema", "retrolux/bench-1"},
                            {"version", RETROLUX_VERSION},
                            {"units", "1/s"},
                            {"pixel_origin", "center"},
                            {"rates", nlohmann::json::array()}};
  std::string text = fmt::format("{:40} {:>7} {:>18}   share of its limit", "", "threads", "rate");
  for (const Rate& rate : rates) {
    nlohmann::json row = {{"name", rate.name},
                          {"unit", rate.unit},
                          {"threads", rate.threads},
                          {"per_second", rate.per_second}};
    text += fmt::format("\n{:40} {:>7} {:>18}", rate.name, rate.threads,
                        Short(rate.per_second) + " " + rate.unit + "/s");
    if (!rate.limit.empty()) {
      row.update({{"limit", rate.limit},
                  {"limit_per_second", rate.limit_per_second},
                  {"share", rate.Share()}});
      text += fmt::format("   {:.1f} % of: {}", 100.0 * rate.Share(), rate.limit);
    }
    summary["rates"].push_back(row);
  }
  PrintResult(global, summary, text);
  return kExitGood;
}

}  // namespace

void SetUpBench(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<BenchCommand>();
  CLI::App* sub = app.add_subcommand(
      "bench", "Rates on this machine, each beside its limit: rays, paths, pictures, files");
  sub->add_option("--seconds", command->seconds, "least time of each loop, s")
      ->check(CLI::Range(0.01, 60.0))
      ->capture_default_str();
  sub->callback([&global, &run, command] {
    run = [&global, command] { return RunBench(*command, global); };
  });
}

}  // namespace retrolux::cli
