// retrolux view FILE
#include <fmt/format.h>

#include "analysis/picture_view.h"
#include "cli/commands.h"

namespace retrolux::cli {

namespace {

struct ViewCommand {
  std::filesystem::path file, out;
  std::vector<std::string> channels;
};

int RunView(const ViewCommand& command, const GlobalOptions& global) {
  std::filesystem::path out = command.out;
  if (out.empty()) out = std::filesystem::path(command.file).replace_extension(".html");
  PictureView(command.file, command.channels, global.command_line).Write(out);
  PrintResult(global, {{"page", out.string()}}, out.string());
  return kExitGood;
}

}  // namespace

void SetUpView(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<ViewCommand>();
  CLI::App* sub = app.add_subcommand(
      "view",
      "A picture as a page for the browser: any channel in false colour with a scale, ids in "
      "colours, the value under the pointer");
  sub->add_option("file", command->file, "a picture: EXR (all channels), PNG, ...")->required();
  sub->add_option("--channel", command->channels,
                  "only these, comma-separated, the first is shown first; default: all")
      ->delimiter(',');
  sub->add_option("--out", command->out, "the page; default: FILE with .html");
  sub->callback(
      [command, &global, &run] { run = [command, &global] { return RunView(*command, global); }; });
}

}  // namespace retrolux::cli
