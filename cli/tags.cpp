// retrolux tags FAMILY --out FILE
#include "classifier/tags.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

struct TagsCommand {
  std::string family;
  std::vector<int> ids = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  double size_mm = 30.0;
  std::filesystem::path out;
};

std::vector<std::string> FamilyNames() {
  std::vector<std::string> names;
  for (const TagFamily& family : TagFamilies()) names.push_back(family.name);
  return names;
}

int RunTags(const TagsCommand& command, const GlobalOptions& global) {
  const TagFamily* family = FindTagFamily(command.family);
  if (family == nullptr) {
    const std::vector<std::string> names = FamilyNames();
    throw InputError(fmt::format(
        "no family of tags '{}'; expected one of {}", command.family,
        names.empty() ? "none, as retrolux was built without their libraries" : JoinNames(names)));
  }
  const MarkerSet set = MakeTagSet(*family, command.ids, command.size_mm);
  WriteTextFile(command.out, ToJson(set).dump(1) + "\n");
  PrintResult(
      global,
      {{"family", family->name},
       {"tags", set.shapes.size()},
       {"size_mm", set.size_mm},
       {"set", command.out.string()}},
      fmt::format("{} tags of {}, {:g} mm wide with a quiet zone of {:g} mm\n{}", set.shapes.size(),
                  family->name, set.size_mm, set.size_mm / family->cells, command.out.string()));
  return kExitGood;
}

}  // namespace

void SetUpTags(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<TagsCommand>();
  CLI::App* sub = app.add_subcommand(
      "tags",
      "A marker set of square tags that the libraries of others find: for scene.json's "
      "`marker_set`, and `classify --method FAMILY --set`");
  sub->add_option("FAMILY", command->family,
                  fmt::format("of those built in: {}", JoinNames(FamilyNames())))
      ->required();
  sub->add_option("--ids", command->ids, "ids, comma-separated, from 1; the markers' numbers")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--size", command->size_mm, "side of a tag with its quiet zone of one cell, mm")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  sub->add_option("--out", command->out, "file for the marker set, e.g. tags.json")->required();
  sub->callback(
      [command, &global, &run] { run = [command, &global] { return RunTags(*command, global); }; });
}

}  // namespace retrolux::cli
