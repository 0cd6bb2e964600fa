#include "classifier/judge.h"

#include <algorithm>
#include <cmath>

#include "classifier/dark_frame.h"
#include "classifier/ground_step.h"

namespace retrolux {

namespace {

// Steps of a rival's fit before it is left: by then a right one is far ahead of a wrong one.
constexpr int kRivalSteps = 4;
// What the model of a marker leaves out, of its contrast: the shape of the blur, third degrees.
constexpr double kModelNoise = 0.01;
// How far the outline of a marker may be from the best proposal at least, px.
constexpr double kLikely_px = 0.2;
// Blur takes no more than this off the tip of a corner.
constexpr double kTip_px = 12.0;
// If this many fits leave more than kPoor standard deviations of the noise, no other will do.
constexpr size_t kFirstFits = 3;
constexpr double kPoor = 4.0;
// A fit that leaves no more than this, in standard deviations of the noise, is good.
constexpr double kGood = 1.6;
// Chi-square of a bend, and a saddle, that need no other turn of the same marker to explain them.
constexpr double kLittleBend = 6.0, kLittleSaddle = 0.005;
// A rival that leaves mean squares larger by this factor is given up, or chi-square larger by this:
// a lead of a quarter of it is as good as any (evidence.cpp).
constexpr double kHopeless = 9.0, kHopelessLead = 4000.0;
// A saddle as strong as this counts as one standard deviation.
constexpr double kSaddle = 0.007;
// The blur that a fit begins with, px^2.
constexpr double kFirstBlur_px2 = 0.2;

// Proposals whose outlines differ from the pattern's by more than this are not worth a fit, px.
double LikelyRms(const std::vector<Proposal>& proposals) {
  return 1.4 * proposals.front().rms_px + 0.15;
}

// Corners that may lie outside the pattern's box.
Polygon CornersOf(const std::vector<Proposal>& proposals, const std::vector<ShapeModel>& models,
                  const Polygon& outline) {
  Polygon corners;
  for (const Proposal& proposal : proposals) {
    if (proposal.rms_px > LikelyRms(proposals)) break;
    for (const Vec2d& p : proposal.map.Of(models[proposal.model].corners)) {
      const bool near = std::any_of(outline.begin(), outline.end(), [&](const Vec2d& q) {
        return (p - q).squaredNorm() < kTip_px * kTip_px;
      });
      if (near) corners.push_back(p);
    }
  }
  return corners;
}

// The light half way up and down from the pattern's level.
MarkerFit FirstFit(const Pattern& pattern, bool dark) {
  const double sign = dark ? -1.0 : 1.0;
  const double level = sign * pattern.level.At(Centroid(pattern.outline));
  MarkerFit first;
  first.blur_variance = kFirstBlur_px2;
  first.contrast = sign * pattern.contrast;
  first.light(0) = level - 0.5 * first.contrast;
  first.light(3) = std::log(std::max(level + 0.5 * first.contrast, 1.0));
  return first;
}

double WhiteShare(const Patch& patch) {
  int white = 0;
  int all = 0;
  for (size_t i = 0; i < patch.inside.data.size(); ++i) {
    all += patch.inside.data[i];
    white += patch.inside.data[i] != 0 && patch.dn.data[i] >= patch.white_dn;
  }
  return white / std::max<double>(all, 1.0);
}

double Peak(const Patch& patch, const MarkerFit& fit, const ShapeModel& model,
            const Polygon& outline) {
  const auto log_light = [&](const Vec2d& px) {
    return std::log(MarkerLightAt(fit.light, PlaceInPatch(patch, px)));
  };
  double sum = 0.0;
  for (const Vec2d& p : outline) sum += log_light(p);
  return log_light(fit.map.At(model.mean)) - sum / static_cast<double>(outline.size());
}

double LeastContrast(const Patch& patch, const MarkerFit& fit, const Polygon& outline) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2d& p : outline) {
    const Vec2d place = PlaceInPatch(patch, p);
    const double contrast = MarkerLightAt(fit.light, place) - SurroundingsAt(fit.light, place);
    least = std::min(least, contrast / fit.contrast);
  }
  return least;
}

// Of a patch pixel, DN, with what the model of the marker leaves out.
double NoiseOf(const Patch& patch, double contrast) {
  return std::hypot(patch.noise, kModelNoise * contrast / patch.scale);
}

}  // namespace

JudgedPattern Judge::Decide(const Pattern& pattern, const FloatPlane& height, bool dark) {
  JudgedPattern judged;
  judged.dark = dark;
  judged.outline_px = pattern.outline;
  Detection& detection = judged.detection;
  detection.centroid_px = Centroid(pattern.outline);
  detection.area_px = pattern.area_px;
  const std::vector<Proposal> proposals = ProposeMarkers(pattern.outline, models_, options_.turns);
  const double likely_px = kLikely_px + options_.likely_outline * std::sqrt(pattern.area_px);
  if (proposals.front().rms_px > likely_px) return judged;
  patch_ = CutPatch(image_, height, pattern, CornersOf(proposals, models_, pattern.outline),
                    options_.patch);
  FitAll(proposals, FirstFit(pattern, dark), NoiseOf(patch_, pattern.contrast));
  if (tried_.empty()) return judged;

  const MarkerFit& fit = tried_.front().fit;
  const ShapeModel& model = models_[tried_.front().model];
  const Polygon outline = fit.map.Of(model.outline);
  judged.evidence = Weigh(pattern, outline);
  judged.evidence.torn = pattern.torn && !dark;
  if (dark && dark_square_ > 1.0) judged.evidence.framed = Framed(height);
  judged.probability = NameProbability(judged.evidence);
  const auto in_picture = [&](const Vec2d& p) -> Vec2d {
    return patch_.origin_px + patch_.scale * p;
  };
  for (const Vec2d& p : outline) judged.fitted_px.push_back(in_picture(p));
  detection.straight_edges = model.straight_edges;
  detection.centroid_px = in_picture(dark ? Centroid(outline) : CentroidOfLight(fit));
  detection.centre_px = in_picture(fit.map.At(model.mean));
  if (model.straight_edges > 0) {
    for (const Vec2d& p : model.corners) detection.corners_px.push_back(in_picture(fit.map.At(p)));
  }
  if (judged.probability < options_.min_probability) return judged;
  detection.marker = model.number;
  detection.confidence = judged.probability;
  return judged;
}

void Judge::FitAll(const std::vector<Proposal>& proposals, const MarkerFit& first, double noise) {
  tried_.clear();
  for (const Proposal& proposal : proposals) {
    const bool enough = static_cast<int>(tried_.size()) >= options_.fits;
    if (enough || proposal.rms_px > LikelyRms(proposals) || Hopeless(noise)) break;
    if (!Settled(proposal.model, noise)) Fit(proposal, first, noise);
  }
  std::stable_sort(tried_.begin(), tried_.end(),
                   [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
  if (!tried_.empty() && !tried_.front().fit.converged) FinishBest(noise);
}

bool Judge::Hopeless(double noise) const {
  return tried_.size() >= kFirstFits &&
         std::all_of(tried_.begin(), tried_.end(), [&](const Tried& t) {
           return t.fit.mean_squares > kPoor * kPoor * noise * noise;
         });
}

// Whether a model has been fitted so well that its other turns need not be tried.
bool Judge::Settled(size_t model, double noise) const {
  return std::any_of(tried_.begin(), tried_.end(), [&](const Tried& t) {
    return t.model == model && t.fit.bend < kLittleBend && t.fit.saddle < kLittleSaddle &&
           t.fit.mean_squares < kGood * kGood * noise * noise;
  });
}

void Judge::Fit(const Proposal& proposal, MarkerFit first, double noise) {
  FitOptions options = options_.fit;
  if (!tried_.empty()) options.max_steps = std::min(options.max_steps, kRivalSteps);
  const double hopeless = std::min(kHopeless, 1.0 + kHopelessLead / patch_.count);
  for (const Tried& t : tried_) {
    options.hopeless = std::min(options.hopeless, hopeless * t.fit.mean_squares);
  }
  first.map = proposal.map.InPixels(patch_.origin_px, patch_.scale);
  const auto fit = FitMarker(patch_, models_[proposal.model], first, noise, options, coverage_);
  if (fit) tried_.push_back({proposal.model, *fit, Cost(*fit, noise)});
}

void Judge::FinishBest(double noise) {
  Tried& best = tried_.front();
  const auto fit = FitMarker(patch_, models_[best.model], best.fit, noise, options_.fit, coverage_);
  if (fit) best = {best.model, *fit, Cost(*fit, noise)};
}

double Judge::Cost(const MarkerFit& fit, double noise) const {
  const double saddle = fit.saddle / kSaddle;
  return fit.mean_squares * patch_.count / (noise * noise) + fit.bend + saddle * saddle;
}

// `outline`: of the best fit, in patch pixels.
Evidence Judge::Weigh(const Pattern& pattern, const Polygon& outline) {
  const Tried& best = tried_.front();
  const ShapeModel& model = models_[best.model];
  const double noise = NoiseOf(patch_, best.fit.contrast);
  coverage_.Render(model.outline, best.fit.map, patch_.dn.width, patch_.dn.height,
                   best.fit.blur_variance);
  Evidence e;
  e.fitted = true;
  e.number = model.number;
  e.straight_edges = model.straight_edges;
  e.misfit = std::sqrt(best.fit.mean_squares) / noise;
  for (const Tried& other : tried_) {
    if (models_[other.model].number == model.number) continue;
    e.lead = std::min(e.lead, (other.cost - best.cost) / (e.misfit * e.misfit));
  }
  e.bend = best.fit.bend;
  e.saddle = best.fit.saddle;
  e.ground_step = GroundStep(patch_, model, outline, coverage_, noise, black_dn_);
  e.free_share = patch_.free_share;
  e.white_share = WhiteShare(patch_);
  if (best.fit.contrast > 0.0) e.peak = Peak(patch_, best.fit, model, outline);
  e.least_contrast = LeastContrast(patch_, best.fit, outline);
  e.contrast_sigma = std::abs(best.fit.contrast) / pattern.noise;
  const ViewOfPlane view = ViewOf(best.fit.map.Linear());
  e.half_size_px = view.half_size_px * patch_.scale;
  e.foreshortening = view.foreshortening;
  e.blur_px = std::sqrt(best.fit.blur_variance) * patch_.scale;
  e.area_px = pattern.area_px;
  return e;
}

// `negative`: of the smoothed picture. Of the best fit.
double Judge::Framed(const FloatPlane& negative) const {
  const MarkerFit& fit = tried_.front().fit;
  const OutlineMap in_picture =
      fit.map.InPixels(-patch_.origin_px / patch_.scale, 1.0 / patch_.scale);
  return DarkFrame(negative, in_picture, dark_square_, std::abs(fit.contrast));
}

// Centroid of the light that the marker sends, in patch pixels: of every pixel what the
// surroundings and the black level do not explain, so that no model of the marker's brightness is
// needed. Blur keeps it. A neighbour's pixels and white ones are taken from the fit.
Vec2d Judge::CentroidOfLight(const MarkerFit& fit) const {
  constexpr double kUncovered = 1e-3;
  double sum = 0.0;
  Vec2d moment = Vec2d::Zero();
  for (int y = 0; y < patch_.dn.height; ++y) {
    for (int x = 0; x < patch_.dn.width; ++x) {
      const auto covered = static_cast<double>(coverage_.At(x, y)[0]);
      if (covered < kUncovered) continue;
      const Vec2d place = PlaceInPatch(patch_, Vec2d(x, y));
      const bool known = patch_.used(x, y) != 0 && patch_.dn(x, y) < patch_.white_dn;
      const double light = known ? static_cast<double>(patch_.dn(x, y)) -
                                       (1.0 - covered) * SurroundingsAt(fit.light, place)
                                 : covered * MarkerLightAt(fit.light, place);
      const double own = light - covered * black_dn_;
      sum += own;
      moment += own * Vec2d(x, y);
    }
  }
  return moment / sum;
}

}  // namespace retrolux
