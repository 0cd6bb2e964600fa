// retrolux report DIR: the report of a folder of results, made anew.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "analysis/render_report.h"
#include "cli/commands.h"
#include "cli/picture_size.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

Json ReadRun(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  if (fs::exists(folder / "manifest.json") && !fs::exists(file)) {
    throw InputError::At(folder, "", "a study that is not finished",
                         "run.json; give its command again, it goes on where it was");
  }
  const Json run = Json::parse(ReadTextFile(file), nullptr, false);
  if (!run.is_object() || !run.contains("arguments"))
    throw InputError::At(file, "/arguments", "none", "the arguments of the command that made it");
  return run;
}

// A render has no report of its own. The scene is loaded again; if it is gone, so is the room.
void ReportRender(const fs::path& folder, const Json& run) {
  std::optional<Scene> scene;
  try {
    scene = LoadSceneAs(run.at("scene"), run.at("pose"), run.at("size"));
  } catch (const InputError& error) {
    Tell(fmt::format("warning: no room in the report: {}", error.what()));
  }
  RenderReport(folder, scene, run.at("command")).Write(folder / "report.html");
}

// Where "--out" and its value are, or "--out=VALUE"; the end if there is none.
Arguments::iterator OutOption(Arguments& arguments) {
  return std::find_if(arguments.begin(), arguments.end(), [](const std::string& argument) {
    return argument == "--out" || argument.starts_with("--out=");
  });
}

// What --out is to be, if `folder` is where a result lies now that was `below` it: studies of
// several rooms have a folder for each.
fs::path OutOf(const fs::path& folder, const fs::path& below) {
  fs::path out = fs::absolute(folder).lexically_normal();
  if (!out.has_filename()) out = out.parent_path();
  if (below == ".") return out;
  for (size_t i = 0; i < static_cast<size_t>(std::distance(below.begin(), below.end())); ++i)
    out = out.parent_path();
  return out;
}

// The command of run.json on the folder where its results are now, told as this one is. All of its
// tasks are done, so that it only writes its report and tables.
Arguments CommandAgain(const fs::path& folder, const Json& run, const GlobalOptions& global) {
  Arguments arguments = run.at("arguments").get<Arguments>();
  if (const auto out = OutOption(arguments); out != arguments.end()) {
    const bool joined = *out != "--out";
    const std::string now = OutOf(folder, run.value("below_out", ".")).string();
    *(joined ? out : out + 1) = joined ? "--out=" + now : now;
  } else if (arguments.size() > 2 && arguments[0] == "dataset") {
    arguments = {"dataset", "run", folder.string()};
  }
  for (const char* flag : {"--json", "--quiet"}) std::erase(arguments, flag);
  if (global.json) arguments.push_back("--json");
  if (global.quiet) arguments.push_back("--quiet");
  return arguments;
}

[[noreturn]] void BecomeCommand(const Arguments& arguments) {
  std::vector<char*> argv;
  std::string name = "retrolux";
  argv.push_back(name.data());
  std::vector<std::string> kept = arguments;
  for (std::string& argument : kept) argv.push_back(argument.data());
  argv.push_back(nullptr);
  sigset_t none;  // signals are blocked here, for the thread that takes them
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
  execv("/proc/self/exe", argv.data());
  throw std::runtime_error(fmt::format("can't start the program again: {}", std::strerror(errno)));
}

int RunReport(const fs::path& folder, const GlobalOptions& global) {
  const Json run = ReadRun(folder);
  const Arguments arguments = run.at("arguments").get<Arguments>();
  if (arguments.empty() || !run.contains("scene")) BecomeCommand(CommandAgain(folder, run, global));
  ReportRender(folder, run);
  const std::string report = (folder / "report.html").string();
  PrintResult(global, {{"report", report}}, "report: " + report);
  return kExitGood;
}

}  // namespace

void SetUpReport(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto folder = std::make_shared<fs::path>();
  CLI::App* sub = app.add_subcommand(
      "report",
      "Write the report.html of a folder of results anew: of a study, a dataset, an evaluation, a "
      "render. Files that its command names are looked for from here");
  sub->add_option("folder", *folder, "what was --out of the command")->required();
  sub->callback(
      [folder, &global, &run] { run = [folder, &global] { return RunReport(*folder, global); }; });
}

}  // namespace retrolux::cli
