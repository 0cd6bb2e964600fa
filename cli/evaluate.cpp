// retrolux evaluate DATASET --out DIR
#include <fmt/format.h>

#include <algorithm>

#include "analysis/evaluation_files.h"
#include "analysis/evaluation_input.h"
#include "analysis/evaluation_report.h"
#include "cli/command_tree.h"
#include "cli/run_json.h"
#include "core/atomic_file.h"
#include "core/marker_set.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct EvaluateCommand {
  fs::path dataset, out, detections;
  std::vector<std::string> methods;
  std::string split = "test";
};

// What is compared if nothing is named: the method in question first.
std::vector<std::string> MethodsOf(const EvaluateCommand& command) {
  if (!command.methods.empty() || !command.detections.empty()) return command.methods;
  return {"robust", "edges"};
}

void CheckMethods(const std::vector<std::string>& methods) {
  for (size_t i = 0; i < methods.size(); ++i) {
    MethodByName(methods[i]);
    if (std::count(methods.begin(), methods.end(), methods[i]) > 1)
      throw InputError(fmt::format("--method {} twice; expected each once", methods[i]));
  }
}

// As the file says, or "detections"; told from a method of ours that is evaluated beside it.
std::string NameOfForeign(const DetectionsFile& file, const std::vector<std::string>& methods) {
  const std::string name = file.method.empty() ? "detections" : file.method;
  const bool taken = std::find(methods.begin(), methods.end(), name) != methods.end();
  return taken ? name + " (file)" : name;
}

// How fast a method is: its own time, and that of the whole loop.
Json Rates(const std::string& method, size_t pictures, const IdentificationTimes& times,
           const GlobalOptions& global) {
  const auto count = static_cast<double>(pictures);
  const int threads = ThreadsOf(global).threads;
  return {{"method", method},
          {"identify_ms", 1e3 * times.identify_s / count},
          {"pictures_per_second", threads * count / times.identify_s},
          {"pictures_per_second_with_reading", count / times.wall_s}};
}

std::string Percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.2f} %", 100.0 * *share) : "-";
}

std::string TextOf(const MethodResult& method, const Scores& scores) {
  return fmt::format(
      "{}: found {} of {} ({}), misnamed {}, false positives {}, precision {}, centroid {:.4f} px "
      "rms, bias {:.4f} px\n",
      method.method, scores.found, scores.markers, Percent(scores.Recall().Value()),
      scores.misnamed, scores.false_positives, Percent(scores.Precision().Value()),
      scores.centroid.rms, scores.centroid.Bias());
}

Json SummaryOf(const MethodResult& method, const Scores& scores) {
  const auto value = [](const std::optional<double>& share) {
    return share ? Json(*share) : Json();
  };
  return {{"method", method.method},
          {"markers", scores.markers},
          {"found", scores.found},
          {"misnamed", scores.misnamed},
          {"false_positives", scores.false_positives},
          {"precision", value(scores.Precision().Value())},
          {"recall", value(scores.Recall().Value())},
          {"centroid_rms_px", scores.centroid.rms},
          {"centroid_bias_px", scores.centroid.Bias()}};
}

int RunEvaluate(const EvaluateCommand& command, const GlobalOptions& global) {
  const std::vector<std::string> methods = MethodsOf(command);
  CheckMethods(methods);
  const StudyRun run(global);
  const MarkerSet& markers = DefaultMarkerSet();
  const DatasetIndex index = ReadDatasetIndex(command.dataset);
  Evaluation evaluation = PrepareEvaluation(index, command.split, EvaluationLimits());
  if (!command.detections.empty()) {
    const DetectionsFile file = ReadDetections(command.detections, markers);
    evaluation.methods.push_back(
        ScoreMethod(evaluation, NameOfForeign(file, methods),
                    DetectionsOfPictures(evaluation, index, command.detections, file)));
  }
  CheckPictures(evaluation, command.dataset);
  EnsureWritableFolder(command.out);
  const auto progress = MakeProgress(global);
  Json rates = Json::array();
  for (const std::string& name : methods) {
    progress->Begin(name, static_cast<int64_t>(evaluation.pictures.size()), "pictures");
    IdentificationTimes times;
    auto detections = IdentifyPictures(evaluation, command.dataset, MethodByName(name), markers,
                                       *progress, times);
    progress->End();
    rates.push_back(Rates(name, evaluation.pictures.size(), times, global));
    evaluation.methods.push_back(ScoreMethod(evaluation, name, std::move(detections)));
  }
  const std::vector<EvaluationVariable> variables = EvaluationVariables(evaluation);
  WriteEvaluationFiles(evaluation, index, variables, command.out);
  WriteEvaluationReport(evaluation, index, variables, command.dataset, command.out,
                        global.command_line);
  run.Write(command.out, {{"pictures", evaluation.pictures.size()}, {"rates", rates}});

  std::string text;
  Json summary = Json::array();
  for (const MethodResult& method : evaluation.methods) {
    const Scores scores = ScoresOf(evaluation, method, Everything(evaluation));
    text += TextOf(method, scores);
    summary.push_back(SummaryOf(method, scores));
  }
  for (const Json& rate : rates) {
    text += fmt::format("{}: {:.2f} ms a picture, {:.0f} pictures a second on all threads\n",
                        rate["method"].get<std::string>(), rate["identify_ms"].get<double>(),
                        rate["pictures_per_second"].get<double>());
  }
  const fs::path report = command.out / "report.html";
  PrintResult(
      global,
      {{"pictures", evaluation.pictures.size()},
       {"methods", summary},
       {"rates", rates},
       {"report", report.string()}},
      fmt::format("{}{} pictures\nreport: {}", text, evaluation.pictures.size(), report.string()));
  return kExitGood;
}

}  // namespace

void SetUpEvaluate(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<EvaluateCommand>();
  CLI::App* sub = app.add_subcommand(
      "evaluate", "How well do methods find and name the markers of a labelled set of pictures?");
  sub->footer(
      "evaluation.json, misses.csv (a row for each labelled marker and method),\n"
      "false_positives.csv, report.html. docs/evaluation.md defines the words.");
  sub->add_option("DATASET", command->dataset, "folder that `dataset run` finished")->required();
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--method", command->methods,
                  "several times: compared on the same pictures. Default: robust and edges, with "
                  "--detections none")
      ->type_name(ChoiceType(MethodNames()))
      ->allow_extra_args(false);
  sub->add_option("--split", command->split, "pictures of test, val, train or all")
      ->check(CLI::IsMember({"test", "val", "train", "all"}))
      ->capture_default_str();
  sub->add_option("--detections", command->detections,
                  "what another detector found, a detections.json (docs/file-formats.md) with an "
                  "entry for each picture");
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunEvaluate(*command, global); };
  });
}

}  // namespace retrolux::cli
