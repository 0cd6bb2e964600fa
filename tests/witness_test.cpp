// The detectors of others on our pictures: AprilTag's library and OpenCV's aruco find retro-
// reflective tags that we render, and tell where their corners are. What they share with us is the
// pattern alone. Their own biases are those that they have on drawn pictures
// (tests/drawn_markers.h), which nothing of the renderer is in. Figures: docs/witness.md.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "classifier/method.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "core/tag_shape.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"
#include "tests/statistics.h"
#include "tests/witness_views.h"

namespace retrolux {
namespace {

// All z-tests of this file together fail with this probability if nothing is wrong.
constexpr double kSignificance = 1e-3;
constexpr int kTests = 2 * (4 + 2);

void ExpectAgree(const ScalarErrors& a, const ScalarErrors& b, const char* what) {
  const double z = (a.bias - b.bias) / std::hypot(a.StandardError(), b.StandardError());
  EXPECT_GT(statistics::NormalPValue(z), statistics::Sidak(kSignificance, kTests))
      << what << ": " << a.bias << " +- " << a.StandardError() << " against " << b.bias << " +- "
      << b.StandardError();
}

template <typename Make>
std::vector<TagPicture> Pictures(const std::vector<TagView>& views, Make make) {
  std::vector<TagPicture> pictures(views.size());
  ParallelFor(static_cast<int64_t>(views.size()), [&](int64_t i) {
    const auto k = static_cast<size_t>(i);
    pictures[k] = make(views[k]);
  });
  return pictures;
}

// ---- patterns ----

TEST(TagShape, IsDarkInItsDarkCells) {
  constexpr int kCells = 8;
  constexpr double kSide_mm = 24.0;
  KeyedRng rng(7);
  for (int trial = 0; trial < 50; ++trial) {
    Plane<uint8_t> bright(kCells, kCells);
    for (uint8_t& cell : bright.data) cell = rng.NextDouble() < 0.5;
    const MarkerShape shape = TagShape(3, "tag", bright, kSide_mm);
    EXPECT_GT(SignedArea(shape.outline_mm), 0.0);
    EXPECT_EQ(shape.straight_edges, 4);
    for (int i = 0; i < 20 * kCells * kCells; ++i) {
      const Vec2d at(rng.NextDouble(), rng.NextDouble());  // of the side, from the upper left
      const auto column = static_cast<int>(at.x() * kCells);
      const auto row = static_cast<int>(at.y() * kCells);
      const Vec2d in_marker = kSide_mm * Vec2d(at.x() - 0.5, 0.5 - at.y());
      ASSERT_EQ(shape.Contains(in_marker), bright(column, row) != 0);
    }
  }
}

TEST(TagShape, FewHolesDoForLargeAreas) {
  Plane<uint8_t> frame(6, 6, 1);
  for (int i = 1; i < 5; ++i) frame(i, 1) = frame(i, 4) = frame(1, i) = frame(4, i) = 0;
  EXPECT_EQ(TagShape(1, "frame", frame, 6.0).holes_mm.size(), 4u);
  EXPECT_EQ(TagShape(1, "dark", Plane<uint8_t>(6, 6), 6.0).holes_mm.size(), 1u);
  EXPECT_TRUE(TagShape(1, "bright", Plane<uint8_t>(6, 6, 1), 6.0).holes_mm.empty());
}

// ---- families ----

struct Case {
  const char* family;
  double max_incidence_deg;  // to which its detector finds 99 % of tags with cells of 4 px
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.family;
}

class Witnessing : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    family_ = FindTagFamily(GetParam().family);
    if (family_ == nullptr) {
      GTEST_SKIP() << "built without the library of " << GetParam().family
                   << " (Debian: libapriltag-dev; libopencv-contrib-dev)";
    }
  }
  // Cells of 4 px, before foreshortening.
  TagView View(double incidence_deg) const {
    TagView view;
    view.family = family_;
    view.incidence_deg = incidence_deg;
    view.distance_mm *= view.FrontalCell_px() / 4.0;
    return view;
  }
  const TagFinder& Finder() const { return family_->finders.front(); }

  const TagFamily* family_ = nullptr;
};

TEST_P(Witnessing, SetsAreWrittenAndReadBack) {
  const MarkerSet set = MakeTagSet(*family_, {1, 9, 49}, 25.1);
  const auto file = OwnFolder() / "tags.json";
  WriteTextFile(file, ToJson(set).dump());
  const MarkerSet read = ReadMarkerSet(file);
  EXPECT_EQ(ToJson(read), ToJson(set));
  EXPECT_EQ(read.ByNumber(9).name, family_->name + "-9");
  EXPECT_NE(MessageOf([&] { MakeTagSet(*family_, {0}, 30.0); }).find("expected ids from 1 to"),
            std::string::npos);
  EXPECT_THROW(MakeTagSet(*family_, {family_->count}, 30.0), InputError);
}

// The half pixel: every finder's coordinates, after our conversion, count from pixel centres. Of
// the mean over 60 drawn tags the confidence interval of 99.99 % must lie
// within a quarter of a pixel of the truth, along both axes: no other multiple of half a pixel is
// as near.
TEST_P(Witnessing, CoordinatesCountFromPixelCentres) {
  TagView like = View(20.0);
  like.distance_mm /= 2.0;
  const std::vector<TagView> views = RandomViews(like, 60, 101);
  const std::vector<TagPicture> pictures =
      Pictures(views, [](const TagView& view) { return DrawTag(view, 140.0, 5.0); });
  for (const TagFinder& finder : family_->finders) {
    const WitnessResult result = Witness(finder, views, pictures);
    EXPECT_EQ(result.found, result.pictures) << finder.name;
    for (const ScalarErrors& axis : {result.u, result.v})
      EXPECT_LT(std::abs(axis.bias) + 3.9 * axis.StandardError(), 0.25) << finder.name;
  }
}

// Rendered tags are found where drawn ones of the same light are: the renderer's geometry, pixel
// origin and sensor add no bias along the picture's axes, away from the tag's middle or along its
// tilt. A standard error is 0.002 to 0.004 px.
TEST_P(Witnessing, RenderedTagsAreWhereDrawnOnesAre) {
  const std::vector<TagView> views = RandomViews(View(25.0), 80, 102);
  const std::vector<TagPicture> rendered = Pictures(views, RenderTag);
  const double contrast_dn = Witness(Finder(), views, rendered).contrast_dn;
  const std::vector<TagPicture> drawn =
      Pictures(views, [&](const TagView& view) { return DrawTag(view, contrast_dn, 5.0); });
  const WitnessResult a = Witness(Finder(), views, rendered);
  const WitnessResult b = Witness(Finder(), views, drawn);
  EXPECT_EQ(a.found, a.pictures);
  EXPECT_EQ(b.found, b.pictures);
  ExpectAgree(a.u, b.u, "u");
  ExpectAgree(a.v, b.v, "v");
  ExpectAgree(a.outward, b.outward, "outward");
  ExpectAgree(a.tilt, b.tilt, "tilt");
}

// In the picture's corner k1 = -0.4 shifts a tag by more than a pixel. The library does not know of
// the lens; that its corners are where Project says as exactly as without distortion is a witness
// for both ray and projection.
TEST_P(Witnessing, DistortedTagsAreWhereTheModelSays) {
  std::vector<TagView> straight = RandomViews(View(20.0), 30, 103);
  for (TagView& view : straight) view.at_px = view.at_px / 16.0 + Vec2d(40.0, 40.0);
  std::vector<TagView> bent = straight;
  for (TagView& view : bent) view.distortion_k1 = -0.4;
  const WitnessResult a = Witness(Finder(), straight, Pictures(straight, RenderTag));
  const WitnessResult b = Witness(Finder(), bent, Pictures(bent, RenderTag));
  ExpectAgree(a.u, b.u, "u");
  ExpectAgree(a.v, b.v, "v");
  EXPECT_LT(20.0 * b.u.StandardError(), 0.4 * 280.0 * std::pow(340.0 / 3000.0, 2.0))
      << "the test would not see the distortion";
}

// A tag on the oval bends away from its tangent plane by kappa r^2 / 2, which moves its places
// against the way of the tilt. An edge of length 2 h is a bow, and the straight line that a
// detector fits to it lies the mean of kappa (h^2 - x^2) / 2 = kappa h^2 / 3 nearer to the viewer
// than its ends, which are the true corners on the surface. The found corners thus lie kappa h^2 /
// 3 sin(incidence) px per mm along the tilt; kappa, averaged over rolls, is the mean of the two
// principal curvatures a / b^2 and a / c^2. 10 % for what is of higher order. A truth on the
// tangent plane would be off by twice as much, to the other side.
TEST_P(Witnessing, BentTagsAreAsFarOffAsTheirEdgesBow) {
  constexpr double kA_mm = 100.0, kC_mm = 140.0, kIncidence_deg = 40.0;
  TagView like = View(kIncidence_deg);
  like.ground = TagGround::kOval;
  const std::vector<TagView> views = RandomViews(like, 40, 104);
  const WitnessResult result = Witness(Finder(), views, Pictures(views, RenderTag));
  ASSERT_GE(result.found, 30);
  const double kappa = 0.5 * (1.0 / kA_mm + kA_mm / (kC_mm * kC_mm));
  const double h = DarkSquare(*family_, like.size_mm)[2].x();
  const double px_per_mm = like.FrontalCell_px() * family_->cells / like.size_mm;
  const double expected = kappa * h * h / 3.0 * std::sin(RadFromDeg(kIncidence_deg)) * px_per_mm;
  EXPECT_NEAR(result.tilt.bias, expected, 0.1 * expected + 3.9 * result.tilt.StandardError());
}

// Tags are found by their right ids: were 99 % of all such tags found, more than 4 of 60 would be
// missed with a probability of 0.04 %. And our own method calls none of them one of its six markers
// (of a share of 5 % it would meet one in 95 % of such sets of 60).
TEST_P(Witnessing, FindsObliqueTagsAndRobustNamesNone) {
  std::vector<TagView> views = RandomViews(View(0.0), 60, 105);
  for (size_t i = 0; i < views.size(); ++i)
    views[i].incidence_deg =
        GetParam().max_incidence_deg * static_cast<double>(i) / static_cast<double>(views.size());
  const std::vector<TagPicture> pictures = Pictures(views, RenderTag);
  const WitnessResult result = Witness(Finder(), views, pictures);
  EXPECT_GE(result.found, result.pictures - 4);
  EXPECT_EQ(result.wrong, 0);
  const Method robust = MethodByName("robust");
  int named = 0;
  for (const TagPicture& picture : pictures) {
    for (const Detection& d : robust(picture.image, DefaultMarkerSet(), nullptr))
      named += d.marker.has_value();
  }
  EXPECT_EQ(named, 0);
}

// The method of `classify`: the whole square's corners follow from those of the dark one.
TEST_P(Witnessing, MethodNamesTagsOfItsSet) {
  TagView view = View(30.0);
  view.id = 5;
  const TagPicture picture = DrawTag(view, 150.0, 5.0);
  const MarkerSet set = MakeTagSet(*family_, {4, 5}, view.size_mm);
  const Method method = MethodByName(family_->name);
  const std::vector<Detection> found = method(picture.image, set, nullptr);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].marker, 5);
  EXPECT_LT((*found[0].centre_px - picture.middle_px).norm(), 0.3);
  EXPECT_LT((Centroid(found[0].corners_px) - found[0].centroid_px).norm(), 1e-9);
  for (size_t k = 0; k < 4; ++k) {
    const Vec2d outward = picture.corners_px[k] - picture.middle_px;
    const Vec2d corner = picture.middle_px + outward * family_->cells / (family_->cells - 2.0);
    EXPECT_LT((found[0].corners_px[k] - corner).norm(), 0.6);
  }
  const MarkerSet others = MakeTagSet(*family_, {4}, view.size_mm);
  EXPECT_EQ(method(picture.image, others, nullptr).at(0).marker, std::nullopt);
  EXPECT_NE(MessageOf([&] {
              method(picture.image, DefaultMarkerSet(), nullptr);
            }).find("no tag of " + family_->name),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Families, Witnessing,
                         testing::Values(Case{"apriltag36h11", 60.0}, Case{"aruco4x4", 45.0}),
                         [](const auto& tested) { return std::string(tested.param.family); });

}  // namespace
}  // namespace retrolux
