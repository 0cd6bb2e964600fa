// retrolux: one program, a subcommand a file. Only here exceptions become exit codes:
// 0 good, 1 our fault, 2 the user's input, 3 a check failed, 75 try again.
#include <fmt/core.h>

#include "cli/commands.h"
#include "core/error.h"

namespace {

constexpr int kExitOurFault = 1;
constexpr int kExitTryAgain = 75;

int Guarded(const retrolux::cli::GlobalOptions& global, const retrolux::cli::Run& run) {
  try {
    const retrolux::LimitThreads limit(global.threads);
    return run();
  } catch (const retrolux::InputError& error) {
    fmt::print(stderr, "retrolux: {}\n", error.what());
    return retrolux::cli::kExitBadInput;
  } catch (const retrolux::TryAgainError& error) {
    fmt::print(stderr, "retrolux: {}; try again when that is mended\n", error.what());
    return kExitTryAgain;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "retrolux: not enough memory; try again with fewer threads or a smaller picture\n");
    return kExitTryAgain;
  } catch (const std::exception& error) {
    fmt::print(stderr, "retrolux: internal error, please report it: {}\n", error.what());
    return kExitOurFault;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace retrolux::cli;
  GlobalOptions global;
  global.command_line = "retrolux";
  for (int i = 1; i < argc; ++i) global.command_line += std::string(" ") + argv[i];
  Run run;
  CLI::App app{"Pictures of retro-reflective markers as real cameras record them, and what to learn from them."};
  app.require_subcommand(1);
  app.set_version_flag("--version", RETROLUX_VERSION);
  app.fallthrough();
  app.add_option("--threads", global.threads, "threads to work on; 0: all that the process may use")
      ->check(CLI::Range(0, 1024))->capture_default_str();
  app.add_option("--seed", global.seed, "seed of the light transport")->capture_default_str();
  app.add_option("--noise-seed", global.noise_seed, "seed of the sensor noise; default: the seed");
  app.add_flag("--quiet", global.quiet, "no progress, no result on stdout");
  app.add_flag("--json", global.json, "result as JSON on stdout");
  app.add_option("--progress", global.progress, "auto (a bar on a terminal), json (lines for a log) or none")
      ->check(CLI::IsMember({"auto", "json", "none"}))->capture_default_str();
  SetUpRender(app, global, run);
  SetUpScene(app, global, run);
  SetUpClassify(app, global, run);
  SetUpStudy(app, global, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return kExitBadInput;
  }
  return Guarded(global, run);
}
