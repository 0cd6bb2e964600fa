// retrolux diff A B
#include <fmt/format.h>

#include "analysis/folder_difference.h"
#include "cli/commands.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

struct DiffCommand {
  fs::path a, b, out;
  bool check = false;
};

Json Measures(const ChannelDifference& c) {
  Json json = {
      {"channel", c.name}, {"unit", c.unit}, {"pixels", c.pixels}, {"different", c.different}};
  if (!c.ids) {
    json.update(
        {{"bias", c.bias}, {"rms", c.rms}, {"most", c.most}, {"relative_mse", c.relative_mse}});
  }
  if (c.psnr_db) json["psnr_db"] = *c.psnr_db;
  if (c.rms_in_sigmas) json["rms_in_sigmas"] = *c.rms_in_sigmas;
  return json;
}

Json PictureJson(const PictureDifference& difference) {
  Json channels = Json::array();
  for (const ChannelDifference& c : difference.channels) channels.push_back(Measures(c));
  return {{"channels", channels},
          {"only_in_a", difference.only_in_a},
          {"only_in_b", difference.only_in_b}};
}

std::string PictureText(const PictureDifference& difference) {
  std::string text;
  for (const ChannelDifference& c : difference.channels) {
    if (c.different == 0) continue;
    text += fmt::format("  {}: {} of {} pixels differ", c.name, c.different, c.pixels);
    if (!c.ids)
      text += fmt::format("; b - a: bias {:.4g}, rms {:.4g}, most {:.4g} {}; relMSE {:.4g}", c.bias,
                          c.rms, c.most, c.unit, c.relative_mse);
    if (c.psnr_db) text += fmt::format("; PSNR {:.1f} dB", *c.psnr_db);
    if (c.rms_in_sigmas) text += fmt::format("; rms {:.3g} sigmas of the noise", *c.rms_in_sigmas);
    text += "\n";
  }
  for (const auto& [names, where] :
       {std::pair(&difference.only_in_a, "a"), std::pair(&difference.only_in_b, "b")}) {
    if (!names->empty()) text += fmt::format("  only in {}: {}\n", where, JoinNames(*names));
  }
  return text;
}

Json FileJson(const FileDifference& file) {
  Json json = {{"file", file.file}, {"same", file.same}};
  if (!file.note.empty()) json["note"] = file.note;
  Json values = Json::array();
  for (const ValueDifference& v : file.values) {
    values.push_back({{"name", v.name},
                      {"entries", v.entries},
                      {"different", v.different},
                      {"numbers", v.numbers},
                      {"bias", v.bias},
                      {"rms", v.rms},
                      {"most", v.most}});
  }
  if (!values.empty()) json["values"] = values;
  if (file.picture) json["picture"] = PictureJson(*file.picture);
  return json;
}

std::string FileText(const FileDifference& file) {
  std::string text = file.file + (file.note.empty() ? "" : ": " + file.note) + "\n";
  for (const ValueDifference& v : file.values) {
    text += fmt::format("  {}: {} of {} differ", v.name, v.different, v.entries);
    if (v.numbers > 0)
      text += fmt::format("; b - a: bias {:.4g}, rms {:.4g}, most {:.4g}", v.bias, v.rms, v.most);
    text += "\n";
  }
  return file.picture ? text + PictureText(*file.picture) : text;
}

struct Outcome {
  bool same = false;
  Json json;
  std::string text;
};

Outcome DiffFolders(const DiffCommand& command) {
  const std::vector<FileDifference> files = CompareFolders(command.a, command.b);
  Outcome outcome{true, {{"files", Json::array()}}, ""};
  size_t different = 0;
  for (const FileDifference& file : files) {
    outcome.json["files"].push_back(FileJson(file));
    if (file.same) continue;
    ++different;
    outcome.text += FileText(file);
  }
  outcome.same = different == 0;
  outcome.text += fmt::format("{} of {} files differ", different, files.size());
  return outcome;
}

Outcome DiffPictures(const DiffCommand& command, const GlobalOptions& global) {
  const PicturePair pair = ReadPair(command.a, command.b);
  const PictureDifference difference = ComparePictures(pair);
  Outcome outcome{difference.Same(), PictureJson(difference), PictureText(difference)};
  if (outcome.same) outcome.text = "the same in every pixel";
  if (!command.out.empty()) {
    DifferenceReport(pair, global.command_line).Write(command.out);
    outcome.json["page"] = command.out.string();
    outcome.text += command.out.string();
  }
  return outcome;
}

int RunDiff(const DiffCommand& command, const GlobalOptions& global) {
  const bool folders = fs::is_directory(command.a) && fs::is_directory(command.b);
  if (folders && !command.out.empty())
    throw InputError("--out: a page is made of two pictures; expected two files, found folders");
  Outcome outcome = folders ? DiffFolders(command) : DiffPictures(command, global);
  outcome.json["same"] = outcome.same;
  PrintResult(global, outcome.json, outcome.text);
  return command.check && !outcome.same ? kExitCheckFailed : kExitGood;
}

}  // namespace

void SetUpDiff(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<DiffCommand>();
  CLI::App* sub = app.add_subcommand(
      "diff",
      "How two pictures, or the results of two runs, differ: bias, rms, largest difference, "
      "relMSE, PSNR; tables column by column");
  sub->add_option("a", command->a, "a picture, or a folder of results")->required();
  sub->add_option("b", command->b, "what is compared with it")->required();
  sub->add_option("--out", command->out,
                  "of two pictures: a page with a slider between them and their difference");
  sub->add_flag("--check", command->check, "exit code 3 if anything differs");
  sub->callback(
      [command, &global, &run] { run = [command, &global] { return RunDiff(*command, global); }; });
}

}  // namespace retrolux::cli
