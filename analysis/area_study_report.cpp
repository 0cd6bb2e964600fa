#include <algorithm>

#include "analysis/area_plots.h"
#include "analysis/area_study.h"
#include "analysis/area_tests.h"
#include "analysis/report.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

std::string Percent(double fraction) {
  return fmt::format("{:.3g} %", 100.0 * fraction);
}

class AreaReport {
 public:
  explicit AreaReport(const AreaStudy& study)
      : study_(study),
        curves_(AreaCurves(study)),
        report_("Visible areas against closed forms",
                fmt::format("Section 4.6 of the thesis; {} triangles, {} x {} pixels, visibility "
                            "by {}; retrolux " RETROLUX_VERSION,
                            study.options.Triangles(), study.options.width_px,
                            study.options.height_px, NameOf(study.options.rule))) {}

  Report Compose(const std::string& command_line) {
    Summary();
    Equivalent();
    Convergence();
    Far();
    Nozzles();
    Optimum();
    Shapes();
    TargetTable();
    HowMade(command_line);
    return std::move(report_);
  }

 private:
  void Draw(const std::string& caption, const PlotlyFigure& figure) {
    report_.Plot(caption, figure.traces, figure.layout, figure.height_px);
  }

  int Missed() const {
    return static_cast<int>(std::count_if(study_.targets.begin(), study_.targets.end(),
                                          [](const AreaTarget& t) { return !t.Met(); }));
  }

  void Summary() {
    const auto worst_pair = [&](const char* group) {
      return LargestError(study_.Rows("pair", group));
    };
    const double to_120 =
        std::max({worst_pair("40 deg"), worst_pair("80 deg"), worst_pair("120 deg")});
    const auto percent = [](double fraction) { return fmt::format("{:.3f}", 100.0 * fraction); };
    report_.KeyFigures(
        {{"Targets met", fmt::format("{}", study_.targets.size() - static_cast<size_t>(Missed())),
          fmt::format("of {}", study_.targets.size()), "all listed at the end"},
         {"One camera", percent(LargestError(study_.Rows("single"))), "%",
          "largest error of nine; asked: 0.1 %"},
         {"Pairs up to 120°", percent(to_120), "%", "largest of 27; asked: 0.2 %"},
         {"Pairs at 160°", percent(worst_pair("160 deg")), "%", "largest of nine; asked: 1 %"},
         {"Triplets", percent(LargestError(study_.Rows("triplet"))), "%",
          "largest of 18; asked: 0.2 %"},
         {"Far line, offset", fmt::format("{:.3f}", study_.far.offset), "r²",
          fmt::format("gradient {:.4f}; closed form: 2π − 2ψ", study_.far.gradient)}});
    report_.Paragraph(fmt::format(
        "A sphere of radius 100 mm, turned at random, is looked at from 1600 mm. What a camera "
        "sees of it is a cap, and what several see is what their caps share: closed forms that "
        "allow for the distance, while the thesis compared with cameras at infinity. The largest "
        "error of one camera is **{}**, of pairs up to 120° apart **{}**. {}",
        Percent(LargestError(study_.Rows("single"))), Percent(to_120),
        Missed() == 0 ? "All targets are met."
                      : fmt::format("**{} of {} targets are missed**; see the table at the end.",
                                    Missed(), study_.targets.size())));
  }

  void Equivalent() {
    report_.Heading("Equivalent cameras, pairs and triplets");
    std::vector<PlotCurve> curves = {ErrorsOfGroup("one camera", study_.Rows("single"))};
    for (const char* group : {"40 deg", "80 deg", "120 deg", "160 deg"}) {
      const std::string angle(group, std::find(group, group + 3, ' '));
      curves.push_back(ErrorsOfGroup("pairs at " + angle + "°", study_.Rows("pair", group)));
    }
    curves.push_back(
        ErrorsOfGroup("triplets in a plane", study_.Rows("triplet", "in a plane, 40 deg")));
    for (const char* group : {"rigs 2-1-2", "rigs 1-2-1", "rigs, two neighbours on one"}) {
      curves.push_back(
          ErrorsOfGroup(fmt::format("triplets, {}", group), study_.Rows("triplet", group)));
    }
    Draw(
        "Error of each camera, pair and triplet of a group that symmetry makes equal (the thesis's "
        "figures 4.16 to 4.19 show the deviation from their mean)",
        FigureOf(curves, AxisTitle("number in the group"), AxisTitle("error (%)")));
    EquivalentTable();
    report_.Paragraph(fmt::format(
        "The single cameras' areas lie {} off the closed form: the mesh of {} flat triangles has "
        "less area than the sphere. What remains is the samples' noise along the boundary of what "
        "is seen; "
        "a thin part has much of that for its area, so the pairs at 160° have the largest spread, "
        "**{}** (thesis: 0.078 %).",
        Percent(RmsError(study_.Rows("single"))), study_.options.Triangles(),
        Percent(Spread(study_.Rows("pair", "160 deg")))));
  }

  void EquivalentTable() {
    struct Group {
      const char *name, *test, *group, *thesis;
    };
    const Group groups[] = {
        {"one camera", "single", "", "0.027"},
        {"pairs at 40°", "pair", "40 deg", "0.013"},
        {"pairs at 80°", "pair", "80 deg", "0.020"},
        {"pairs at 120°", "pair", "120 deg", "0.066"},
        {"pairs at 160°", "pair", "160 deg", "0.078"},
        {"triplets in a plane", "triplet", "in a plane, 40 deg", "0.019"},
        {"their cost", "triplet_cost", "in a plane, 40 deg", "0.026"},
        {"triplets of rigs 2-1-2", "triplet", "rigs 2-1-2", ""},
        {"their cost", "triplet_cost", "rigs 2-1-2", ""},
        {"triplets of rigs 1-2-1", "triplet", "rigs 1-2-1", ""},
        {"their cost", "triplet_cost", "rigs 1-2-1", ""},
        {"triplets with two neighbours on rig 2", "triplet", "rigs, two neighbours on one", ""},
        {"their cost", "triplet_cost", "rigs, two neighbours on one", ""}};
    std::vector<std::vector<std::string>> table;
    for (const Group& group : groups) {
      const AreaRows rows = study_.Rows(group.test, group.group);
      double mean = 0.0;
      for (const AreaRow* row : rows) mean += *row->rendered_mm2 / static_cast<double>(rows.size());
      const auto& far = rows.front()->far_mm2;
      table.push_back({group.name, std::to_string(rows.size()), fmt::format("{:.1f}", mean),
                       fmt::format("{:.1f}", *rows.front()->analytic_mm2),
                       far ? fmt::format("{:.1f}", *far) : "",
                       fmt::format("{:.4f}", 100.0 * LargestError(rows)),
                       fmt::format("{:.4f}", 100.0 * Spread(rows)), group.thesis});
    }
    report_.Table(
        "Groups that symmetry makes equal. Far: what the thesis's eq. 4.17 gives. Spread: its eq. "
        "4.15. Cost: the area weighted by the pairs' reconstruction errors.",
        {"group", "members", "mean (mm²)", "closed form (mm²)", "far (mm²)", "largest error (%)",
         "spread (%)", "spread in the thesis (%)"},
        table);
  }

  const AreaCurve* CurveOf(const std::string& shape, const std::string& rule,
                           const std::string& axis) const {
    for (const AreaCurve& curve : curves_) {
      if (curve.shape == shape && curve.rule == rule && curve.axis == axis) return &curve;
    }
    return nullptr;
  }

  void ConvergenceFigure(const std::string& axis, const std::string& title,
                         const std::string& caption) {
    std::vector<PlotCurve> drawn;
    for (const AreaCurve& curve : curves_) {
      if (curve.axis == axis) drawn.push_back(ErrorsOf(curve));
    }
    Draw(caption, FigureOf(drawn, LogAxisTitle(title), LogAxisTitle("RMS error (%)")));
  }

  std::string Falls(const char* shape, const char* rule, const char* axis) const {
    const AreaCurve* curve = CurveOf(shape, rule, axis);
    if (!curve) return "–";
    return fmt::format("from {} at {:.0f} to {} at {:.0f}", Percent(curve->points.front().rms),
                       curve->points.front().x, Percent(curve->points.back().rms),
                       curve->points.back().x);
  }

  void Convergence() {
    report_.Heading("How the error falls");
    report_.Paragraph(fmt::format(
        "RMS over {} random rotations of the error of one camera's cap, of a pair 120° apart and "
        "of a disc that a sheet hides half of, for three rules of visibility: the id buffer "
        "(**ids**), a ray to each sample (**rays**), and the thesis's whole **triangles**. While "
        "one thing is varied the others stay at {} x {} pixels, {} triangles (the disc: as large "
        "ones) and 16 samples a triangle (but for the rule of whole triangles: one).",
        study_.options.rotations, study_.options.width_px, study_.options.height_px,
        study_.options.Triangles()));
    ConvergenceFigure("triangles", "triangles of the mesh", "Error over the size of the mesh");
    ConvergenceFigure("samples", "samples", "Error over the number of samples");
    ConvergenceFigure("pixels across", "pixels across the picture", "Error over the resolution");
    report_.Paragraph(fmt::format(
        "**Mesh.** With samples, the cap's error falls {}: as the area that flat triangles lack, "
        "with their number. The thesis's rule, on the pair, falls {}.",
        Falls("cap", "ids", "triangles"), Falls("pair at 120 deg", "triangles", "triangles")));
    report_.Paragraph(fmt::format(
        "**Samples.** The pair's error falls {}; stratified samples err only on the boundary, so "
        "it falls faster than with the root of their number, down to what the mesh lacks.",
        Falls("pair at 120 deg", "ids", "samples")));
    report_.Paragraph(fmt::format(
        "**Resolution.** Nothing of a sphere depends on it: facing is decided by the normal, and a "
        "convex surface hides none of what faces the camera. Where one surface hides another, the "
        "id buffer knows the edge to a pixel: the half-hidden disc's error falls {}. Rays know no "
        "pixels: {} throughout, which is the samples' own.",
        Falls("half-hidden disc", "ids", "pixels across"),
        Percent(CurveOf("half-hidden disc", "rays", "pixels across")->points.back().rms)));
    ConvergenceTable();
  }

  void ConvergenceTable() {
    std::vector<std::vector<std::string>> table;
    for (const AreaCurve& curve : curves_) {
      for (const AreaCurve::Point& point : curve.points) {
        table.push_back({curve.shape, curve.rule, curve.axis, fmt::format("{:.0f}", point.x),
                         fmt::format("{:.4f}", 100.0 * point.rms),
                         fmt::format("{:.4f}", 100.0 * point.largest)});
      }
    }
    report_.Table("The same in numbers",
                  {"shape", "rule", "varied", "value", "RMS error (%)", "largest error (%)"},
                  table);
  }

  void Far() {
    constexpr double unit_area_mm2 = kAreaSphereRadius_mm * kAreaSphereRadius_mm;
    report_.Heading("The far limit");
    const AreaRows rows = study_.Rows("far_pair");
    PlotCurve line{"2π − 2ψ", {0.0, 180.0}, {2.0 * kPi, 0.0}, kGrey, "lines", "dash"};
    PlotCurve measured = AreasOver("measured", rows, &AreaRow::rendered_mm2);
    measured.mode = "markers";
    measured.colour = kBlue;
    Draw("What two cameras at 160 m see in common over their separation (thesis figure 4.21)",
         FigureOf({line, measured}, AxisTitle("ψ (degrees)"), AxisTitle("area / r²")));
    report_.Paragraph(fmt::format(
        "From 100 times as far away, with a lens as much longer, the areas follow the line "
        "**{:.4f} "
        "{:+.4f} ψ** (thesis: 6.3 and −2.0; at infinity 2π = 6.2832 and −2). At 1600 mm they would "
        "not: one camera sees {:.4f} r² there, and a pair at 80° {:.4f} r² instead of 3.4907.",
        study_.far.offset, study_.far.gradient,
        *study_.Rows("single").front()->rendered_mm2 / unit_area_mm2,
        *study_.Rows("pair", "80 deg").front()->rendered_mm2 / unit_area_mm2));
  }

  static std::string Hidden(const BeamThresholds& thresholds) {
    std::string text = thresholds.all_hidden_up_to > 0.0
                           ? fmt::format("fully up to {:.0f}°", thresholds.all_hidden_up_to)
                           : "never fully";
    return text + (thresholds.part_hidden_up_to > 0.0
                       ? fmt::format(", partly up to {:.0f}°", thresholds.part_hidden_up_to)
                       : ", and nowhere partly");
  }

  void Nozzles() {
    report_.Heading("Behind the nozzles");
    std::vector<PlotCurve> curves;
    const char* colours[] = {kVermillion, kBlue, kBlack};
    const char* groups[] = {"camera 1", "camera 2", "both"};
    for (size_t i = 0; i < 3; ++i) {
      PlotCurve curve =
          AreasOver(groups[i], study_.Rows("beam", groups[i]), &AreaRow::rendered_mm2);
      curve.colour = colours[i];
      curve.mode = "lines";
      curves.push_back(curve);
    }
    PlotCurve whole =
        AreasOver("both, without nozzles", study_.Rows("beam", "both"), &AreaRow::analytic_mm2);
    whole.colour = kGrey;
    whole.mode = "lines";
    whole.dash = "dash";
    curves.push_back(whole);
    Draw(
        "What cameras 1 and 2 see of the sphere over φb, all cameras in the beam's plane (thesis "
        "figure 4.22)",
        FigureOf(curves, AxisTitle("φb (degrees)"), AxisTitle("area / r²")));
    report_.Paragraph(fmt::format(
        "Camera 1 is hidden {}; camera 2 {}. Thesis: one camera fully below 25°, the other partly "
        "below 20°, none over 60°. Camera 2 stands at 45° + 0.75 φb, which is {:.1f}° where φb is "
        "20°: the thesis's 20 and 60 are one fact, and its 25 and 60 say how wide its nozzle's "
        "shadow was. It gives no nozzle; ours are the scenario's, and their shadow hides all of "
        "the sphere up to {:.0f}° and some of it up to {:.0f}°.",
        Hidden(study_.camera_1), Hidden(study_.camera_2), 45.0 + 0.75 * 20.0,
        study_.camera_1.all_hidden_up_to, study_.camera_1.part_hidden_up_to));
    report_.Paragraph(fmt::format(
        "From far away, what both see at φb over 60° follows **{:.3f} {:+.4f} φb** in r² and "
        "radians (eq. 4.18: 3π/2 = 4.712 and 0.5; thesis: 4.7 and 0.5).",
        study_.beam_far.offset, study_.beam_far.gradient));
  }

  void Optimum() {
    report_.Heading("The best angle of a pair");
    const AreaRows rows = study_.Rows("optimal_angle");
    PlotCurve measured = AreasOver("measured", rows, &AreaRow::rendered_mm2);
    measured.mode = "markers";
    measured.colour = kBlue;
    PlotCurve analytic = AreasOver("closed form", rows, &AreaRow::analytic_mm2);
    analytic.mode = "lines";
    analytic.colour = kBlack;
    PlotCurve far = AreasOver("at infinity", rows, &AreaRow::far_mm2);
    far.mode = "lines";
    far.dash = "dash";
    far.colour = kGrey;
    Draw(fmt::format("Cost of a pair over its separation (thesis figure 4.23), gamma_max {} mm",
                     study_.gamma_max_mm),
         FigureOf({far, analytic, measured}, AxisTitle("ψ (degrees)"), AxisTitle("cost / r²")));
    PlotCurve unit{"the thesis's sphere, r = 1 mm", study_.gammas_mm, study_.optimum_unit_deg,
                   kVermillion, "lines"};
    PlotCurve ours{"r = 100 mm", study_.gammas_mm, study_.optimum_deg, kBlue, "lines"};
    PlotCurve mark{"calibrated",
                   {study_.gamma_max_mm, study_.gamma_max_mm},
                   {study_.calibrated_unit_deg, study_.calibrated_deg},
                   kBlack,
                   "markers",
                   "solid",
                   "star"};
    Draw("The best separation over the greatest error allowed, gamma_max",
         FigureOf({unit, ours, mark}, AxisTitle("gamma_max (mm)"), AxisTitle("best ψ (degrees)")));
    report_.Paragraph(fmt::format(
        "The thesis does not print gamma_max. With **{} mm** its sphere is seen best from "
        "**{:.2f}° "
        "apart** (its section 4.6.4: 56°), and the sphere of 100 mm, of which each camera sees "
        "less, from **{:.2f}°**; measured: {:.2f}°.",
        study_.gamma_max_mm, study_.calibrated_unit_deg, study_.calibrated_deg,
        study_.rendered_deg));
  }

  void Shapes() {
    report_.Heading("Other shapes");
    std::vector<std::vector<std::string>> table;
    for (const char* test : {"disc", "ellipsoid"}) {
      for (const AreaRow* row : study_.Rows(test)) {
        const auto error = row->RelError();
        table.push_back({test, row->Case(), fmt::format("{:.2f}", *row->rendered_mm2),
                         fmt::format("{:.2f}", *row->analytic_mm2),
                         error ? fmt::format("{:.4f}", 100.0 * *error) : ""});
      }
    }
    report_.Table("A disc of radius 100 mm and an oval of 200 x 200 x 280 mm",
                  {"shape", "case", "measured (mm²)", "closed form (mm²)", "error (%)"}, table);
    double from_behind = 0.0;
    for (const AreaRow* row : study_.Rows("disc")) {
      if (*row->analytic_mm2 == 0.0) from_behind = std::max(from_behind, *row->rendered_mm2);
    }
    report_.Paragraph(fmt::format(
        "Of the disc, tilted by up to 89°, the largest error is {}, and of a one-sided one {:g} "
        "mm² are seen from behind, where nothing should be. Of the oval, whose curvature differs "
        "from place to place, the largest error is {}.",
        Percent(LargestError(study_.Rows("disc"))), from_behind,
        Percent(LargestError(study_.Rows("ellipsoid")))));
  }

  void TargetTable() {
    report_.Heading("Targets");
    std::vector<std::vector<std::string>> table;
    for (const AreaTarget& target : study_.targets) {
      table.push_back(
          {target.Met() ? "met" : "MISSED", target.name, fmt::format("{:.4f}", target.measured),
           target.aim == 0.0 ? fmt::format("below {:g}", target.tolerance)
                             : fmt::format("{:.4f} ± {:g}", target.aim, target.tolerance),
           target.unit == "r2"       ? "r²"
           : target.unit == "r2/rad" ? "r²/rad"
                                     : target.unit});
    }
    report_.Table("What was asked and what was measured",
                  {"", "target", "measured", "asked", "unit"}, table);
  }

  void HowMade(const std::string& command_line) {
    report_.HowMade(command_line);
    report_.Paragraph(fmt::format(
        "Seed {}: it turns the meshes and spreads the samples. One sample of the sphere stands for "
        "{:g} mm² at most, in the curves over φb and ψ for 16 times that. All areas are in "
        "areas.csv.",
        study_.options.seed, study_.options.part_area_mm2));
  }

  const AreaStudy& study_;
  std::vector<AreaCurve> curves_;
  Report report_;
};

}  // namespace

void WriteAreaReport(const AreaStudy& study, const std::filesystem::path& folder,
                     const std::string& command_line) {
  AreaReport(study).Compose(command_line).Write(folder / "report.html");
}

}  // namespace retrolux
