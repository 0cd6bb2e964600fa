#include "materials/directional_albedo.h"

#include "materials/microfacet.h"

namespace retrolux {

namespace {

constexpr int kAngles = 129;
// Points along and around the projected disc of visible facets; the error for facets that reflect
// all light is below 3e-4.
constexpr int kAlong = 60, kAround = 30;

// Expectation of F G2 / G1 over visible normals, by the midpoint rule on the square that they are
// sampled from, finer towards the disc's rim, where steep facets lie: u = 1 - (1 - v)^2.
float Integrate(float cosine, const std::function<float(float)>& fresnel, float alpha) {
  const Vec3f w(std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
  double sum = 0.0;
  for (int i = 0; i < kAlong; ++i) {
    const float rest = 1.0f - (static_cast<float>(i) + 0.5f) / kAlong;
    for (int j = 0; j < kAround; ++j) {
      const Vec2f u(1.0f - rest * rest, (static_cast<float>(j) + 0.5f) / kAround);
      const Vec3f h = ggx::SampleVisibleNormal(w, alpha, u);
      const Vec3f wi = ggx::Reflect(w, h);
      if (wi.z() <= 0.0f) continue;
      sum += static_cast<double>(2.0f * rest * fresnel(w.dot(h)) * ggx::MaskingBoth(w, wi, alpha) /
                                 ggx::MaskingOne(w, alpha));
    }
  }
  return static_cast<float>(sum / (kAlong * kAround));
}

}  // namespace

DirectionalAlbedo::DirectionalAlbedo(float ior, float alpha)
    : DirectionalAlbedo([ior](float cosine) { return ggx::FresnelDielectric(cosine, ior); },
                        alpha) {}

DirectionalAlbedo DirectionalAlbedo::OfMirrors(float alpha) {
  return {[](float) { return 1.0f; }, alpha};
}

DirectionalAlbedo::DirectionalAlbedo(const Fresnel& fresnel, float alpha) : table_(kAngles) {
  for (int i = 0; i < kAngles; ++i) {
    const float cosine = std::max(1e-4f, static_cast<float>(i) / (kAngles - 1));
    table_[static_cast<size_t>(i)] = Integrate(cosine, fresnel, alpha);
  }
  // Exact integral of the piecewise linear table: int (a + (b - a) t) c dc over each cell.
  const double step = 1.0 / (kAngles - 1);
  double mean = 0.0;
  for (int i = 0; i + 1 < kAngles; ++i) {
    const double c = i * step;
    const auto a = static_cast<double>(table_[static_cast<size_t>(i)]);
    const auto b = static_cast<double>(table_[static_cast<size_t>(i) + 1]);
    mean += step * (a * c + 0.5 * (b * c - a * c + a * step) + (b - a) * step / 3.0);
  }
  mean_ = static_cast<float>(2.0 * mean);
}

}  // namespace retrolux
