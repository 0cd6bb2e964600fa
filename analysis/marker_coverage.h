// From hits to usable areas: which positions which cameras can use.
#pragma once

#include "analysis/marker_study.h"

namespace retrolux {

// A set of cells of one half of the grid; the mirrored half is the same with left and right cameras
// swapped, and none of the sets tells left from right.
struct CellSet {
  std::string name;  // satisfies, front, back, both; for all poses together: all, expanded
  int marker = 0;
  std::string pose;        // empty for sets over several poses
  std::vector<int> cells;  // 28 x 14, row by row, 1 = in the set
  double area_mm2 = 0.0;   // both halves
  double percent = 0.0;    // of the face half
};

class StudyCoverage {
 public:
  explicit StudyCoverage(const MarkerStudy& study);

  // How many cameras hit a cell; with a stride, of the sample that stands for the cell.
  int CamerasHit(int marker, int pose, int row, int col) const {
    return At(marker, pose, row, col).all;
  }
  // The outcome at a cell for one camera.
  Outcome OutcomeAt(int marker, int pose, int camera, int row, int col) const;

  // satisfies: hit by at least 2 cameras in that pose; front, back: by at least 2 of those; both:
  // front and back; all: both in every pose; expanded: front in reference and start, and back in
  // reference and end (only if the study has these poses).
  const std::vector<CellSet>& Sets() const { return sets_; }
  const CellSet* Set(const std::string& name, int marker, const std::string& pose) const;

 private:
  struct Hits {
    int all = 0, front = 0, back = 0;
  };
  const Hits& At(int marker, int pose, int row, int col) const;
  size_t SampleIndex(int row, int col) const;
  template <typename Test>
  void AddSet(const std::string& name, int marker, const std::string& pose, Test test);

  const MarkerStudy& study_;
  int sample_rows_, sample_cols_;
  std::vector<std::vector<std::vector<Hits>>> hits_;  // [marker index][pose][sample]
  std::vector<std::vector<std::vector<std::vector<Outcome>>>>
      outcomes_;  // [marker index][pose][camera][sample]
  std::vector<CellSet> sets_;
};

// How the mirrored positions that were rendered compare with their mirror images: hits that agree,
// of how many.
struct SymmetryCheck {
  int pictures = 0;
  int agree = 0;
};
SymmetryCheck CheckSymmetry(const MarkerStudy& study);

// hits.csv, coverage.csv and summary.json into `folder`.
void WriteStudyFiles(const MarkerStudy& study, const StudyCoverage& coverage,
                     const std::filesystem::path& folder);
nlohmann::json StudySummary(const MarkerStudy& study, const StudyCoverage& coverage);

// report.html into `folder`; `room` is the scene of the study, `command` tells how it was made.
void WriteStudyReport(const MarkerStudy& study, const StudyCoverage& coverage, const Scene& room,
                      const std::filesystem::path& folder, const std::string& command);

}  // namespace retrolux
