// The decision on one pattern: proposals, fits, evidence, name.
#pragma once

#include <optional>

#include "classifier/proposals.h"
#include "classifier/robust.h"

namespace retrolux {

class Judge {
 public:
  // `dark_square`: side of a dark marker's bright square, of the marker's own; `black_dn`: what a
  // pixel without light reads. All must outlive it.
  Judge(const DigitalImage& image, const std::vector<ShapeModel>& models, double dark_square,
        const RobustOptions& options, double black_dn)
      : image_(image),
        models_(models),
        dark_square_(dark_square),
        options_(options),
        black_dn_(black_dn) {}

  // `height`: the smoothed picture, or for dark patterns its negative, in which they are bright.
  JudgedPattern Decide(const Pattern& pattern, const FloatPlane& height, bool dark);

 private:
  // A fit of one model.
  struct Tried {
    size_t model;
    MarkerFit fit;
    double cost;  // chi-square of pixels, bend and saddle
  };

  void FitAll(const std::vector<Proposal>& proposals, const MarkerFit& first, double noise);
  void Fit(const Proposal& proposal, MarkerFit first, double noise);
  void FinishBest(double noise);
  bool Hopeless(double noise) const;
  bool Settled(size_t model, double noise) const;
  double Cost(const MarkerFit& fit, double noise) const;
  Evidence Weigh(const Pattern& pattern, const Polygon& outline);
  double Framed(const FloatPlane& negative) const;
  Vec2d CentroidOfLight(const MarkerFit& fit) const;

  const DigitalImage& image_;
  const std::vector<ShapeModel>& models_;
  double dark_square_;
  const RobustOptions& options_;
  double black_dn_;
  // Of the pattern at hand.
  Patch patch_;
  std::vector<Tried> tried_;  // the best first, once all are made
  Coverage coverage_;
};

}  // namespace retrolux
