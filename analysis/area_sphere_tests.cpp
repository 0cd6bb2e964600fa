#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/area_tests.h"
#include "analysis/cap_area.h"
#include "analysis/placement_cost.h"
#include "scenes/rig_layout.h"

namespace retrolux {

namespace {

constexpr double kRadius = kAreaSphereRadius_mm;
constexpr int kRing = 9;                          // cameras, 40 degrees apart
const Placement kEquator = {20.0, 90.0, 90.0};    // phi_b 20 makes phi_c 40 (eq. 4.9)
const Placement kTwoRigs = {20.0, 31.67, 70.52};  // the thesis's lowest and highest

double HalfAngle(double distance) {
  return std::acos(kRadius / distance);
}

std::vector<CameraModel> CamerasAt(const AreaBench& bench, const Placement& placement,
                                   bool far = false) {
  std::vector<CameraModel> cameras;
  for (const Vec3d& centre : CameraCentres(bench.Room(), placement))
    cameras.push_back(bench.Camera(centre, far));
  return cameras;
}

Vec3d OnEquator(double azimuth) {
  return {std::cos(azimuth), std::sin(azimuth), 0.0};
}

// What pairs of cameras share, `psi` apart.
AreaRow PairRow(const std::string& test, double psi, double distance, double rendered) {
  AreaRow row;
  row.test = test;
  row.x = DegFromRad(psi);
  row.psi_deg = row.x;
  row.rendered_mm2 = rendered;
  row.analytic_mm2 = TwoCapArea(kRadius, HalfAngle(distance), HalfAngle(distance), psi);
  row.far_mm2 = FarPairArea(kRadius, psi);
  return row;
}

// Camera 1, and those at the given angles from it.
std::vector<AreaRow> PairsFromFirst(AreaBench& bench, const Mask& sphere, const std::string& test,
                                    const std::vector<double>& psi_deg, bool far) {
  std::vector<CameraModel> cameras = {bench.Camera(OnEquator(0.0), far)};
  for (const double psi : psi_deg) cameras.push_back(bench.Camera(OnEquator(RadFromDeg(psi)), far));
  const std::vector<SampleSet> seen = bench.SeenOfSphere(sphere, cameras);
  std::vector<AreaRow> rows;
  for (size_t i = 0; i < psi_deg.size(); ++i) {
    rows.push_back(PairRow(test, RadFromDeg(psi_deg[i]), cameras[0].Centre().norm(),
                           sphere.AreaOf(InBoth(seen[0], seen[i + 1]))));
    rows.back().name = fmt::format("{:g} deg", psi_deg[i]);
  }
  return rows;
}

}  // namespace

std::vector<AreaRow> MeasureSingles(AreaBench& bench) {
  const Mask& sphere = bench.Fine();
  const std::vector<SampleSet> seen = bench.SeenOfSphere(sphere, CamerasAt(bench, kEquator));
  std::vector<AreaRow> rows;
  for (int i = 0; i < kRing; ++i) {
    AreaRow row;
    row.test = "single";
    row.name = fmt::format("camera {}", i + 1);
    row.rendered_mm2 = sphere.AreaOf(seen[static_cast<size_t>(i)]);
    row.analytic_mm2 = CapArea(kRadius, HalfAngle(bench.Distance_mm()));
    row.far_mm2 = FarPairArea(kRadius, 0.0);
    rows.push_back(row);
  }
  return rows;
}

std::vector<AreaRow> MeasurePairs(AreaBench& bench, int steps) {
  const Mask& sphere = bench.Fine();
  const std::vector<SampleSet> seen = bench.SeenOfSphere(sphere, CamerasAt(bench, kEquator));
  std::vector<AreaRow> rows;
  for (int i = 0; i < kRing; ++i) {
    const int j = (i + steps) % kRing;
    const SampleSet both = InBoth(seen[static_cast<size_t>(i)], seen[static_cast<size_t>(j)]);
    AreaRow row =
        PairRow("pair", steps * 2.0 * kPi / kRing, bench.Distance_mm(), sphere.AreaOf(both));
    row.group = fmt::format("{} deg", 40 * steps);
    row.name = fmt::format("cameras {}-{}", i + 1, j + 1);
    rows.push_back(row);
  }
  return rows;
}

namespace {

// Three cameras of a placement: measured, and in closed form.
class TripletBench {
 public:
  TripletBench(AreaBench& bench, const Placement& placement)
      : room_(bench.Room()),
        sphere_(bench.Fine()),
        cameras_(CamerasAt(bench, placement)),
        seen_(bench.SeenOfSphere(sphere_, cameras_)),
        weights_(room_, {room_.error_points, room_.gamma_max_mm}, placement) {}

  // Area and cost.
  std::array<AreaRow, 2> Rows(std::array<int, 3> triplet, const std::string& group) const {
    std::sort(triplet.begin(), triplet.end());
    const std::vector<int> cameras(triplet.begin(), triplet.end());
    const std::vector<double> rendered = Rendered(triplet), analytic = Analytic(triplet);
    AreaRow area;
    area.test = "triplet";
    area.group = group;
    area.name = "cameras " + NameOf(SetOf(cameras));
    area.psi_deg = DegFromRad(weights_.MinAngleRad(SetOf(cameras)));
    area.rendered_mm2 = rendered.back();
    area.analytic_mm2 = analytic.back();
    AreaRow cost = area;
    cost.test = "triplet_cost";
    cost.rendered_mm2 = weights_.Of(SetOf(cameras), rendered, SetOf(cameras)).cost_mm2;
    cost.analytic_mm2 = weights_.Of(SetOf(cameras), analytic, SetOf(cameras)).cost_mm2;
    return {area, cost};
  }

 private:
  std::vector<double> Rendered(const std::array<int, 3>& triplet) const {
    std::vector<const SampleSet*> sets;
    for (const int camera : triplet) sets.push_back(&seen_[static_cast<size_t>(camera)]);
    return AreasSeenByAll(sets, sphere_.Samples().areas_mm2);
  }

  std::vector<double> Analytic(const std::array<int, 3>& triplet) const {
    std::vector<double> areas;
    for (size_t subset = 0; subset < 8; ++subset) {
      std::vector<Cap> caps;
      for (size_t k = 0; k < 3; ++k) {
        if ((subset >> k & 1u) == 0) continue;
        const Vec3d centre = cameras_[static_cast<size_t>(triplet[k])].Centre();
        caps.push_back(VisibleCap(Vec3d::Zero(), kRadius, centre));
      }
      areas.push_back(CapIntersectionArea(kRadius, caps));
    }
    return areas;
  }

  const Scenario& room_;
  const Mask& sphere_;
  std::vector<CameraModel> cameras_;
  std::vector<SampleSet> seen_;
  PlacementWeights weights_;
};

}  // namespace

std::vector<AreaRow> MeasureTriplets(AreaBench& bench) {
  const TripletBench triplets(bench, kEquator);
  std::vector<AreaRow> rows;
  for (int i = 0; i < kRing; ++i) {
    for (const AreaRow& row :
         triplets.Rows({i, (i + 1) % kRing, (i + 2) % kRing}, "in a plane, 40 deg"))
      rows.push_back(row);
  }
  return rows;
}

std::vector<AreaRow> MeasureRigTriplets(AreaBench& bench) {
  const TripletBench triplets(bench, kTwoRigs);
  std::vector<AreaRow> rows;
  for (int i = 0; i < kRing; ++i) {
    // Cameras 1, 3, 5, 7, 9 hang on rig 2; 9 and 1 are neighbours.
    const char* group = i + 2 >= kRing ? "rigs, two neighbours on one"
                        : i % 2 == 0   ? "rigs 2-1-2"
                                       : "rigs 1-2-1";
    for (const AreaRow& row : triplets.Rows({i, (i + 1) % kRing, (i + 2) % kRing}, group))
      rows.push_back(row);
  }
  return rows;
}

std::vector<AreaRow> MeasureFarPairs(AreaBench& bench) {
  std::vector<double> psi_deg;
  for (int psi = 0; psi <= 170; psi += 10) psi_deg.push_back(psi);
  return PairsFromFirst(bench, bench.Fine(), "far_pair", psi_deg, true);
}

std::vector<AreaRow> MeasurePairsOverPsi(AreaBench& bench) {
  std::vector<double> psi_deg;
  for (int psi = 2; psi <= 170; psi += 2) psi_deg.push_back(psi);
  return PairsFromFirst(bench, bench.Coarse(), "pair_over_psi", psi_deg, false);
}

namespace {

std::vector<PlacedNozzle> NozzlesAt(const AreaBench& bench, const Mask& sphere) {
  std::vector<Vec3d> points;
  for (const Vec3f& position : sphere.Mesh().positions)
    points.push_back(bench.Rotation() * position.cast<double>());
  std::vector<PlacedNozzle> nozzles;
  for (const Beam& beam : bench.Room().beams)
    nozzles.push_back(PlaceNozzle(bench.Room().nozzle, beam, points));
  return nozzles;
}

}  // namespace

std::vector<AreaRow> MeasureBeam(AreaBench& bench, bool far) {
  constexpr int kFirst_deg = 10, kLast_deg = 90;
  const Mask& sphere = bench.Coarse();
  const std::vector<PlacedNozzle> nozzles = NozzlesAt(bench, sphere);
  std::vector<std::vector<AreaRow>> by_phi_b(kLast_deg - kFirst_deg + 1);
  ParallelFor(static_cast<int64_t>(by_phi_b.size()), [&](int64_t i) {
    const double phi_b = kFirst_deg + static_cast<double>(i);
    std::vector<CameraModel> cameras = CamerasAt(bench, {phi_b, 90.0, 90.0}, far);
    cameras.resize(2);
    const std::vector<SampleSet> whole = bench.SeenOfSphere(sphere, cameras);
    std::vector<SampleSet> seen = whole;
    for (size_t k = 0; k < 2; ++k)
      sphere.RemoveHidden(seen[k], bench.Rotation(), nozzles, cameras[k].Centre());
    const double psi = SeparationRad(cameras[0].Centre(), cameras[1].Centre());
    const double distance = cameras[0].Centre().norm();
    const std::string test = far ? "beam_far" : "beam";
    for (size_t k = 0; k < 3; ++k) {
      AreaRow row = PairRow(test, k < 2 ? 0.0 : psi, distance, 0.0);
      if (k < 2) row.psi_deg.reset();
      row.group = k < 2 ? fmt::format("camera {}", k + 1) : "both";
      row.name = fmt::format("phi_b {:g} deg", phi_b);
      row.x = phi_b;
      row.rendered_mm2 = sphere.AreaOf(k < 2 ? seen[k] : InBoth(seen[0], seen[1]));
      row.comparable = k < 2 ? seen[k] == whole[k] : seen == whole;
      by_phi_b[static_cast<size_t>(i)].push_back(row);
    }
  });
  std::vector<AreaRow> rows;
  for (size_t group = 0; group < 3; ++group) {
    for (const std::vector<AreaRow>& at : by_phi_b) rows.push_back(at[group]);
  }
  return rows;
}

}  // namespace retrolux
