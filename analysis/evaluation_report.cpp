#include "analysis/evaluation_report.h"

#include "analysis/evaluation_gallery.h"
#include "analysis/evaluation_plots.h"
#include "analysis/evaluation_targets.h"
#include "analysis/report.h"

namespace retrolux {

namespace {

constexpr size_t kGalleryPictures = 24;
constexpr int kGalleryColumns = 6;

using Rows = std::vector<std::vector<std::string>>;

std::string Percent(const Proportion& share) {
  if (share.of == 0) return "";
  return fmt::format("{:.2f}", 100.0 * *share.Value());
}

std::string IntervalText(const Proportion& share) {
  if (share.of == 0) return "";
  const Interval interval = share.Wilson();
  return fmt::format("{:.3f} to {:.3f}", 100.0 * interval.low, 100.0 * interval.high);
}

std::string Pixels(const PlaceErrors& errors, double value) {
  return errors.Count() > 0 ? fmt::format("{:.4f}", value) : "";
}

class EvaluationPage {
 public:
  EvaluationPage(const Evaluation& evaluation, const DatasetIndex& index,
                 const std::vector<EvaluationVariable>& variables,
                 const std::filesystem::path& dataset)
      : evaluation_(evaluation),
        variables_(variables),
        dataset_(dataset),
        report_("How well the markers are found and named",
                fmt::format("Dataset {}, split {}, {} pictures; retrolux " RETROLUX_VERSION,
                            index.header.at("name").get<std::string>(), evaluation.split,
                            evaluation.pictures.size())) {}

  Report Compose(const std::string& command_line) {
    Summary();
    Markers();
    Confusions();
    Errors();
    Galleries();
    Compared();
    Targets();
    Scenes();
    HowMade(command_line);
    return std::move(report_);
  }

 private:
  void Draw(const std::string& caption, const PlotlyFigure& figure) {
    report_.Plot(caption, figure.traces, figure.layout, figure.height_px);
  }

  Scores All(const MethodResult& method) const {
    return ScoresOf(evaluation_, method, Everything(evaluation_));
  }

  void Summary() {
    std::vector<KeyFigure> figures;
    Rows table;
    for (const MethodResult& method : evaluation_.methods) {
      const Scores s = All(method);
      figures.push_back(
          {method.method + ": found", Percent(s.Recall()), "%",
           fmt::format("{} of {}; {} %", s.found, s.markers, IntervalText(s.Recall()))});
      figures.push_back(
          {method.method + ": wrong names", std::to_string(s.misnamed), "",
           fmt::format("of {}; and {} where no marker is", s.Named(), s.false_positives)});
      figures.push_back({method.method + ": centroid", Pixels(s.centroid, s.centroid.rms), "px rms",
                         fmt::format("bias {} px", Pixels(s.centroid, s.centroid.Bias()))});
      const auto f1 = s.F1();
      table.push_back({method.method, std::to_string(s.markers), std::to_string(s.found),
                       Percent(s.Recall()), IntervalText(s.Recall()), std::to_string(s.misnamed),
                       std::to_string(s.false_positives), std::to_string(s.duplicates),
                       Percent(s.Precision()), IntervalText(s.Precision()),
                       f1 ? fmt::format("{:.4f}", *f1) : "",
                       fmt::format("{:.4f}", static_cast<double>(s.false_positives) /
                                                 static_cast<double>(s.pictures)),
                       std::to_string(s.ignored), std::to_string(s.unnamed)});
    }
    report_.KeyFigures(figures);
    report_.Paragraph(fmt::format(
        "Asked for are markers of which at least {:g} % can be seen. **Found**: a detection with "
        "the right name lies on it. **Misnamed**: a detection with another name than that of the "
        "marker under it. **False positive**: a name where no marker is, or a second one on the "
        "same marker. Intervals: Wilson, 95 %.",
        100.0 * evaluation_.limits.min_visible_fraction));
    report_.Table(
        "All markers and pictures",
        {"method", "markers", "found", "found (%)", "interval (%)", "misnamed", "false positives",
         "of these duplicates", "precision (%)", "interval (%)", "F1", "false positives a picture",
         "right names not asked for", "patterns without a name"},
        table);
  }

  static std::vector<std::string> GroupColumns() {
    return {"value",
            "method",
            "markers",
            "found (%)",
            "interval (%)",
            "misnamed",
            "false positives",
            "centroid rms (px)",
            "bias (px)",
            "along the tilt (px)",
            "95 % below (px)",
            "to the outline's, rms (px)",
            "corners rms (px)",
            "corners outwards (px)"};
  }

  std::vector<std::string> GroupRow(const EvaluationGroup& group, const MethodResult& method) {
    const Scores s = ScoresOf(evaluation_, method, group.choice);
    return {group.Label(),
            method.method,
            std::to_string(s.markers),
            Percent(s.Recall()),
            IntervalText(s.Recall()),
            std::to_string(s.misnamed),
            s.pictures > 0 ? std::to_string(s.false_positives) : "",
            Pixels(s.centroid, s.centroid.rms),
            Pixels(s.centroid, s.centroid.Bias()),
            Pixels(s.centroid, s.centroid.tilt.bias),
            Pixels(s.centroid, s.centroid.p95),
            Pixels(s.outline, s.outline.rms),
            Pixels(s.corners, s.corners.rms),
            Pixels(s.corners, s.corners.outward.bias)};
  }

  void Markers() {
    report_.Heading("What makes it hard");
    for (const EvaluationVariable& variable : variables_) {
      if (variable.of_scenes) continue;
      Draw("Found over " + variable.title, RecallFigure(evaluation_, variable));
      Draw("Centroid error over " + variable.title, CentroidFigure(evaluation_, variable));
      Rows rows;
      for (const EvaluationGroup& group : variable.groups) {
        for (const MethodResult& method : evaluation_.methods)
          rows.push_back(GroupRow(group, method));
      }
      report_.Table("By " + variable.title, GroupColumns(), rows);
    }
  }

  // Of what all scenes share nothing can be learned.
  void Scenes() {
    report_.Heading("By what the scenes were drawn as");
    std::vector<std::string> columns = GroupColumns();
    columns.insert(columns.begin(), "of the scene");
    Rows rows;
    for (const EvaluationVariable& variable : variables_) {
      if (!variable.of_scenes || variable.groups.size() < 2) continue;
      Draw("Found over " + variable.title, RecallFigure(evaluation_, variable));
      for (const EvaluationGroup& group : variable.groups) {
        for (const MethodResult& method : evaluation_.methods) {
          rows.push_back(GroupRow(group, method));
          rows.back().insert(rows.back().begin(), variable.title);
        }
      }
    }
    report_.Table("The same in numbers", columns, rows);
  }

  void Confusions() {
    report_.Heading("What is taken for what");
    for (const MethodResult& method : evaluation_.methods) {
      Draw(method.method + ": rows what is there, columns what it was named",
           ConfusionFigure(ConfusionOf(evaluation_, method)));
    }
  }

  void Errors() {
    report_.Heading("Centroids and corners");
    Rows rows;
    for (const MethodResult& method : evaluation_.methods) {
      Draw(method.method +
               ": centroids against the radiometric centroid (dark markers: the outline's)",
           ErrorHistogram(evaluation_, method));
      const Scores s = All(method);
      AddErrorRows(method.method + ", centroid", s.centroid, rows);
      AddErrorRows(method.method + ", to the outline's centroid", s.outline, rows);
      AddErrorRows(method.method + ", corners", s.corners, rows);
    }
    report_.Table("Errors (px): measured less true",
                  {"what", "along", "count", "bias", "its standard error", "sigma", "95 % below"},
                  rows);
  }

  static void AddErrorRows(const std::string& what, const PlaceErrors& errors, Rows& rows) {
    const auto add = [&](const char* along, const ScalarErrors& e) {
      if (e.count == 0) return;
      rows.push_back({what, along, std::to_string(e.count), fmt::format("{:.4f}", e.bias),
                      fmt::format("{:.4f}", e.StandardError()), fmt::format("{:.4f}", e.sigma),
                      fmt::format("{:.4f}", e.p95)});
    };
    add("u", errors.u);
    add("v", errors.v);
    add("tilt", errors.tilt);
    add("outwards", errors.outward);
  }

  void Gallery(const std::string& caption, const std::vector<LabelledPicture>& pictures) {
    if (!pictures.empty()) report_.PictureGrid(caption, pictures, kGalleryColumns);
  }

  void Galleries() {
    report_.Heading("What went wrong");
    report_.Paragraph(
        "Green: the pixels that show the marker, and its name; red: the detection, and the name "
        "that it was given (?: none).");
    for (const MethodResult& method : evaluation_.methods) {
      const EvaluationGallery gallery =
          MakeEvaluationGallery(evaluation_, method, dataset_, kGalleryPictures);
      Gallery(method.method + ": misnamed, the most confident first", gallery.misnamed);
      Gallery(method.method + ": names where no marker is, the most confident first",
              gallery.false_positives);
      Gallery(method.method + fmt::format(": not found though wholly visible, {:g} px and more and "
                                          "below {:g} deg; the best SNR first",
                                          evaluation_.limits.target_size_px,
                                          evaluation_.limits.target_steep_incidence_deg),
              gallery.missed);
    }
  }

  void Compared() {
    const std::vector<PairedResult> results = PairedResults(evaluation_);
    if (results.empty()) return;
    report_.Heading("The methods on the same markers");
    Rows rows;
    for (const PairedResult& r : results) {
      rows.push_back({r.first, r.second, r.markers, std::to_string(r.both),
                      std::to_string(r.first_only), std::to_string(r.second_only),
                      std::to_string(r.neither), fmt::format("{:.2g}", r.P())});
    }
    report_.Table(
        "Found by both, one or none; p: McNemar's exact test that they find as many",
        {"first", "second", "markers", "both", "first only", "second only", "neither", "p"}, rows);
  }

  void Targets() {
    report_.Heading("Targets");
    Rows rows;
    for (const MethodResult& method : evaluation_.methods) {
      for (const EvaluationTarget& target : TargetsOf(evaluation_, method)) {
        const bool found = target.measure == "found";
        const double scale = target.share ? 100.0 : 1.0;
        rows.push_back(
            {target.met ? "met" : "MISSED", method.method, target.measure, target.markers,
             target.value ? fmt::format("{:.4f}", scale * *target.value) : "",
             target.share ? IntervalText(*target.share) : "",
             target.share ? fmt::format("{} of {}", target.share->count, target.share->of) : "",
             fmt::format("{} {:g} {}", found ? "at least" : "below", scale * target.aim,
                         target.share ? "%" : "px")});
      }
    }
    report_.Table(
        "What is asked and what was measured (wrong names: none, and the interval's end)",
        {"", "method", "measure", "markers", "measured", "interval (%)", "count", "asked"}, rows);
  }

  void HowMade(const std::string& command_line) {
    report_.HowMade(command_line);
    report_.Paragraph(
        "Every row of these tables, and more, is in evaluation.json; misses.csv has a row for each "
        "marker and method, false_positives.csv one for each name where no marker is.");
  }

  const Evaluation& evaluation_;
  const std::vector<EvaluationVariable>& variables_;
  const std::filesystem::path& dataset_;
  Report report_;
};

}  // namespace

void WriteEvaluationReport(const Evaluation& evaluation, const DatasetIndex& index,
                           const std::vector<EvaluationVariable>& variables,
                           const std::filesystem::path& dataset,
                           const std::filesystem::path& folder, const std::string& command_line) {
  EvaluationPage(evaluation, index, variables, dataset)
      .Compose(command_line)
      .Write(folder / "report.html");
}

}  // namespace retrolux
