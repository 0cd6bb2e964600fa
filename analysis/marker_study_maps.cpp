#include <algorithm>

#include "analysis/marker_study_sections.h"

namespace retrolux {

namespace {

constexpr int kRows = marker_grid::kRows;
constexpr int kColumns = marker_grid::kColumns;

std::string AreaNote(const CellSet& set) {
  return fmt::format("{:.1f} %, {} mm²", set.percent, Grouped(set.area_mm2));
}

class StudyMaps {
 public:
  StudyMaps(const MarkerStudy& study, const StudyCoverage& coverage, Report& report)
      : study_(study), coverage_(coverage), report_(report) {}

  void Add() {
    SetMaps();
    CountMaps();
    CameraMaps();
  }

 private:
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

  const MarkerStudy& study_;
  const StudyCoverage& coverage_;
  Report& report_;
};

}  // namespace

void AddMaps(const MarkerStudy& study, const StudyCoverage& coverage, Report& report) {
  StudyMaps(study, coverage, report).Add();
}

}  // namespace retrolux
