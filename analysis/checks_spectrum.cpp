// Checks of light over wavelength: what a filter does for the signal against the room's light, and
// what an LED loses whose peak lies beside the filter's centre.
#include <cmath>

#include "analysis/check.h"
#include "core/csv.h"
#include "core/data_path.h"
#include "renderer/path_tracer.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

// A white wall in front of a camera, lit by the camera's ring and by even surroundings.
struct Set {
  LedType led{880.0, 80.0};
  double junction_temperature_c = 25.0;
  std::optional<DichroicFilter> filter;
  std::string ambient = "materials/data/fluorescent.csv";
  std::string quantum_efficiency = "materials/data/qe_interline_ccd.csv";
};

// Electrons of a pixel on the axis, rendered.
struct Electrons {
  double ring, ambient;
};
Electrons Render(const Set& set) {
  Scene scene;
  scene.materials["white"] = ReadMaterial(
      "white", JsonReader::FromText(R"({"type": "diffuse", "reflectance": 1.0})", "white"));
  scene.objects.push_back(
      {"wall", RectangleMesh({0, -500, -500}, {0, 1000, 0}, {0, 0, 1000}), {}, "white"});
  scene.ambient.spectrum = set.ambient;
  scene.ambient.environment_w_m2_sr = 1.0;
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView("camera", 64, 64, 1.0, 1.0,
                                              LookAt({1600, 0, 0}, Vec3d::Zero(), Vec3d::UnitZ()));
  camera.filter = set.filter;
  camera.sensor.quantum_efficiency = set.quantum_efficiency;
  camera.ring = DiodeRing{};
  camera.ring->peak_nm = set.led.peak_nm;
  camera.ring->fwhm_nm = set.led.fwhm_nm;
  camera.ring->spectrum_shape = set.led.shape;
  camera.ring->junction_temperature_c = set.junction_temperature_c;
  scene.cameras.push_back(camera);
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "camera");
  const CameraResponse response(camera, lights.Spectra(), 1e-3);
  const std::vector<PlacedMarker> no_markers;
  TraceOptions options;
  options.samples_per_pixel = 4096;
  const PathTracer tracer(scene, rays, lights, response, no_markers, options);
  const GroupValues electrons = tracer.EstimatePixel(32, 32).electrons;
  return {static_cast<double>(electrons[0]), static_cast<double>(electrons[1])};
}

// A table's two columns, linear between its points, written out here.
class Table {
 public:
  explicit Table(const std::string& name) : table_(ReadNumberTable(DataPath(name))) {}
  double At(double nm) const {
    const auto& rows = table_.rows;
    if (nm <= rows.front()[0]) return rows.front()[1];
    for (size_t i = 1; i < rows.size(); ++i) {
      if (nm > rows[i][0]) continue;
      const double t = (nm - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
      return (1.0 - t) * rows[i - 1][1] + t * rows[i][1];
    }
    return rows.back()[1];
  }

 private:
  NumberTable table_;
};

double Gaussian(double nm, const LedType& led) {
  return std::exp(-4.0 * std::numbers::ln2 * std::pow((nm - led.peak_nm) / led.fwhm_nm, 2));
}

double SuperGaussian(double nm, const DichroicFilter& filter) {
  const double floor = std::pow(10.0, -filter.optical_density);
  const double x = 2.0 * (nm - filter.centre_nm) / filter.bandwidth_nm;
  return floor + (filter.peak_transmission - floor) * std::pow(2.0, -std::pow(x, 8));
}

// integral of S T eta lambda over that without T, 400 to 1100 nm, in steps of 0.05 nm: the share of
// a light's electrons that a filter leaves.
template <typename Emission>
double PassedShare(Emission&& emission, const Table& efficiency, const DichroicFilter& filter) {
  double passed = 0.0, all = 0.0;
  constexpr int kSteps = 14000;
  for (int i = 0; i < kSteps; ++i) {
    const double nm = 400.0 + 700.0 * (i + 0.5) / kSteps;
    const double electrons = emission(nm) * efficiency.At(nm) * nm;
    all += electrons;
    passed += electrons * SuperGaussian(nm, filter);
  }
  return passed / all;
}

// An ideal filter: the peak transmission over `bandwidth_nm`, 10^-OD elsewhere.
DichroicFilter TopHat() {
  DichroicFilter filter;
  const double from = filter.centre_nm - 0.5 * filter.bandwidth_nm,
               to = filter.centre_nm + 0.5 * filter.bandwidth_nm;
  // On the grid of 1 nm the flanks are 2 nm wide, half of the peak at the band's edges.
  filter.UseTable("top hat", Spectrum::FromFunction([&](double nm) {
                    if (nm == from || nm == to) return 0.5 * DichroicFilter{}.peak_transmission;
                    return nm > from && nm < to ? DichroicFilter{}.peak_transmission : 0.0;
                  }));
  return filter;
}

// Share of a Gaussian LED's photons in the band of a top hat, in closed form. With g the density of
// the normal distribution of the LED's peak and sigma,
//   integral of lambda g over (a, b) = peak / 2 [erf] + sigma^2 (g(a) - g(b)),   over all: peak.
double ShareInBand(const LedType& led, double from, double to) {
  const double sigma = led.fwhm_nm / std::sqrt(8.0 * std::numbers::ln2);
  const auto erf = [&](double nm) {
    return std::erf((nm - led.peak_nm) / (sigma * std::numbers::sqrt2));
  };
  const auto density = [&](double nm) {
    const double x = (nm - led.peak_nm) / sigma;
    return std::exp(-0.5 * x * x) / (sigma * std::sqrt(2.0 * kPi));
  };
  return 0.5 * (erf(to) - erf(from)) + sigma * sigma * (density(from) - density(to)) / led.peak_nm;
}

}  // namespace

std::vector<Check> CheckFilterGain() {
  std::vector<Check> checks;
  const auto add = [&](const std::string& name, const Set& set, double expected,
                       const std::string& source) {
    Set open = set;
    open.filter.reset();
    const Electrons with = Render(set), without = Render(open);
    const double gain = (with.ring / without.ring) / (with.ambient / without.ambient);
    checks.push_back({name, gain, expected, 5e-3 * expected, "", source});
  };
  // The filter's gain in signal to background, G = [ring's light passed] / [room's light passed].
  struct Pair {
    LedType led;
    double bandwidth_nm;
  };
  for (const Pair& pair : {Pair{{880.0, 80.0}, 50.0}, Pair{{850.0, 30.0}, 20.0}}) {
    DichroicFilter filter;
    filter.centre_nm = pair.led.peak_nm;
    filter.bandwidth_nm = pair.bandwidth_nm;
    for (const std::string ambient : {"fluorescent", "incandescent", "daylight"}) {
      Set set;
      set.led = pair.led;
      set.filter = filter;
      set.ambient = fmt::format("materials/data/{}.csv", ambient);
      const Table emission(set.ambient), efficiency(set.quantum_efficiency);
      const double expected =
          PassedShare([&](double nm) { return Gaussian(nm, pair.led); }, efficiency, filter) /
          PassedShare([&](double nm) { return emission.At(nm); }, efficiency, filter);
      add(fmt::format("gain over {}, LED {:g}/{:g} nm, filter {:g} nm", ambient, pair.led.peak_nm,
                      pair.led.fwhm_nm, pair.bandwidth_nm),
          set, expected,
          "quadrature of emission, filter and quantum efficiency in steps of 0.05 nm; 0.5 % for "
          "the renderer's cells of 1 nm");
    }
  }
  // Even light, an ideal counter, a filter that is a rectangle: G = T_LED W / (T_pk B + 10^-OD W)
  // with each term weighed by its photons, which go with lambda: W by 750 nm on average, B by the
  // filter's centre.
  Set flat;
  flat.filter = TopHat();
  flat.ambient = "materials/data/illuminant_e.csv";
  flat.quantum_efficiency = "materials/data/qe_unity.csv";
  const DichroicFilter band;
  const double floor = std::pow(10.0, -band.optical_density);
  const double in_band = ShareInBand(flat.led, band.centre_nm - 0.5 * band.bandwidth_nm,
                                     band.centre_nm + 0.5 * band.bandwidth_nm);
  const double led_passed = band.peak_transmission * in_band + floor * (1.0 - in_band);
  const double all = 700.0 * 750.0, of_band = band.bandwidth_nm * band.centre_nm;
  add("gain over flat light, rectangular filter", flat,
      led_passed * all / (band.peak_transmission * of_band + floor * (all - of_band)),
      "G = T_LED W / (T_pk B + 10^-OD W), photons counted, T_LED by erf; 0.5 % for the cells of 1 "
      "nm");
  return checks;
}

std::vector<Check> CheckLedMismatch() {
  std::vector<Check> checks;
  const auto passed = [](const Set& set) {
    Set open = set;
    open.filter.reset();
    return Render(set).ring / Render(open).ring;
  };
  const Table efficiency("materials/data/qe_interline_ccd.csv");
  const double from = 855.0, to = 905.0, peak = DichroicFilter{}.peak_transmission;
  for (const double offset_nm : {0.0, 10.0, 25.0, 40.0}) {
    Set set;
    set.led = {880.0 + offset_nm, 30.0};
    set.filter = TopHat();
    set.quantum_efficiency = "materials/data/qe_unity.csv";
    checks.push_back({fmt::format("LED {:g} nm off a rectangular filter of 50 nm", offset_nm),
                      passed(set), peak * ShareInBand(set.led, from, to), 2e-3, "",
                      "difference of error functions, photons counted; 0.002 for the cells of 1 "
                      "nm and the flanks"});
    set.filter = DichroicFilter{};
    set.quantum_efficiency = "materials/data/qe_interline_ccd.csv";
    checks.push_back(
        {fmt::format("LED {:g} nm off a super-Gaussian filter of 50 nm", offset_nm), passed(set),
         PassedShare([&](double nm) { return Gaussian(nm, set.led); }, efficiency, *set.filter),
         2e-3, "", "quadrature in steps of 0.05 nm; 0.002 for the cells of 1 nm"});
  }
  // Junctions at 85 C: the peak 18 nm farther (0.3 nm/K), 30 % less light (0.5 %/K).
  Set cold, hot;
  cold.led = hot.led = {880.0, 30.0};
  cold.filter = hot.filter = DichroicFilter{};
  hot.junction_temperature_c = 85.0;
  const auto share = [&](const LedType& led) {
    // Electrons for each watt: photons go with lambda.
    double electrons = 0.0, energy = 0.0;
    for (int i = 0; i < 14000; ++i) {
      const double nm = 400.0 + 0.05 * (i + 0.5);
      energy += Gaussian(nm, led);
      electrons += Gaussian(nm, led) * efficiency.At(nm) * nm * SuperGaussian(nm, *cold.filter);
    }
    return electrons / energy;
  };
  checks.push_back({"signal with the junctions at 85 C over that at 25 C",
                    Render(hot).ring / Render(cold).ring,
                    0.7 * share({898.0, 30.0}) / share({880.0, 30.0}), 2e-3, "",
                    "0.3 nm/K and -0.5 %/K over 60 K (SFH 4555), quadrature over wavelength"});
  return checks;
}

}  // namespace retrolux
