// retrolux: one program, a subcommand a file. Only here exceptions become exit codes:
// 0 good, 1 our fault, 2 the user's input, 3 a check failed, 4 some tasks failed, 75 try again,
// 129, 130, 143 interrupted.
#include <charconv>
#include <csignal>

#include "cli/commands.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/supervisor.h"

namespace {

constexpr int kExitOurFault = 1;

// One line, whatever the text holds.
std::string OneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text;
}

// Whole decimal numbers only: CLI11 takes -1 for the largest number and 010 for 8.
uint64_t ParseSeed(const std::string& option, const std::string& text) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw retrolux::InputError(
        fmt::format("{} {}: expected a whole number from 0 to 18446744073709551615", option, text));
  }
  return seed;
}

int Guarded(const retrolux::cli::Run& run) {
  try {
    return run();
  } catch (const retrolux::InputError& error) {
    retrolux::Tell(OneLine(error.what()));
    return retrolux::cli::kExitBadInput;
  } catch (const retrolux::TasksFailed& error) {
    retrolux::Tell(std::string(error.what()) + ":");
    for (const std::string& failure : error.Failures())
      retrolux::Say("  " + OneLine(failure) + "\n");
    return retrolux::cli::kExitTasksFailed;
  } catch (const retrolux::TryAgainError& error) {
    retrolux::Tell(OneLine(error.what()) + "; try again when that is mended");
    return retrolux::cli::kExitTryAgain;
  } catch (const std::bad_alloc&) {
    retrolux::Tell("not enough memory; try again with fewer threads or a smaller picture");
    return retrolux::cli::kExitTryAgain;
  } catch (const std::exception& error) {
    retrolux::Tell(std::string("internal error, please report it: ") + error.what());
    return kExitOurFault;
  }
}

int Limited(const retrolux::cli::GlobalOptions& global, const retrolux::cli::Run& run) {
  return Guarded([&] {
    const retrolux::LimitThreads limit(global.threads);
    return run();
  });
}

// What fails outside of the supervised work is ours.
int Supervised(const retrolux::cli::GlobalOptions& global, const retrolux::cli::Run& run) {
  return Guarded([&] { return retrolux::Supervise([&] { return Limited(global, run); }); });
}

}  // namespace

int main(int argc, char** argv) {
  using namespace retrolux::cli;
  GlobalOptions global;
  global.command_line = "retrolux";
  global.arguments.assign(argv + 1, argv + argc);
  for (const std::string& argument : global.arguments) global.command_line += " " + argument;
  Run run;
  Run long_run;  // of tasks, so that it can go on after a crash
  CLI::App app{
      "Pictures of retro-reflective markers as real cameras record them, and what to learn from "
      "them."};
  app.set_version_flag("--version", RETROLUX_VERSION);
  app.fallthrough();
  app.add_option("--threads", global.threads, "threads to work on; 0: all that the process may use")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--seed", [&](const std::string& text) { global.seed = ParseSeed("--seed", text); },
         "seed of the light transport, a whole number")
      ->default_str("1");
  app.add_option_function<std::string>(
      "--noise-seed",
      [&](const std::string& text) { global.noise_seed = ParseSeed("--noise-seed", text); },
      "seed of the sensor noise; default: the seed");
  app.add_flag("--quiet", global.quiet, "no progress, no result on stdout");
  app.add_flag("--json", global.json, "result as JSON on stdout");
  app.add_option("--progress", global.progress,
                 "auto (a bar on a terminal), json (lines for a log) or none")
      ->check(CLI::IsMember({"auto", "json", "none"}))
      ->capture_default_str();
  SetUpBench(app, global, run);
  SetUpRender(app, global, run);
  SetUpScene(app, global, run);
  SetUpClassify(app, global, run);
  SetUpMask(app, global, run);
  SetUpMaterial(app, global, run);
  SetUpGoniometer(app, global, run);
  SetUpStereo(app, global, run);
  SetUpStudy(app, global, long_run);
  SetUpTags(app, global, run);
  SetUpDataset(app, global, long_run);
  SetUpEvaluate(app, global, run);
  SetUpValidate(app, global, run);
  SetUpReport(app, global, run);
  SetUpView(app, global, run);
  SetUpDiff(app, global, run);
  SetUpCompletion(app, global, run);
  SetUpManual(app, global, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    retrolux::Tell(OneLine(error.what()) + "; see retrolux --help");
    return kExitBadInput;
  } catch (const retrolux::InputError& error) {
    retrolux::Tell(OneLine(error.what()));
    return kExitBadInput;
  }
  if (!run && !long_run) {
    std::vector<std::string> names;
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
    for (const CLI::App* sub : last->get_subcommands({})) names.push_back(sub->get_name());
    retrolux::Tell("no subcommand; expected one of " + retrolux::JoinNames(names));
    return kExitBadInput;
  }
  // A file that grows beyond its limit is a failed write, as on a full disk, and a log whose reader
  // has gone is one, too: not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  if (long_run) return Supervised(global, long_run);
  retrolux::EndOnSignals(retrolux::BlockEndingSignals());
  return Limited(global, run);
}
