#include "analysis/marker_coverage.h"

#include <algorithm>

namespace retrolux {

namespace {

constexpr int kRows = marker_grid::kRows;
constexpr int kColumns = marker_grid::kColumns;

size_t IndexOf(const std::vector<int>& values, int value) {
  const auto found = std::find(values.begin(), values.end(), value);
  RETROLUX_CHECK(found != values.end(), "marker {} is not in the study", value);
  return static_cast<size_t>(found - values.begin());
}

int SamplesAlong(int cells, int stride) {
  return (cells - stride / 2 + stride - 1) / stride;
}

}  // namespace

StudyCoverage::StudyCoverage(const MarkerStudy& study)
    : study_(study),
      sample_rows_(SamplesAlong(kRows, study.options.stride)),
      sample_cols_(SamplesAlong(kColumns, study.options.stride)) {
  const auto samples = static_cast<size_t>(sample_rows_ * sample_cols_);
  hits_.assign(study.options.markers.size(),
               std::vector(study.poses.size(), std::vector<Hits>(samples)));
  outcomes_.assign(study.options.markers.size(),
                   std::vector(study.poses.size(),
                               std::vector(study.cameras.size(), std::vector<Outcome>(samples))));
  for (const PictureResult& result : study.results) {
    const size_t m = IndexOf(study.options.markers, result.marker);
    const size_t sample = SampleIndex(result.position.row, result.position.col);
    outcomes_[m][static_cast<size_t>(result.pose)][static_cast<size_t>(result.camera)][sample] =
        result.outcome;
    if (result.outcome != Outcome::kHit) continue;
    Hits& hits = hits_[m][static_cast<size_t>(result.pose)][sample];
    ++hits.all;
    ++(study.cameras[static_cast<size_t>(result.camera)].starts_with("front") ? hits.front
                                                                              : hits.back);
  }
  const auto pose_index = [&](const std::string& name) {
    for (size_t p = 0; p < study.poses.size(); ++p) {
      if (study.poses[p].name == name) return static_cast<int>(p);
    }
    return -1;
  };
  const int reference = pose_index("reference"), start = pose_index("start"),
            end = pose_index("end");
  for (const int marker : study.options.markers) {
    for (int p = 0; p < static_cast<int>(study.poses.size()); ++p) {
      const std::string& pose = study.poses[static_cast<size_t>(p)].name;
      AddSet("satisfies", marker, pose, [&](int r, int c) { return At(marker, p, r, c).all >= 2; });
      AddSet("front", marker, pose, [&](int r, int c) { return At(marker, p, r, c).front >= 2; });
      AddSet("back", marker, pose, [&](int r, int c) { return At(marker, p, r, c).back >= 2; });
      AddSet("both", marker, pose, [&](int r, int c) {
        return At(marker, p, r, c).front >= 2 && At(marker, p, r, c).back >= 2;
      });
    }
    AddSet("all", marker, "", [&](int r, int c) {
      for (int p = 0; p < static_cast<int>(study.poses.size()); ++p) {
        if (At(marker, p, r, c).front < 2 || At(marker, p, r, c).back < 2) return false;
      }
      return true;
    });
    if (reference < 0 || start < 0 || end < 0) continue;
    AddSet("expanded", marker, "", [&](int r, int c) {
      return At(marker, reference, r, c).front >= 2 && At(marker, start, r, c).front >= 2 &&
             At(marker, reference, r, c).back >= 2 && At(marker, end, r, c).back >= 2;
    });
  }
}

size_t StudyCoverage::SampleIndex(int row, int col) const {
  const int r = std::min(row / study_.options.stride, sample_rows_ - 1);
  const int c = std::min(col / study_.options.stride, sample_cols_ - 1);
  return static_cast<size_t>(r * sample_cols_ + c);
}

const StudyCoverage::Hits& StudyCoverage::At(int marker, int pose, int row, int col) const {
  return hits_[IndexOf(study_.options.markers, marker)][static_cast<size_t>(pose)]
              [SampleIndex(row, col)];
}

Outcome StudyCoverage::OutcomeAt(int marker, int pose, int camera, int row, int col) const {
  return outcomes_[IndexOf(study_.options.markers, marker)][static_cast<size_t>(pose)]
                  [static_cast<size_t>(camera)][SampleIndex(row, col)];
}

template <typename Test>
void StudyCoverage::AddSet(const std::string& name, int marker, const std::string& pose,
                           Test test) {
  CellSet set{name, marker, pose, {}, 0.0, 0.0};
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kColumns; ++col) {
      const bool in_set = test(row, col);
      set.cells.push_back(in_set ? 1 : 0);
      if (in_set) set.area_mm2 += 2.0 * marker_grid::CellArea_mm2(row);
    }
  }
  set.percent = 100.0 * set.area_mm2 / marker_grid::FaceHalfArea_mm2();
  sets_.push_back(std::move(set));
}

const CellSet* StudyCoverage::Set(const std::string& name, int marker,
                                  const std::string& pose) const {
  for (const CellSet& set : sets_) {
    if (set.name == name && set.marker == marker && set.pose == pose) return &set;
  }
  return nullptr;
}

SymmetryCheck CheckSymmetry(const MarkerStudy& study) {
  const auto mirrored_camera = [&](int camera) {
    std::string name = study.cameras[static_cast<size_t>(camera)];
    if (name.ends_with("-left")) {
      name.replace(name.size() - 5, 5, "-right");
    } else if (name.ends_with("-right")) {
      name.replace(name.size() - 6, 6, "-left");
    }
    return static_cast<int>(std::find(study.cameras.begin(), study.cameras.end(), name) -
                            study.cameras.begin());
  };
  SymmetryCheck check;
  for (const PictureResult& m : study.mirrored) {
    for (const PictureResult& r : study.results) {
      if (r.marker != m.marker || r.pose != m.pose || r.position.row != m.position.row ||
          r.position.col != m.position.col || r.camera != mirrored_camera(m.camera)) {
        continue;
      }
      ++check.pictures;
      if ((r.outcome == Outcome::kHit) == (m.outcome == Outcome::kHit)) ++check.agree;
    }
  }
  return check;
}

}  // namespace retrolux
