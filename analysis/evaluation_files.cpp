#include "analysis/evaluation_files.h"

#include "analysis/dataset_csv.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

const char* NameOf(LabelOutcome outcome) {
  if (outcome == LabelOutcome::kFound) return "found";
  if (outcome == LabelOutcome::kMisnamed) return "misnamed";
  return outcome == LabelOutcome::kUnnamed ? "unnamed" : "missed";
}

std::string Cell(double value) {
  return fmt::format("{}", value);
}

// Error along u, v and the tilt; empty without.
void AddError(const std::optional<PlaceError>& error, std::vector<std::string>& cells) {
  cells.push_back(error ? Cell(error->error.x()) : "");
  cells.push_back(error ? Cell(error->error.y()) : "");
  cells.push_back(error && error->tilt ? Cell(error->error.dot(*error->tilt)) : "");
}

std::vector<std::string> ResultCells(const Evaluation& evaluation, const MethodResult& method,
                                     size_t i) {
  const EvaluatedMarker& marker = evaluation.markers[i];
  const MarkerResult& result = method.markers[i];
  const Detection* detection = result.match.detection
                                   ? &evaluation.DetectionsAt(method, i)[*result.match.detection]
                                   : nullptr;
  std::vector<std::string> cells = {
      method.method,
      marker.shape.counts ? "1" : "0",
      marker.whole ? "1" : "0",
      Cell(marker.frame_position),
      NameOf(result.match.outcome),
      detection && detection->marker ? MarkerName(*detection->marker) : "",
      detection ? Cell(detection->confidence) : "",
      std::to_string(result.match.wrong_names),
      detection ? Cell(detection->centroid_px.x()) : "",
      detection ? Cell(detection->centroid_px.y()) : ""};
  AddError(result.centroid, cells);
  AddError(result.outline, cells);
  const PlaceErrors corners = PlaceErrorsOf(result.corners);
  cells.push_back(std::to_string(corners.Count()));
  cells.push_back(corners.Count() > 0 ? Cell(corners.rms) : "");
  return cells;
}

// One row for each labelled marker and method, what is true of it first.
void WriteMisses(const Evaluation& evaluation, const DatasetIndex& index,
                 const std::filesystem::path& file) {
  const LabelTable labels(index);
  std::vector<std::string> columns = labels.Columns();
  for (const char* column :
       {"method", "counts", "whole", "frame_position", "outcome", "named", "confidence",
        "wrong_names", "detected_u_px", "detected_v_px", "error_u_px", "error_v_px",
        "error_tilt_px", "outline_error_u_px", "outline_error_v_px", "outline_error_tilt_px",
        "corners", "corner_rms_px"})
    columns.emplace_back(column);
  CsvWriter csv(columns);
  for (size_t i = 0; i < evaluation.markers.size(); ++i) {
    const EvaluatedMarker& marker = evaluation.markers[i];
    const EvaluatedPicture& picture = evaluation.pictures[marker.picture];
    for (const MethodResult& method : evaluation.methods) {
      std::vector<std::string> cells = labels.Row(*picture.scene, *picture.picture, *marker.label);
      for (std::string& cell : ResultCells(evaluation, method, i)) cells.push_back(std::move(cell));
      csv.Row(cells);
    }
  }
  csv.Write(file);
}

void WriteFalsePositives(const Evaluation& evaluation, const std::filesystem::path& file) {
  CsvWriter csv({"scene", "split", "camera", "file", "method", "named", "confidence", "u_px",
                 "v_px", "duplicate"});
  for (size_t p = 0; p < evaluation.pictures.size(); ++p) {
    const EvaluatedPicture& picture = evaluation.pictures[p];
    for (const MethodResult& method : evaluation.methods) {
      for (size_t i = 0; i < method.verdicts[p].size(); ++i) {
        const Verdict verdict = method.verdicts[p][i].verdict;
        if (verdict != Verdict::kNothing && verdict != Verdict::kDuplicate) continue;
        const Detection& detection = method.detections[p][i];
        csv.Row({picture.scene->name, picture.scene->split, picture.picture->camera,
                 picture.picture->file, method.method, MarkerName(*detection.marker),
                 Cell(detection.confidence), Cell(detection.centroid_px.x()),
                 Cell(detection.centroid_px.y()), verdict == Verdict::kDuplicate ? "1" : "0"});
      }
    }
  }
  csv.Write(file);
}

}  // namespace

void WriteEvaluationFiles(const Evaluation& evaluation, const DatasetIndex& index,
                          const std::vector<EvaluationVariable>& variables,
                          const std::filesystem::path& folder) {
  WriteMisses(evaluation, index, folder / "misses.csv");
  WriteFalsePositives(evaluation, folder / "false_positives.csv");
  WriteTextFile(folder / "evaluation.json",
                EvaluationJson(evaluation, index, variables).dump(1) + "\n");
}

}  // namespace retrolux
