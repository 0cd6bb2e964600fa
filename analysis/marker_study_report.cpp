#include <algorithm>
#include <cmath>

#include "analysis/marker_coverage.h"
#include "analysis/marker_study_sections.h"
#include "analysis/plotly_figure.h"
#include "analysis/raised_picture.h"
#include "core/atomic_file.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using nlohmann::json;

class StudyReport {
 public:
  StudyReport(const MarkerStudy& study, const StudyCoverage& coverage, std::filesystem::path folder)
      : study_(study),
        coverage_(coverage),
        folder_(std::move(folder)),
        report_(
            "Where markers can be placed on the mask",
            fmt::format("CT room, {} cameras, markers {}, method {}; retrolux " RETROLUX_VERSION,
                        study.cameras.size(), fmt::join(study.options.markers, " and "),
                        study.options.method)) {}

  Report Compose(const Scene& room, const std::string& command) {
    Summary();
    AddGain(study_, coverage_, report_);
    AddRoom(study_, coverage_, room, report_);
    if (study_.poses.size() <= 3) {
      AddMaps(study_, coverage_, report_);
    } else {
      ScanCurve();
    }
    Limits();
    Pictures();
    Symmetry();
    HowMade(command);
    return std::move(report_);
  }

 private:
  void Summary() {
    std::vector<KeyFigure> figures;
    for (const int marker : study_.options.markers) {
      for (const Pose& pose : study_.poses) {
        if (study_.poses.size() > 3 && pose.translation.z() != 0.0) continue;
        const CellSet& set = *coverage_.Set("satisfies", marker, pose.name);
        figures.push_back(
            {fmt::format("marker {}, {}", marker, pose.name), fmt::format("{:.1f}", set.percent),
             "%", fmt::format("{} mm² seen by two cameras or more", Grouped(set.area_mm2))});
      }
    }
    report_.KeyFigures(figures);
    for (const int marker : study_.options.markers) {
      const CellSet* expanded = coverage_.Set("expanded", marker, "");
      const CellSet* all = coverage_.Set("all", marker, "");
      if (!expanded) continue;
      report_.Paragraph(
          fmt::format("Marker {}: **{:.1f} %** of the face half ({} mm²) is usable by front and "
                      "back cameras in every pose, "
                      "**{:.1f} %** ({} mm²) if the front cameras watch the first part of the scan "
                      "and the back cameras the rest.",
                      marker, all->percent, Grouped(all->area_mm2), expanded->percent,
                      Grouped(expanded->area_mm2)));
    }
    const auto wrong =
        std::count_if(study_.results.begin(), study_.results.end(),
                      [](const PictureResult& r) { return r.detected && *r.detected != r.marker; });
    report_.Paragraph(
        fmt::format("{} pictures, {} of them rendered; in the others no ray sees the marker. The "
                    "marker was given another's number "
                    "in **{}** of them.",
                    study_.results.size(), study_.composed, wrong));
  }

  void ScanCurve() {
    report_.Heading("Usable area over the scan");
    json traces = json::array();
    for (const int marker : study_.options.markers) {
      for (const char* name : {"satisfies", "front", "back", "both"}) {
        json x = json::array(), y = json::array();
        for (const Pose& pose : study_.poses) {
          x.push_back(pose.translation.z());
          y.push_back(coverage_.Set(name, marker, pose.name)->percent);
        }
        traces.push_back({{"type", "scatter"},
                          {"mode", "lines+markers"},
                          {"name", fmt::format("marker {}, {}", marker, name)},
                          {"x", x},
                          {"y", y}});
      }
    }
    report_.Plot(
        "Usable area of the face half over the position of the patient. Satisfies: at least two of "
        "six cameras; front, "
        "back: at least two of three; both: front and back.",
        traces,
        {{"xaxis", AxisTitle("centre of the oval along z / mm")},
         {"yaxis",
          {{"title", {{"text", "usable area / % of the face half"}}}, {"rangemode", "tozero"}}}});
  }

  void Limits() {
    report_.Heading("What limits it");
    constexpr int kBin = 5;
    json traces = json::array();
    std::vector<std::vector<std::string>> rows;
    for (size_t c = 0; c < study_.cameras.size(); ++c) {
      std::vector<int> hits(18, 0), all(18, 0);
      double last = 0.0;
      for (const PictureResult& r : study_.results) {
        if (r.camera != static_cast<int>(c) || r.visible_fraction < 0.999 ||
            r.incidence_deg >= 90.0)
          continue;
        const auto bin = static_cast<size_t>(r.incidence_deg / kBin);
        ++all[bin];
        if (r.outcome != Outcome::kHit) continue;
        ++hits[bin];
        last = std::max(last, r.incidence_deg);
      }
      json x = json::array(), y = json::array();
      int total_hits = 0, total = 0;
      for (size_t bin = 0; bin < all.size(); ++bin) {
        total_hits += hits[bin];
        total += all[bin];
        if (all[bin] == 0) continue;
        x.push_back((static_cast<double>(bin) + 0.5) * kBin);
        y.push_back(100.0 * hits[bin] / all[bin]);
      }
      traces.push_back({{"type", "scatter"},
                        {"mode", "lines+markers"},
                        {"name", study_.cameras[c]},
                        {"x", x},
                        {"y", y}});
      rows.push_back({study_.cameras[c], std::to_string(total), std::to_string(total_hits),
                      fmt::format("{:.1f}", last)});
    }
    report_.Plot(
        "Share of wholly visible markers that are identified, over the angle between the marker's "
        "normal and the line "
        "of sight, in bins of 5 degrees",
        traces,
        {{"xaxis", {{"title", {{"text", "incidence angle / degrees"}}}, {"range", {0, 90}}}},
         {"yaxis", {{"title", {{"text", "identified / %"}}}, {"range", {0, 105}}}}});
    report_.Table("Wholly visible markers, all markers and poses together",
                  {"camera", "visible", "identified", "last hit / deg"}, rows);
    ReasonBars();
    FrontAndBack();
  }

  // What geometry alone asks of a marker that a front and a back camera are to identify both.
  void FrontAndBack() {
    double smallest_deg = 180.0;
    for (size_t f = 0; f < study_.cameras.size(); ++f) {
      for (size_t b = 0; b < study_.cameras.size(); ++b) {
        if (!study_.cameras[f].starts_with("front") || !study_.cameras[b].starts_with("back"))
          continue;
        const Vec3d& front = study_.camera_centres[f];
        const Vec3d& back = study_.camera_centres[b];
        smallest_deg = std::min(
            smallest_deg, DegFromRad(std::acos(front.dot(back) / (front.norm() * back.norm()))));
      }
    }
    double last = 0.0;
    for (const PictureResult& r : study_.results) {
      if (r.outcome == Outcome::kHit) last = std::max(last, r.incidence_deg);
    }
    report_.Paragraph(
        fmt::format("Seen from the scan point a front and a back camera stand **{:.1f}°** apart or "
                    "more. A marker there that both are to identify "
                    "is seen by one of them at **{:.1f}°** incidence or more, however it is "
                    "turned; the most oblique hit of this study is at "
                    "**{:.1f}°**. Sheeting that keeps more of its retro-reflection at large "
                    "entrance angles (`--material`) moves that limit.",
                    smallest_deg, 0.5 * smallest_deg, last));
  }

  void ReasonBars() {
    json traces = json::array();
    for (int i = 0; i < kOutcomes; ++i) {
      json y = json::array();
      for (size_t c = 0; c < study_.cameras.size(); ++c) {
        y.push_back(std::count_if(
            study_.results.begin(), study_.results.end(), [&](const PictureResult& r) {
              return r.camera == static_cast<int>(c) && r.outcome == static_cast<Outcome>(i);
            }));
      }
      traces.push_back({{"type", "bar"},
                        {"name", OutcomeName(static_cast<Outcome>(i))},
                        {"x", study_.cameras},
                        {"y", y}});
    }
    report_.Plot("Outcomes by camera, all markers and poses", traces,
                 {{"barmode", "stack"}, {"yaxis", AxisTitle("pictures")}});
  }

  void Pictures() {
    std::vector<LabelledPicture> pictures;
    for (const KeptPicture& kept : study_.kept) {
      if (kept.kind.empty() || kept.result.pose != 0) continue;
      const PictureResult& r = kept.result;
      pictures.push_back({fmt::format("{}, {}: marker {}, {:.0f}°, {}",
                                      study_.cameras[static_cast<size_t>(r.camera)], kept.kind,
                                      r.marker, r.incidence_deg, OutcomeName(r.outcome)),
                          EncodeGreyPng(DarkLevelsRaised(ReadGrey(folder_ / kept.file)))});
    }
    if (pictures.empty()) return;
    report_.Heading("What the cameras record");
    report_.PictureGrid(fmt::format("Pictures of the study, pose {}, as the sensor gives them; "
                                    "dark levels raised (gamma 2.2) to show the "
                                    "mask",
                                    study_.poses.front().name),
                        pictures, 5);
  }

  void Symmetry() {
    const SymmetryCheck symmetry = CheckSymmetry(study_);
    if (symmetry.pictures == 0) return;
    report_.Heading("Is the other half the mirror image?");
    report_.Paragraph(
        fmt::format("{} pictures of positions on the half y < 0 were rendered and compared with "
                    "their mirror images: **{} agree** in hit or "
                    "miss. The marker itself is not mirrored, so that near the last hits single "
                    "pictures may differ.",
                    symmetry.pictures, symmetry.agree));
  }

  void HowMade(const std::string& command) {
    report_.HowMade(command);
    const MarkerStudy::Times& t = study_.times;
    report_.Paragraph(fmt::format(
        "{} samples per pixel, seed {}, noise seed {}; {:.0f} pixels traced again for a picture on "
        "average. In this run {} tasks of {} (one camera in one pose each): backgrounds {:.0f} s, "
        "pictures {:.0f} s; time of all threads: geometry {:.0f} s, tracing {:.0f} s, sensor "
        "{:.0f} s, identification {:.0f} s, writing {:.0f} s.",
        study_.options.samples_per_pixel, study_.options.seed, study_.options.noise_seed,
        static_cast<double>(study_.retraced_pixels) /
            static_cast<double>(std::max<int64_t>(1, study_.composed + study_.mirrored_composed)),
        study_.tasks.done_now, study_.tasks.done_before + study_.tasks.done_now, t.background,
        t.pictures, t.geometry, t.trace, t.sensor, t.identify, t.write));
    for (const char* file : {"hits.csv", "coverage.csv", "summary.json"})
      report_.Attachment(file, ReadTextFile(folder_ / file));
  }

  const MarkerStudy& study_;
  const StudyCoverage& coverage_;
  std::filesystem::path folder_;
  Report report_;
};

}  // namespace

std::string Grouped(double value) {
  const std::string digits = fmt::format("{:.0f}", value);
  std::string grouped;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ',';
    grouped += digits[i];
  }
  return grouped;
}

void WriteStudyReport(const MarkerStudy& study, const StudyCoverage& coverage, const Scene& room,
                      const std::filesystem::path& folder, const std::string& command) {
  StudyReport(study, coverage, folder).Compose(room, command).Write(folder / "report.html");
}

}  // namespace retrolux
