// Evaluation of methods on labelled pictures: intervals and tests against published values and
// closed forms, the rules of matching on detections made by hand, and statistics against errors
// that were put in.
#include "analysis/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "analysis/evaluation_files.h"
#include "analysis/evaluation_input.h"
#include "analysis/evaluation_targets.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "core/marker_set.h"
#include "core/rng.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

// --- shares ---

// R. G. Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3 (score, no continuity
// correction), printed to four digits.
TEST(Proportion, WilsonIntervalsAsPublished) {
  struct Published {
    int64_t count, of;
    double low, high;
  };
  for (const Published& p : {Published{81, 263, 0.2553, 0.3662}, Published{15, 148, 0.0624, 0.1605},
                             Published{0, 20, 0.0, 0.1611}, Published{1, 29, 0.0061, 0.1718}}) {
    const Interval interval = Proportion{p.count, p.of}.Wilson();
    EXPECT_NEAR(interval.low, p.low, 5.1e-5) << p.count << " of " << p.of;
    EXPECT_NEAR(interval.high, p.high, 5.1e-5) << p.count << " of " << p.of;
  }
}

// With z = 1.96 the upper end for 0 of n is z^2 / (n + z^2), by mirror symmetry 1 - that is the
// lower end for n of n.
TEST(Proportion, EndsAreExactWhereNothingOrEverythingIsFound) {
  constexpr double kZ2 = 1.959963984540054 * 1.959963984540054;
  for (const int64_t n : {1, 50, 4000}) {
    const double end = kZ2 / (static_cast<double>(n) + kZ2);
    EXPECT_NEAR((Proportion{0, n}.Wilson().high), end, 1e-15);
    EXPECT_NEAR((Proportion{n, n}.Wilson().low), 1.0 - end, 1e-15);
    EXPECT_EQ((Proportion{0, n}.Wilson().low), 0.0);
    EXPECT_EQ((Proportion{n, n}.Wilson().high), 1.0);
  }
  EXPECT_FALSE((Proportion{0, 0}.Value()).has_value());
}

// n coins, at most k on one side: two tails of 2^-n sum of C(n, i). For k = 0: 2^(1-n); for k = 1:
// (n + 1) 2^(1-n); for halves more than 1 in sum, hence 1.
TEST(McNemar, AgainstTheBinomialSum) {
  EXPECT_EQ(McNemarExactP(0, 0), 1.0);
  for (const int64_t n : {1, 2, 10, 40}) {
    EXPECT_NEAR(McNemarExactP(0, n) * std::pow(2.0, static_cast<double>(n - 1)), 1.0, 1e-12) << n;
    EXPECT_EQ(McNemarExactP(n, n), 1.0);
  }
  EXPECT_NEAR(McNemarExactP(9, 1), 11.0 * std::pow(2.0, -9.0), 1e-12);
  EXPECT_EQ(McNemarExactP(3, 17), McNemarExactP(17, 3));
}

// --- matching, by hand ---

Polygon SquareAt(const Vec2d& centre, double half) {
  return {centre + Vec2d(-half, -half), centre + Vec2d(half, -half), centre + Vec2d(half, half),
          centre + Vec2d(-half, half)};
}

LabelledShape ShapeAt(int number, const Vec2d& centre, bool counts = true) {
  return {number, SquareAt(centre, 10.0), centre, counts};
}

Detection Named(std::optional<int> marker, const Vec2d& centre, double confidence = 0.9) {
  Detection detection;
  detection.marker = marker;
  detection.centroid_px = centre;
  detection.confidence = confidence;
  return detection;
}

std::vector<Verdict> VerdictsOf(const PictureMatch& match) {
  std::vector<Verdict> verdicts;
  for (const JudgedDetection& judged : match.detections) verdicts.push_back(judged.verdict);
  return verdicts;
}

using ::testing::ElementsAre;

TEST(Matching, NamesOfTouchingMarkersThatAreSwappedAreBothWrong) {
  const std::vector<LabelledShape> markers = {ShapeAt(2, {50, 50}), ShapeAt(3, {70, 50})};
  const PictureMatch match = MatchDetections(markers, {Named(3, {50, 50}), Named(2, {70, 50})}, 2);
  EXPECT_THAT(VerdictsOf(match), ElementsAre(Verdict::kMisnamed, Verdict::kMisnamed));
  EXPECT_EQ(match.detections[0].marker, 0u);
  EXPECT_EQ(match.detections[1].marker, 1u);
  EXPECT_EQ(match.markers[0].outcome, LabelOutcome::kMisnamed);
  EXPECT_EQ(match.markers[1].outcome, LabelOutcome::kMisnamed);
}

TEST(Matching, OfTwoRightNamesTheMoreConfidentOneCountsTheOtherIsADuplicate) {
  const PictureMatch match = MatchDetections(
      {ShapeAt(4, {50, 50})},
      {Named(4, {50, 50}, 0.96), Named(4, {52, 50}, 0.99), Named(4, {51, 50}, 0.9)}, 2);
  EXPECT_THAT(VerdictsOf(match),
              ElementsAre(Verdict::kDuplicate, Verdict::kFound, Verdict::kDuplicate));
  EXPECT_EQ(match.markers[0].detection, 1u);
}

TEST(Matching, AWrongNameBesideTheRightOneIsMisnamedAndTheMarkerIsFound) {
  const PictureMatch match = MatchDetections({ShapeAt(4, {50, 50})},
                                             {Named(1, {45, 50}, 1.0), Named(4, {50, 50}, 0.5)}, 2);
  EXPECT_THAT(VerdictsOf(match), ElementsAre(Verdict::kMisnamed, Verdict::kFound));
  EXPECT_EQ(match.markers[0].outcome, LabelOutcome::kFound);
  EXPECT_EQ(match.markers[0].wrong_names, 1);
}

TEST(Matching, ANameBesideAllMarkersIsAFalsePositiveAPatternWithoutNameIsNot) {
  const PictureMatch match = MatchDetections(
      {ShapeAt(4, {50, 50})},
      {Named(4, {80, 50}), Named(std::nullopt, {90, 50}), Named(std::nullopt, {50, 50})}, 2);
  EXPECT_THAT(VerdictsOf(match),
              ElementsAre(Verdict::kNothing, Verdict::kUnnamed, Verdict::kUnnamed));
  EXPECT_EQ(match.markers[0].outcome, LabelOutcome::kUnnamed);
  EXPECT_EQ(match.markers[0].detection, 2u);
}

TEST(Matching, WithinTheMarginOfTheHullAndNotBeyond) {
  const std::vector<LabelledShape> markers = {ShapeAt(0, {50, 50})};
  for (const double beyond : {-0.1, 1.9, 2.1}) {
    const Detection detection = Named(0, {60.0 + beyond, 50});
    const PictureMatch match = MatchDetections(markers, {detection}, 2.0);
    EXPECT_EQ(match.detections[0].verdict, beyond < 2.0 ? Verdict::kFound : Verdict::kNothing);
  }
  // Off a corner the distance is the diagonal's: 1.9 along both axes is 2.7 px.
  EXPECT_EQ(MatchDetections(markers, {Named(0, {61.9, 61.9})}, 2.0).detections[0].verdict,
            Verdict::kNothing);
}

TEST(Matching, BetweenTwoMarkersTheHullThatHoldsThePointWinsThenTheNearerCentre) {
  const std::vector<LabelledShape> apart = {ShapeAt(1, {50, 50}), ShapeAt(2, {71, 50})};
  EXPECT_EQ(MatchDetections(apart, {Named(1, {59.9, 50})}, 2).detections[0].marker, 0u);
  EXPECT_EQ(MatchDetections(apart, {Named(1, {61.1, 50})}, 2).detections[0].marker, 1u);
  const std::vector<LabelledShape> overlapping = {ShapeAt(1, {50, 50}), ShapeAt(2, {62, 50})};
  EXPECT_EQ(MatchDetections(overlapping, {Named(1, {55.9, 50})}, 2).detections[0].marker, 0u);
  EXPECT_EQ(MatchDetections(overlapping, {Named(1, {56.1, 50})}, 2).detections[0].marker, 1u);
}

TEST(Matching, OnAMarkerThatDoesNotCountARightNameIsIgnoredAWrongOneIsWrong) {
  const std::vector<LabelledShape> markers = {ShapeAt(5, {50, 50}, false)};
  const PictureMatch match =
      MatchDetections(markers, {Named(5, {50, 50}), Named(1, {52, 50}, 0.1)}, 2);
  EXPECT_THAT(VerdictsOf(match), ElementsAre(Verdict::kIgnored, Verdict::kMisnamed));
}

TEST(Matching, AHullOfOnePixelOrARowOfThem) {
  const std::vector<LabelledShape> markers = {{1, {{20, 20}}, {20, 20}, true},
                                              {2, {{40, 20}, {48, 20}}, {44, 20}, true}};
  const PictureMatch match =
      MatchDetections(markers, {Named(1, {21, 21}), Named(2, {44, 21.5}), Named(2, {44, 22.5})}, 2);
  EXPECT_THAT(VerdictsOf(match), ElementsAre(Verdict::kFound, Verdict::kFound, Verdict::kNothing));
}

// --- errors that were put in ---

// Standard normal numbers (Box and Muller 1958).
class Normals {
 public:
  explicit Normals(uint64_t key) : rng_(key) {}
  double Next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - rng_.NextDouble()));
    return radius * std::cos(2.0 * kPi * rng_.NextDouble());
  }

 private:
  KeyedRng rng_;
};

// n errors of bias b and deviation s per axis: the mean scatters by s / sqrt(n), sigma by
// s / sqrt(2 (n - 1)), and without bias the distances are Rayleigh distributed: rms sqrt(2) s, 95 %
// below s sqrt(2 ln 20), whose estimate scatters by sqrt(0.05 0.95 / n) / density there. All limits
// 4.5 of these, a significance below 1e-5 each.
TEST(ErrorStatistics, BiasSigmaAndPercentileOfNormalErrors) {
  constexpr int kCount = 20000;
  constexpr double kSigma = 0.04, kBias = 0.015;
  const double mean_error = kSigma / std::sqrt(kCount);
  const double sigma_error = kSigma / std::sqrt(2.0 * (kCount - 1));
  Normals normals(11);
  std::vector<PlaceError> centred, biased;
  const Vec2d tilt = Vec2d(1.0, 2.0).normalized();
  for (int i = 0; i < kCount; ++i) {
    const Vec2d noise(kSigma * normals.Next(), kSigma * normals.Next());
    centred.push_back({noise, std::nullopt, std::nullopt});
    biased.push_back({noise + kBias * tilt, tilt, std::nullopt});
  }
  const PlaceErrors c = PlaceErrorsOf(centred);
  EXPECT_NEAR(c.u.bias, 0.0, 4.5 * mean_error);
  EXPECT_NEAR(c.u.sigma, kSigma, 4.5 * sigma_error);
  EXPECT_NEAR(c.v.sigma, kSigma, 4.5 * sigma_error);
  EXPECT_NEAR(c.u.StandardError(), mean_error, 0.05 * mean_error);
  EXPECT_NEAR(c.rms, std::sqrt(2.0) * kSigma, 4.5 * sigma_error);
  const double p95 = kSigma * std::sqrt(2.0 * std::log(20.0));
  const double density = 0.05 * p95 / (kSigma * kSigma);
  EXPECT_NEAR(c.p95, p95, 4.5 * std::sqrt(0.05 * 0.95 / kCount) / density);
  EXPECT_EQ(c.tilt.count, 0u);
  const PlaceErrors b = PlaceErrorsOf(biased);
  EXPECT_NEAR(b.tilt.bias, kBias, 4.5 * mean_error);
  EXPECT_NEAR(b.Bias(), kBias, 4.5 * mean_error);
  EXPECT_NEAR(b.u.bias, kBias * tilt.x(), 4.5 * mean_error);
  EXPECT_NEAR(b.tilt.sigma, kSigma, 4.5 * sigma_error);
}

TEST(ErrorStatistics, PercentileIsTheNearestRank) {
  std::vector<double> errors(20);
  std::iota(errors.begin(), errors.end(), 1.0);  // 1 .. 20: 95 % of 20 is the 19th
  errors[3] = -errors[3];
  EXPECT_EQ(ScalarErrorsOf(errors).p95, 19.0);
  EXPECT_EQ(ScalarErrorsOf({}).count, 0u);
  EXPECT_EQ(ScalarErrorsOf({-3.0}).p95, 3.0);
}

TEST(CornerErrors, ATriangleMayBeginAnywhereOthersMayNot) {
  const std::vector<Vec2d> triangle = {{0, 0}, {20, 0}, {5, 20}};
  std::vector<std::optional<Vec2d>> truth(triangle.begin(), triangle.end());
  const Vec2d shift(0.1, -0.2), centre(8, 7);
  for (size_t first = 0; first < 3; ++first) {
    std::vector<Vec2d> detected;
    for (size_t i = 0; i < 3; ++i) detected.push_back(triangle[(i + first) % 3] + shift);
    const std::vector<PlaceError> errors = CornerErrors(detected, truth, centre, std::nullopt);
    ASSERT_EQ(errors.size(), 3u);
    for (const PlaceError& error : errors) EXPECT_LT((error.error - shift).norm(), 1e-12);
  }
  truth.emplace_back(Vec2d(-5, 10));
  EXPECT_TRUE(CornerErrors(triangle, truth, centre, std::nullopt).empty());
  const std::vector<Vec2d> turned = {{20, 0}, {5, 20}, {-5, 10}, {0, 0}};
  EXPECT_GT(CornerErrors(turned, truth, centre, std::nullopt)[0].error.norm(), 10.0);
}

// A corner that nothing is known of has no error; a marker that came out too large by 0.3 px all
// around errs outwards, whatever its mean error.
TEST(CornerErrors, OutwardsIsAwayFromTheCentre) {
  const Vec2d centre(50, 50);
  std::vector<Vec2d> detected;
  std::vector<std::optional<Vec2d>> truth;
  for (const Vec2d& corner : SquareAt(centre, 10.0)) {
    truth.emplace_back(corner);
    detected.push_back(corner + 0.3 * (corner - centre).normalized());
  }
  truth[2].reset();
  const PlaceErrors errors = PlaceErrorsOf(CornerErrors(detected, truth, centre, std::nullopt));
  EXPECT_EQ(errors.Count(), 3u);
  EXPECT_NEAR(errors.outward.bias, 0.3, 1e-12);
  EXPECT_NEAR(errors.outward.sigma, 0.0, 1e-12);
}

// --- a dataset made by hand ---

constexpr int kWidth = 200, kHeight = 150;
constexpr double kTilt_deg = 40.0;

// A marker whose normal leans to the picture's right, on the optical axis' height.
MarkerLabel LabelAt(uint32_t instance, int number, int x, int y, double visible) {
  MarkerLabel label;
  label.instance = instance;
  label.name = fmt::format("marker-{}", instance);
  label.number = number;
  MaskPlane mask(kWidth, kHeight, 0);
  for (int v = y - 8; v <= y + 8; ++v) {
    for (int u = x - 8; u <= x + 8; ++u) mask(u, v) = 1;
  }
  label.visible = label.amodal = EncodeRuns(mask);
  const Vec2d centre(x, y);
  label.centroid_projected_px = label.centroid_outline_px = centre;
  label.centroid_radiometric_px = centre + Vec2d(0.25, 0.0);
  for (const Vec2d& corner : SquareAt(centre, 8.5))
    label.corners.push_back({Vec3d::Zero(), corner, KeypointVisibility::kVisible});
  label.visible_fraction = visible;
  label.incidence_deg = kTilt_deg;
  label.distance_mm = 1500.0;
  label.in_frame = true;
  label.size_px = 24.0;
  label.snr = 30.0;
  const double turn = RadFromDeg(kTilt_deg);
  label.camera_from_marker.rotation =  // z towards the camera, leaning to +x
      (Mat3d() << std::cos(turn), 0, std::sin(turn), 0, -1, 0, std::sin(turn), 0, -std::cos(turn))
          .finished();
  label.camera_from_marker.translation = Vec3d(0, 0, 1500);
  return label;
}

constexpr int kPictures = 40;
constexpr double kHidden = 0.3;

// Four markers a picture: 2 and 5, a standard one, and one that is mostly hidden.
DatasetIndex HandMadeIndex() {
  DatasetIndex index;
  index.header = {{"name", "by hand"}, {"splits", {{"test", {{"pictures", kPictures}}}}}};
  for (int i = 0; i < kPictures; ++i) {
    DatasetScene scene{fmt::format("scene-{:05}", i),
                       i % 4 == 3 ? "train" : "test",
                       {{"material", i % 2 == 0 ? "retro_bead" : "paint"},
                        {"strip", i % 3 == 0},
                        {"wear", 0.01 * i},
                        {"second_ring_deg", i % 5 == 0 ? Json(3.0 + i) : Json()},
                        {"translation_mm", {1.0 * i, 0.0, 2.0}}},
                       {}};
    DatasetPicture picture;
    picture.camera = "camera";
    picture.file = "images/" + scene.name + "_camera.png";
    picture.model =
        CameraModel::FromFieldOfView("camera", kWidth, kHeight, 10.0, 7.5, RigidTransform());
    picture.markers = {LabelAt(1, 2, 40, 40, 1.0), LabelAt(2, 5, 100, 40, 1.0),
                       LabelAt(3, 0, 160, 40, 0.8), LabelAt(4, 3, 100, 110, kHidden)};
    scene.pictures.push_back(picture);
    index.scenes.push_back(scene);
  }
  return index;
}

// Detections beside the truth by known errors: marker 2 always found; 5 found or, in every third
// picture, a pattern without a name; the standard one named 4 in every fifth; the hidden one
// always named 3; in every seventh picture a name where nothing is.
std::vector<std::vector<Detection>> HandMadeDetections(const Evaluation& evaluation,
                                                       const Vec2d& bias, double sigma_px) {
  Normals normals(5);
  std::vector<std::vector<Detection>> all;
  for (size_t i = 0; i < evaluation.pictures.size(); ++i) {
    std::vector<Detection> detections;
    for (const MarkerLabel& label : evaluation.pictures[i].picture->markers) {
      const Vec2d noise(sigma_px * normals.Next(), sigma_px * normals.Next());
      Detection detection =
          Named(label.number, *label.centroid_radiometric_px + bias + noise, 0.97);
      for (const MarkerKeypoint& corner : label.corners)
        detection.corners_px.push_back(*corner.px + bias);
      if (label.number == 5 && i % 3 == 0) detection.marker.reset();
      if (label.number == 0 && i % 5 == 0) detection.marker = 4;
      detections.push_back(detection);
    }
    if (i % 7 == 0) detections.push_back(Named(6, {20, 120}));
    all.push_back(detections);
  }
  return all;
}

struct HandMade {
  DatasetIndex index = HandMadeIndex();
  Evaluation evaluation;
  explicit HandMade(const Vec2d& bias = Vec2d(0.02, -0.01), double sigma_px = 0.05) {
    evaluation = PrepareEvaluation(index, "test", EvaluationLimits());
    evaluation.methods.push_back(
        ScoreMethod(evaluation, "robust", HandMadeDetections(evaluation, bias, sigma_px)));
  }
};

TEST(Evaluation, CountsAsByHand) {
  const HandMade made;
  const Evaluation& evaluation = made.evaluation;
  ASSERT_EQ(evaluation.pictures.size(), 30u);  // 10 of the 40 are of the other split
  const Scores scores = ScoresOf(evaluation, evaluation.methods[0], Everything(evaluation));
  EXPECT_EQ(scores.markers, 90);         // three that count in each
  EXPECT_EQ(scores.found, 90 - 10 - 6);  // every third 5, every fifth standard one
  EXPECT_EQ(scores.misnamed, 6);
  EXPECT_EQ(scores.false_positives, 5);  // pictures 0, 7, .. 28
  EXPECT_EQ(scores.unnamed, 10);
  EXPECT_EQ(scores.ignored, 30);
  EXPECT_EQ(scores.Named(), 85);
  const double precision = 74.0 / 85.0, recall = 74.0 / 90.0;
  EXPECT_DOUBLE_EQ(*scores.F1(), 2.0 * precision * recall / (precision + recall));
}

TEST(Evaluation, ConfusionHoldsEveryNameAndEveryMiss) {
  const HandMade made;
  const Confusion confusion = ConfusionOf(made.evaluation, made.evaluation.methods[0]);
  EXPECT_THAT(confusion.truth, ElementsAre("1", "2", "3", "4", "5", "6", "standard", "nothing"));
  EXPECT_THAT(confusion.named,
              ElementsAre("1", "2", "3", "4", "5", "6", "standard", "unnamed", "none"));
  EXPECT_EQ(confusion.counts[1][1], 30);  // 2 is 2
  EXPECT_EQ(confusion.counts[4][4], 20);
  EXPECT_EQ(confusion.counts[4][7], 10);  // 5 without a name
  EXPECT_EQ(confusion.counts[6][6], 24);
  EXPECT_EQ(confusion.counts[6][3], 6);  // standard named 4
  EXPECT_EQ(confusion.counts[7][5], 5);  // nothing named 6
  int64_t sum = 0;
  for (const auto& row : confusion.counts) sum = std::accumulate(row.begin(), row.end(), sum);
  EXPECT_EQ(sum, 30 + 30 + 30 + 5);  // right names on the hidden one are left out
}

// 74 found: bias within 4.5 standard errors; along the tilt, which is the picture's +x here, too.
// The outline's centroid lies 0.25 px beside the radiometric one.
TEST(Evaluation, ErrorsAreAgainstTheCentroidsThatTheyShouldBe) {
  constexpr double kSigma = 0.05;
  const Vec2d bias(0.02, -0.01);
  const HandMade made(bias, kSigma);
  const Evaluation& evaluation = made.evaluation;
  const Scores scores = ScoresOf(evaluation, evaluation.methods[0], Everything(evaluation));
  const double limit = 4.5 * kSigma / std::sqrt(74.0);
  EXPECT_EQ(scores.centroid.Count(), 74u);
  EXPECT_NEAR(scores.centroid.u.bias, bias.x(), limit);
  EXPECT_NEAR(scores.centroid.v.bias, bias.y(), limit);
  EXPECT_NEAR(scores.centroid.tilt.bias, scores.centroid.u.bias, 1e-9);
  EXPECT_NEAR(scores.outline.u.bias - scores.centroid.u.bias, 0.25, 1e-9);
  EXPECT_EQ(scores.corners.Count(), 4u * 74u);
  EXPECT_NEAR(scores.corners.u.bias, bias.x(), 1e-9);
  EXPECT_NEAR(scores.corners.u.sigma, 0.0, 1e-9);
}

TEST(Evaluation, ADarkMarkerIsMeasuredAgainstItsOutline) {
  HandMade made;
  for (DatasetScene& scene : made.index.scenes) {
    for (MarkerLabel& label : scene.pictures[0].markers) label.dark = true;
  }
  const Evaluation& evaluation = made.evaluation;
  const MethodResult result =
      ScoreMethod(evaluation, "robust", HandMadeDetections(evaluation, Vec2d::Zero(), 0.0));
  const Scores scores = ScoresOf(evaluation, result, Everything(evaluation));
  EXPECT_NEAR(scores.centroid.u.bias, 0.25, 1e-9);
}

// Each variable cuts the markers into parts: nothing is lost, nothing counted twice.
TEST(Evaluation, GroupsAddUpToTheWhole) {
  const HandMade made;
  const Evaluation& evaluation = made.evaluation;
  const MethodResult& method = evaluation.methods[0];
  const Scores all = ScoresOf(evaluation, method, Everything(evaluation));
  std::vector<std::string> names;
  for (const EvaluationVariable& variable : EvaluationVariables(evaluation)) {
    names.push_back(variable.name);
    Scores sum;
    for (const EvaluationGroup& group : variable.groups) {
      const Scores scores = ScoresOf(evaluation, method, group.choice);
      EXPECT_GT(group.choice.markers.size(), 0u);
      sum.markers += scores.markers;
      sum.found += scores.found;
      sum.misnamed += scores.misnamed;
      sum.pictures += scores.pictures;
      sum.false_positives += scores.false_positives;
    }
    const int64_t hidden = variable.name == "visible_fraction" ? 30 : 0;  // they count there
    EXPECT_EQ(sum.markers, all.markers + hidden) << variable.name;
    EXPECT_EQ(sum.found, all.found + hidden) << variable.name;
    EXPECT_EQ(sum.misnamed, all.misnamed) << variable.name;
    if (!variable.name.starts_with("scene.")) continue;
    EXPECT_EQ(sum.pictures, all.pictures) << variable.name;
    EXPECT_EQ(sum.false_positives, all.false_positives) << variable.name;
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"incidence_deg", "distance_mm", "size_px", "snr",
                                              "visible_fraction", "frame_position", "marker",
                                              "polarity", "scene.material", "scene.strip",
                                              "scene.wear", "scene.translation_mm x"}));
}

TEST(Evaluation, NumbersOfANuisanceAreCutIntoPartsNullAndZeroApart) {
  const HandMade made;
  for (const EvaluationVariable& variable : EvaluationVariables(made.evaluation)) {
    std::vector<std::string> labels;
    for (const EvaluationGroup& group : variable.groups) labels.push_back(group.Label());
    if (variable.name == "scene.strip") {
      EXPECT_THAT(labels, ElementsAre("no", "yes"));
    } else if (variable.name == "scene.wear") {
      ASSERT_EQ(labels.size(), 6u);  // 0, and five parts of the other 29
      EXPECT_EQ(labels[0], "0");
      for (size_t i = 1; i < 6; ++i) {
        EXPECT_GE(variable.groups[i].choice.pictures.size(), 5u) << labels[i];
        EXPECT_LE(variable.groups[i].choice.pictures.size(), 7u) << labels[i];
      }
    } else if (variable.name == "scene.second_ring_deg") {
      EXPECT_EQ(labels.front(), "none");
    }
  }
}

TEST(Evaluation, TargetsByName) {
  const HandMade made;
  const auto targets = TargetsOf(made.evaluation, made.evaluation.methods[0]);
  const auto find = [&](const std::string& measure, const std::string& markers) {
    for (const EvaluationTarget& target : targets) {
      if (target.measure == measure && target.markers == markers) return target;
    }
    ADD_FAILURE() << measure << ", " << markers;
    return EvaluationTarget{};
  };
  // The standard one is visible to 80 % only.
  const EvaluationTarget found = find("found", "whole, 20 px, below 60 deg: bright, identifiable");
  EXPECT_EQ(found.share->count, 50);
  EXPECT_EQ(found.share->of, 60);
  EXPECT_FALSE(found.met);
  EXPECT_EQ(find("misnamed", "all").share->count, 6);
  EXPECT_EQ(find("wrong names", "all").share->count, 11);
  const EvaluationTarget rms = find("centroid rms", "bright, standard");
  EXPECT_NEAR(*rms.value, std::sqrt(2.0) * 0.05, 0.03);
}

TEST(Evaluation, MethodsArePairedOnTheSameMarkers) {
  HandMade made;
  Evaluation& evaluation = made.evaluation;
  auto detections = HandMadeDetections(evaluation, Vec2d::Zero(), 0.0);
  for (auto& picture : detections) {
    picture[0].marker.reset();  // never finds marker 2,
    picture[1].marker = 5;      // always 5
  }
  evaluation.methods.push_back(ScoreMethod(evaluation, "edges", detections));
  const std::vector<PairedResult> results = PairedResults(evaluation);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].first, "robust");
  EXPECT_EQ(results[0].second, "edges");
  EXPECT_EQ(results[0].both, 20 + 24);
  EXPECT_EQ(results[0].first_only, 30);
  EXPECT_EQ(results[0].second_only, 10);
  EXPECT_EQ(results[0].neither, 6);
  EXPECT_EQ(results[0].P(), McNemarExactP(30, 10));
  EXPECT_EQ(results[1].both + results[1].first_only + results[1].second_only + results[1].neither,
            60);  // whole ones
}

TEST(Evaluation, ReadBackFromAFileTheSameToTheLastBit) {
  HandMade made;
  Evaluation& evaluation = made.evaluation;
  std::vector<PictureDetections> pictures;
  for (size_t i = evaluation.pictures.size(); i-- > 0;) {  // in any order
    pictures.push_back({"elsewhere/" + evaluation.pictures[i].picture->file.substr(7), "camera",
                        evaluation.methods[0].detections[i]});
  }
  const std::filesystem::path file = OwnFolder() / "detections.json";
  WriteDetections(file, "robust", pictures);
  const DetectionsFile read = ReadDetections(file, DefaultMarkerSet());
  EXPECT_EQ(read.method, "robust");
  Evaluation again = PrepareEvaluation(made.index, "test", EvaluationLimits());
  again.methods.push_back(
      ScoreMethod(again, read.method, DetectionsOfPictures(again, made.index, file, read)));
  EXPECT_EQ(EvaluationJson(again, made.index, EvaluationVariables(again)).dump(),
            EvaluationJson(evaluation, made.index, EvaluationVariables(evaluation)).dump());
}

TEST(Evaluation, TheSameOnAnyNumberOfThreads) {
  std::vector<std::string> texts;
  for (const int threads : {1, 2}) {
    const LimitThreads limit(threads);
    const HandMade made;
    texts.push_back(
        EvaluationJson(made.evaluation, made.index, EvaluationVariables(made.evaluation)).dump());
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(Evaluation, APictureThatIsNotTheLabelledOneIsRefused) {
  DatasetIndex index = HandMadeIndex();
  index.scenes.resize(1);
  DatasetPicture& picture = index.scenes[0].pictures[0];
  const std::filesystem::path folder = OwnFolder() / "dataset";
  std::filesystem::create_directories(folder / "images");
  WritePng(folder / picture.file, {Plane<uint16_t>(kWidth, kHeight, 7), 8});
  const Evaluation evaluation = PrepareEvaluation(index, "test", EvaluationLimits());
  const auto check = [&] { CheckPictures(evaluation, folder); };
  EXPECT_THAT(MessageOf(check), HasSubstr("another picture than the one that was labelled"));
  picture.hash = HexHash(HashBytes(ReadTextFile(folder / picture.file)));
  EXPECT_EQ(MessageOf(check), "no error");
  std::filesystem::remove(folder / picture.file);
  EXPECT_THAT(MessageOf(check), HasSubstr(picture.file));
}

TEST(Evaluation, AMethodSeesThePictureWithItsNumberOfBits) {
  DatasetIndex index = HandMadeIndex();
  index.scenes.resize(1);
  DatasetPicture& picture = index.scenes[0].pictures[0];
  picture.bits = 12;
  const std::filesystem::path folder = OwnFolder() / "bits";
  std::filesystem::create_directories(folder / "images");
  WritePng(folder / picture.file, {Plane<uint16_t>(kWidth, kHeight, 3000), 12});
  const Method method = [](const DigitalImage& image, const MarkerSet&,
                           const std::filesystem::path*) {
    return std::vector<Detection>{Named(std::nullopt, Vec2d(image.dn(3, 3), image.bits))};
  };
  IdentificationTimes times;
  const auto detections = IdentifyPictures(PrepareEvaluation(index, "test", EvaluationLimits()),
                                           folder, method, DefaultMarkerSet(), NoProgress(), times);
  EXPECT_EQ(detections.at(0).at(0).centroid_px, Vec2d(3000, 12));
  EXPECT_GT(times.identify_s, 0.0);
}

// Run lengths go on from the foot of a column to the head of the next.
TEST(Evaluation, TheHullHoldsEveryPixelOfTheMask) {
  DatasetIndex index = HandMadeIndex();
  index.scenes.resize(1);
  std::vector<MarkerLabel>& labels = index.scenes[0].pictures[0].markers;
  labels.resize(1);
  MaskPlane mask(kWidth, kHeight, 0);
  for (int x = 30; x <= 32; ++x) {
    for (int y = 0; y < kHeight; ++y) mask(x, y) = 1;
  }
  mask(40, 70) = 1;
  labels[0].amodal = EncodeRuns(mask);
  const Evaluation evaluation = PrepareEvaluation(index, "test", EvaluationLimits());
  EXPECT_THAT(evaluation.markers.at(0).shape.hull_px,
              ::testing::UnorderedElementsAre(Vec2d(30, 0), Vec2d(32, 0), Vec2d(40, 70),
                                              Vec2d(32, kHeight - 1), Vec2d(30, kHeight - 1)));
}

TEST(Evaluation, ASplitWithoutPicturesIsRefused) {
  const DatasetIndex index = HandMadeIndex();
  EXPECT_THAT(MessageOf([&] { PrepareEvaluation(index, "val", EvaluationLimits()); }),
              HasSubstr("--split val: no pictures"));
  EXPECT_EQ(PrepareEvaluation(index, "all", EvaluationLimits()).pictures.size(), 40u);
}

// --- files of other detectors ---

std::string ReadingOf(const std::string& text) {
  const std::filesystem::path file = OwnFolder() / "foreign.json";
  WriteTextFile(file, text);
  return MessageOf([&] { ReadDetections(file, DefaultMarkerSet()); });
}

TEST(DetectionsFile, SaysWhereItIsWrong) {
  const auto with = [](const std::string& images) {
    return R"({"schema": "retrolux/detections-1", "pixel_origin": "center", "images": )" + images +
           "}";
  };
  const auto detection = [&](const std::string& text) {
    return with(R"([{"file": "a.png", "detections": [)" + text + "]}]");
  };
  EXPECT_EQ(ReadingOf(detection(R"({"marker": 3, "centroid_px": [1, 2]})")), "no error");
  EXPECT_THAT(ReadingOf(R"({"schema": "retrolux/detections-1", "images": []})"),
              HasSubstr("pixel_origin"));
  EXPECT_THAT(ReadingOf(R"({"schema": "retrolux/detections-1", "pixel_origin": "corner"})"),
              HasSubstr("center"));
  EXPECT_THAT(ReadingOf(with("{}")), HasSubstr("/images: found"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 99, "centroid_px": [1, 2]})")),
              HasSubstr("/images/0/detections/0/marker: found 99; expected 1, 2, 3, 4, 5, 6"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 0, "centroid_px": [1, 2]})")),
              HasSubstr("/images/0/detections/0/marker"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 1, "centroid_px": [1]})")),
              HasSubstr("/images/0/detections/0/centroid_px"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 1})")),
              HasSubstr("/images/0/detections/0: found no key 'centroid_px'"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 1, "centroid_px": [1, 2], "confidence": 2})")),
              HasSubstr("/images/0/detections/0/confidence"));
  EXPECT_THAT(ReadingOf(detection(R"({"marker": 1, "centroid_px": [1, 2], "centre": 2})")),
              HasSubstr("unknown key 'centre'"));
}

TEST(DetectionsFile, HasEachPictureOfTheSplitOnceAndNoOthers) {
  const DatasetIndex index = HandMadeIndex();
  const Evaluation evaluation = PrepareEvaluation(index, "test", EvaluationLimits());
  DetectionsFile file;
  for (const DatasetScene& scene : index.scenes)  // those of other splits may be there
    file.pictures.push_back({scene.pictures[0].file, "camera", {}});
  const auto message = [&] {
    return MessageOf([&] { DetectionsOfPictures(evaluation, index, "found.json", file); });
  };
  EXPECT_EQ(message(), "no error");
  file.pictures.push_back(file.pictures.front());
  EXPECT_THAT(message(), HasSubstr("/images/40/file: 'scene-00000_camera.png' a second"));
  file.pictures.back().file = "other.png";
  EXPECT_THAT(message(), HasSubstr("'other.png'; expected a picture of the dataset"));
  file.pictures.pop_back();
  file.pictures.erase(file.pictures.begin() + 1);
  EXPECT_THAT(message(), HasSubstr("1 of the 30 pictures are missing, the first "
                                   "images/scene-00001_camera.png"));
}

}  // namespace
}  // namespace retrolux
