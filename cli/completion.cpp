// retrolux completion SHELL
#include "cli/completion.h"

#include "cli/commands.h"

namespace retrolux::cli {

namespace {

std::string Completion(const std::string& shell, const std::vector<CommandText>& commands) {
  if (shell == "bash") return BashCompletion(commands);
  return shell == "zsh" ? ZshCompletion(commands) : FishCompletion(commands);
}

}  // namespace

void SetUpCompletion(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "Print a completion script for a shell");
  sub->footer("For this shell only: eval \"$(retrolux completion bash)\"");
  sub->add_option("SHELL", *shell, "the shell")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->required();
  sub->callback([shell, &app, &global, &run] {
    run = [shell, &app, &global] {
      std::string script = Completion(*shell, CommandTree(app));
      script.pop_back();  // PrintResult ends the line
      PrintResult(global, {{"shell", *shell}, {"script", script}}, script);
      return kExitGood;
    };
  });
}

}  // namespace retrolux::cli
