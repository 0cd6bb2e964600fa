// clang-format off
// The conventions of the whole project, on one page.
//
// Units      length mm, wavelength nm, time s, radiance W/(m2 sr) in band (or W/(m2 sr nm)), radiant
//            intensity W/sr, signal in photo-electrons (e-) and digital numbers (DN). Angles are
//            degrees wherever a person sees them (names end in _deg) and radians inside.
// World      right-handed. CT room: x up, z to the front, y = z x x (to the left of an observer who
//            faces the scanner), origin at the scan point. Vault: z up, x along the horizontal
//            beam, origin at the isocentre.
// Camera     as OpenCV: x right, y down, z forward. Pixel (0, 0) is the CENTRE of the top-left
//            pixel, so the picture covers [-0.5, width - 0.5] x [-0.5, height - 0.5].
// Surface    local shading frame: z along the shading normal; directions point away from it.
// Marker     frame: z along the surface normal, y along the surface in the roll direction, x = y x z.
// Transforms are named b_from_a, points x_in_a; world coordinates go without a suffix.
// glTF       (metres, y up, cameras look along -z) is converted in scenes/gltf.cpp and nowhere else.
// Random     numbers are keyed by (seed, image, pixel, sample, dimension): the same scene and seed
//            give the same bits on any number of threads.
// clang-format on
#pragma once

#include <Eigen/Dense>
#include <numbers>

namespace retrolux {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;
using Mat3d = Eigen::Matrix3d;

inline constexpr double kPi = std::numbers::pi;
inline constexpr float kPiF = std::numbers::pi_v<float>;

constexpr double RadFromDeg(double deg) {
  return deg * (kPi / 180.0);
}
constexpr double DegFromRad(double rad) {
  return rad * (180.0 / kPi);
}

// CODATA 2018, exact by the definition of the SI.
inline constexpr double kPlanck_J_s = 6.62607015e-34;
inline constexpr double kSpeedOfLight_m_s = 299792458.0;

// The range of wavelengths that is simulated: the sensitivity of silicon.
inline constexpr double kMinWavelength_nm = 400.0;
inline constexpr double kMaxWavelength_nm = 1100.0;

}  // namespace retrolux
