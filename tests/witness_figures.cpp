// The tables of docs/witness.md on stdout: witness_figures
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "classifier/method.h"
#include "core/parallel.h"
#include "tests/witness_views.h"

namespace {

using namespace retrolux;

template <typename Make>
std::vector<TagPicture> Pictures(const std::vector<TagView>& views, Make make) {
  std::vector<TagPicture> pictures(views.size());
  ParallelFor(static_cast<int64_t>(views.size()), [&](int64_t i) {
    pictures[static_cast<size_t>(i)] = make(views[static_cast<size_t>(i)]);
  });
  return pictures;
}

constexpr int kViews = 30;

// What our own methods make of the same pictures.
struct OwnNames {
  int pictures = 0;
  std::map<std::string, std::map<int, int>> names;  // by method and number

  void Count(const std::vector<TagPicture>& seen) {
    pictures += static_cast<int>(seen.size());
    for (const char* method : {"edges", "robust"}) {
      for (const TagPicture& picture : seen) {
        for (const Detection& d :
             MethodByName(method)(picture.image, DefaultMarkerSet(), nullptr)) {
          if (d.marker) ++names[method][*d.marker];
        }
      }
    }
  }
  void Print() const {
    fmt::print("\nOur methods on {} pictures:", pictures);
    for (const auto& [method, numbers] : names) {
      for (const auto& [number, count] : numbers)
        fmt::print(" {} says {} {} times;", method, number, count);
    }
    fmt::print("\n");
  }
};

void PrintHead(const std::string& what) {
  fmt::print(
      "\n| {} | found | wrong | contrast DN | SNR | bias u | bias v | +- | outward | +- | tilt | "
      "sigma | p95 |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      what);
}

void PrintRow(const std::string& what, const WitnessResult& r) {
  fmt::print(
      "| {} | {}/{} | {} | {:.0f} | {:.0f} | {:+.3f} | {:+.3f} | {:.3f} | {:+.3f} | {:.3f} | "
      "{:+.3f} | {:.3f} | {:.3f} |\n",
      what, r.found, r.pictures, r.wrong, r.contrast_dn, r.snr, r.u.bias, r.v.bias,
      Vec2d(r.u.StandardError(), r.v.StandardError()).norm() / std::sqrt(2.0), r.outward.bias,
      r.outward.StandardError(), r.corners.tilt.bias,
      std::sqrt(0.5 * (std::pow(r.corners.u.sigma, 2) + std::pow(r.corners.v.sigma, 2))),
      r.corners.p95);
  std::fflush(stdout);
}

// A row of rendered pictures for the method's finder.
void Measure(const std::string& what, const TagView& like, OwnNames& own) {
  const std::vector<TagView> views = RandomViews(like, kViews, 1);
  const std::vector<TagPicture> pictures = Pictures(views, RenderTag);
  PrintRow(what, Witness(like.family->finders.front(), views, pictures));
  own.Count(pictures);
}

void MeasureConventions(const TagView& like) {
  const std::vector<TagView> views = RandomViews(like, 60, 2);
  const std::vector<TagPicture> rendered = Pictures(views, RenderTag);
  const double contrast_dn = rendered.front().contrast_dn;
  const std::vector<TagPicture> drawn =
      Pictures(views, [&](const TagView& view) { return DrawTag(view, contrast_dn, 5.0); });
  PrintHead("finder");
  for (const TagFinder& finder : like.family->finders) {
    PrintRow("drawn; " + finder.name, Witness(finder, views, drawn));
    PrintRow("rendered; " + finder.name, Witness(finder, views, rendered));
  }
}

void MeasureSizes(TagView like) {
  for (const double cell_px : {1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 9.0}) {
    like.distance_mm *= like.FrontalCell_px() / cell_px;
    const std::vector<TagView> views = RandomViews(like, kViews, 3);
    const std::vector<TagPicture> pictures = Pictures(views, RenderTag);
    PrintHead(fmt::format("{:g} px a cell", cell_px));
    for (const TagFinder& finder : like.family->finders)
      PrintRow(finder.name, Witness(finder, views, pictures));
  }
}

void MeasureIncidence(const TagView& like, OwnNames& own) {
  struct Case {
    TagGround ground;
    const char* sheeting;
  };
  for (const Case& c :
       {Case{TagGround::kPanel, "retro_bead_wide"}, Case{TagGround::kPanel, "retro_bead"},
        Case{TagGround::kPanel, "retro_prismatic"}, Case{TagGround::kOval, "retro_bead_wide"}}) {
    PrintHead(fmt::format("{}, {}", c.ground == TagGround::kOval ? "oval" : "panel", c.sheeting));
    for (const double incidence : {0.0, 30.0, 45.0, 60.0, 70.0}) {
      TagView view = like;
      view.ground = c.ground;
      view.sheeting = c.sheeting;
      view.incidence_deg = incidence;
      Measure(fmt::format("{:g}", incidence), view, own);
    }
  }
}

void MeasureLight(const TagView& like, OwnNames& own) {
  PrintHead("full scales");
  for (const double full_scales : {0.03, 0.05, 0.1, 0.3, 0.7, 2.0, 4.0}) {
    TagView view = like;
    view.full_scales = full_scales;
    Measure(fmt::format("{:g}", full_scales), view, own);
    if (full_scales < 2.0) continue;
    view.blooming = true;
    Measure(fmt::format("{:g}, blooming", full_scales), view, own);
  }
  PrintHead("blur, px");
  for (const double blur_px : {1.0, 2.0, 3.0, 4.0, 6.0}) {
    TagView view = like;
    view.blur_px = blur_px;
    Measure(fmt::format("{:g}", blur_px), view, own);
  }
}

}  // namespace

int main() {
  for (const TagFamily& family : TagFamilies()) {
    fmt::print("\n## {}\n", family.name);
    TagView like;
    like.family = &family;
    like.incidence_deg = 20.0;
    like.distance_mm *= like.FrontalCell_px() / 4.0;
    OwnNames own;
    MeasureConventions(like);
    MeasureSizes(like);
    MeasureIncidence(like, own);
    MeasureLight(like, own);
    own.Print();
  }
}
