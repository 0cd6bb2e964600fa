#include <algorithm>
#include <cmath>

#include "analysis/marker_coverage.h"
#include "analysis/marker_study_gain.h"
#include "analysis/plotly_figure.h"
#include "analysis/report.h"
#include "core/atomic_file.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using nlohmann::json;

constexpr int kRows = marker_grid::kRows;
constexpr int kColumns = marker_grid::kColumns;

// 33015.4 -> "33,015"
std::string Grouped(double value) {
  const std::string digits = fmt::format("{:.0f}", value);
  std::string grouped;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ',';
    grouped += digits[i];
  }
  return grouped;
}

std::string AreaNote(const CellSet& set) {
  return fmt::format("{:.1f} %, {} mm²", set.percent, Grouped(set.area_mm2));
}

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

  Report Compose(const std::string& command) {
    Summary();
    Gain();
    if (study_.poses.size() <= 3) {
      SetMaps();
      CountMaps();
      CameraMaps();
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

  void Gain() {
    const std::optional<MethodGain> gain = GainOverEdges(study_, coverage_);
    if (!gain) return;
    report_.Heading(fmt::format("What {} gains over edges", study_.options.method));
    report_.Paragraph(fmt::format(
        "Both methods saw the same pictures. {} named the marker in **{}** of them, edges in "
        "**{}**; only edges in {}.",
        study_.options.method, gain->both + gain->only_method, gain->both + gain->only_edges,
        gain->only_edges));
    std::vector<std::vector<std::string>> rows;
    for (const SetGain& g : gain->sets) {
      if (study_.poses.size() > 3 && !g.set.pose.empty()) continue;
      rows.push_back({std::to_string(g.set.marker), g.set.pose, g.set.name,
                      fmt::format("{:.1f}", g.edges_pct), fmt::format("{:.1f}", g.set.percent),
                      fmt::format("{:+.1f}", g.set.percent - g.edges_pct), std::to_string(g.won),
                      std::to_string(g.lost)});
    }
    report_.Table("Usable area of the face half, %, and cells of one half won and lost",
                  {"marker", "pose", "set", "edges / %", study_.options.method + " / %", "gain / %",
                   "cells won", "cells lost"},
                  rows);
  }

  OvalMap MapOf(const CellSet& set, const std::string& label) const {
    return {label, AreaNote(set), set.cells, set.cells};
  }

  void SetMaps() {
    report_.Heading("Usable positions (thesis figures 3.10 to 3.12)");
    report_.Paragraph(
        "A position is usable if at least two cameras identify the marker there. Black: usable. "
        "The half "
        "y < 0 is the mirror image, left and right cameras swapped.");
    for (const char* name : {"satisfies", "front", "back", "both"}) {
      std::vector<OvalMap> maps;
      for (const int marker : study_.options.markers) {
        for (const Pose& pose : study_.poses) {
          maps.push_back(MapOf(*coverage_.Set(name, marker, pose.name),
                               fmt::format("marker {}, {}", marker, pose.name)));
        }
      }
      report_.OvalMaps(Caption(name), HitMissCategories(), maps);
    }
    std::vector<OvalMap> maps;
    for (const int marker : study_.options.markers) {
      for (const char* name : {"all", "expanded"}) {
        if (const CellSet* set = coverage_.Set(name, marker, ""))
          maps.push_back(MapOf(*set, fmt::format("marker {}, {}", marker, name)));
      }
    }
    report_.OvalMaps(
        "All: both pairs in every pose (figure 3.11). Expanded: front cameras in reference and "
        "start, back "
        "cameras in reference and end (figure 3.12).",
        HitMissCategories(), maps);
  }

  static std::string Caption(const std::string& name) {
    if (name == "satisfies")
      return "Identified by at least two of the six cameras (figure 3.10, left and right together)";
    if (name == "front") return "By at least two front cameras (figure 3.10, left)";
    if (name == "back") return "By at least two back cameras (figure 3.10, right)";
    return "By two front and by two back cameras";
  }

  template <typename Value>
  OvalMap HalfMaps(const std::string& label, Value value, Value mirrored_value) const {
    OvalMap map{label, "", {}, {}};
    for (int row = 0; row < kRows; ++row) {
      for (int col = 0; col < kColumns; ++col) {
        map.left.push_back(value(row, col));
        map.right.push_back(mirrored_value(row, col));
      }
    }
    return map;
  }

  void CountMaps() {
    report_.Heading("How many cameras");
    std::vector<OvalMap> maps;
    for (const int marker : study_.options.markers) {
      for (int p = 0; p < static_cast<int>(study_.poses.size()); ++p) {
        const auto count = [&, marker, p](int r, int c) {
          return coverage_.CamerasHit(marker, p, r, c);
        };
        maps.push_back(HalfMaps(
            fmt::format("marker {}, {}", marker, study_.poses[static_cast<size_t>(p)].name), count,
            count));
      }
    }
    report_.OvalMaps("Number of cameras that identify the marker",
                     CountCategories(static_cast<int>(study_.cameras.size())), maps);
  }

  int MirroredCamera(int camera) const {
    std::string name = study_.cameras[static_cast<size_t>(camera)];
    const auto swap_end = [&](const std::string& from, const std::string& to) {
      if (!name.ends_with(from)) return false;
      name.replace(name.size() - from.size(), from.size(), to);
      return true;
    };
    if (!swap_end("-left", "-right")) swap_end("-right", "-left");
    return static_cast<int>(std::find(study_.cameras.begin(), study_.cameras.end(), name) -
                            study_.cameras.begin());
  }

  void CameraMaps() {
    report_.Heading("Camera by camera: hit, or why not");
    std::vector<std::string> names;
    for (int i = 0; i < kOutcomes; ++i) names.emplace_back(OutcomeName(static_cast<Outcome>(i)));
    for (const int marker : study_.options.markers) {
      for (int p = 0; p < static_cast<int>(study_.poses.size()); ++p) {
        std::vector<OvalMap> maps;
        for (int c = 0; c < static_cast<int>(study_.cameras.size()); ++c) {
          const auto at = [&, marker, p](int camera) {
            return [&, marker, p, camera](int r, int col) {
              return static_cast<int>(coverage_.OutcomeAt(marker, p, camera, r, col));
            };
          };
          maps.push_back(
              HalfMaps(study_.cameras[static_cast<size_t>(c)], at(c), at(MirroredCamera(c))));
        }
        report_.OvalMaps(
            fmt::format("Marker {}, {}", marker, study_.poses[static_cast<size_t>(p)].name),
            NamedCategories(names), maps);
      }
    }
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
                          PictureBytes(kept.file)});
    }
    if (pictures.empty()) return;
    report_.Heading("What the cameras record");
    report_.PictureGrid(fmt::format("Pictures of the study, pose {}, as the sensor gives them; "
                                    "dark levels raised (gamma 2.2) to show the "
                                    "mask",
                                    study_.poses.front().name),
                        pictures, 5);
  }

  std::string PictureBytes(const std::string& file) const {
    DigitalImage image = ReadGrey(folder_ / file);
    const double full_scale = (1 << image.bits) - 1;
    for (uint16_t& dn : image.dn.data) {
      dn = static_cast<uint16_t>(std::lround(255.0 * std::pow(dn / full_scale, 1.0 / 2.2)));
    }
    image.bits = 8;
    return EncodeGreyPng(image);
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
    report_.Heading("How it was made");
    report_.Paragraph(fmt::format("`{}`", command));
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

void WriteStudyReport(const MarkerStudy& study, const StudyCoverage& coverage,
                      const std::filesystem::path& folder, const std::string& command) {
  StudyReport(study, coverage, folder).Compose(command).Write(folder / "report.html");
}

}  // namespace retrolux
