// retro_table: retro-reflective sheeting by its measured coefficients of retro-reflection.
//   table                of R_A: observation_deg, entrance_deg, ra_cd_lx_m2 (materials/ra_table.h)
//   diffuse_reflectance  of the body under the cover, number or table       default 0.27
//   ior, cover_roughness of the cover; ior 1 means no cover                 default 1.5, 0.1
//
// The table is of the whole sheet: what cover and body reflect at its points (the body at 555 nm,
// where such tables are measured) is taken off it, and the rest is a lobe about the direction of
// the view, continued between and beyond the points as materials/ra_surface.h says. It does not
// depend on the wavelength.
#include "materials/bsdf_factory.h"
#include "materials/ra_surface.h"
#include "materials/sheet.h"

namespace retrolux {

namespace {

// The lobe of an RaSurface, drawn from the cumulated density of its angle to the view. That is
// tabulated for views every 2 degrees; a view takes the nearest, and any azimuth alike.
class TableLobe {
 public:
  struct Value {
    float f_cos, pdf;
  };
  explicit TableLobe(RaSurface surface) : surface_(std::move(surface)) {
    const double from = static_cast<double>(surface_.LeastT());
    const double to = std::log(4.0 + std::exp(from));
    for (int i = 0; i <= kBins; ++i) {
      t_edges_[static_cast<size_t>(i)] = from + (to - from) * i / kBins;
    }
    for (int k = 0; k < kViews; ++k) views_.push_back(Tabulate(kViewStep_deg * k));
  }

  Value Evaluate(const Vec3f& wo, const Vec3f& wi) const {
    const float t = surface_.T(wo, wi);
    return {surface_.At(t, RaSurface::X(wo.z(), wi.z())) * wi.z(),
            ViewAt(wo).density[BinOf(static_cast<double>(t))]};
  }
  Vec3f Sample(const Vec3f& wo, float, const Vec2f& u) const {
    const View& view = ViewAt(wo);
    const auto above =
        std::upper_bound(view.cumulated.begin() + 1, view.cumulated.end() - 1, u.x());
    const auto bin = static_cast<size_t>(above - view.cumulated.begin()) - 1;
    const double share = static_cast<double>((u.x() - view.cumulated[bin]) /
                                             (view.cumulated[bin + 1] - view.cumulated[bin]));
    // |wo - wi|^2 = 2 (1 - cos) is uniform over equal solid angles.
    const double d2 = std::lerp(surface_.Distance2(t_edges_[bin]),
                                surface_.Distance2(t_edges_[bin + 1]), std::clamp(share, 0.0, 1.0));
    const auto cosine = static_cast<float>(1.0 - 0.5 * d2);
    const auto sine = static_cast<float>(std::sqrt(std::max(0.0, d2 * (1.0 - 0.25 * d2))));
    const float azimuth = 2.0f * kPiF * u.y();
    return Frame(wo).WorldFromLocal({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
  }
  float Share(const Vec3f& wo) const { return ViewAt(wo).albedo; }

  // The share of the light that the lobe reflects to each of the views, by quadrature.
  struct AlbedoAt {
    double view_deg, albedo;
  };
  std::vector<AlbedoAt> Albedos() const {
    std::vector<AlbedoAt> albedos;
    for (int k = 0; k < kViews; ++k) {
      albedos.push_back(
          {kViewStep_deg * k, static_cast<double>(views_[static_cast<size_t>(k)].albedo)});
    }
    return albedos;
  }

 private:
  static constexpr int kBins = 256, kAzimuths = 32, kViews = 46;
  static constexpr double kViewStep_deg = 2.0;
  struct View {
    std::array<float, kBins> density;        // 1/sr
    std::array<float, kBins + 1> cumulated;  // 0 to 1
    float albedo;
  };

  View Tabulate(double view_deg) const {
    const double theta = RadFromDeg(std::min(view_deg, 89.99));
    const Vec3f wo(static_cast<float>(std::sin(theta)), 0.0f, static_cast<float>(std::cos(theta)));
    const Frame frame(wo);
    std::array<double, kBins> lobe;  // f times the solid angle
    double sum = 0.0, albedo = 0.0;
    for (size_t i = 0; i < kBins; ++i) {
      const double t = 0.5 * (t_edges_[i] + t_edges_[i + 1]);
      const double d2 = surface_.Distance2(t);
      const double solid_angle = SolidAngle(i);
      lobe[i] =
          solid_angle * static_cast<double>(surface_.At(static_cast<float>(t), 1.0f - wo.z()));
      sum += lobe[i];
      const double cosine = 1.0 - 0.5 * d2, sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
      for (int a = 0; a < kAzimuths; ++a) {
        const double azimuth = 2.0 * kPi * (a + 0.5) / kAzimuths;
        const Vec3f wi = frame.WorldFromLocal(
            Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine).cast<float>());
        if (wi.z() <= 0.0f) continue;
        const float f = surface_.At(static_cast<float>(t), RaSurface::X(wo.z(), wi.z()));
        albedo += solid_angle / kAzimuths * static_cast<double>(f * wi.z());
      }
    }
    View view;
    view.albedo = static_cast<float>(albedo);
    view.cumulated[0] = 0.0f;
    double cumulated = 0.0;
    for (size_t i = 0; i < kBins; ++i) {
      const float before = view.cumulated[i];
      view.cumulated[i + 1] =
          i + 1 == kBins ? 1.0f : static_cast<float>((cumulated += lobe[i]) / sum);
      // Of the rounded numbers that are drawn from.
      view.density[i] =
          static_cast<float>(static_cast<double>(view.cumulated[i + 1] - before) / SolidAngle(i));
    }
    return view;
  }
  // Of a ring of directions about the view, 2 pi (1 - cos) between its edges.
  double SolidAngle(size_t bin) const {
    return kPi * (surface_.Distance2(t_edges_[bin + 1]) - surface_.Distance2(t_edges_[bin]));
  }
  size_t BinOf(double t) const {
    const double place = (t - t_edges_.front()) / (t_edges_.back() - t_edges_.front()) * kBins;
    return static_cast<size_t>(std::clamp(place, 0.0, kBins - 1.0));
  }
  const View& ViewAt(const Vec3f& wo) const {
    const double deg = DegFromRad(static_cast<double>(std::acos(std::min(1.0f, wo.z()))));
    return views_[static_cast<size_t>(std::lround(deg / kViewStep_deg))];
  }

  RaSurface surface_;
  std::array<double, kBins + 1> t_edges_;
  std::vector<View> views_;
};

constexpr float kPhotopicPeak_nm = 555.0f;

RaSurface ReadSurface(JsonReader& json, const Sheet& sheet) {
  const std::filesystem::path file = ReadTablePath(json, "table");
  const RaTable table = RaTable::FromFile(file);
  const auto rest = [&](const Vec3f& wo, const Vec3f& wi) {
    const Spectral f = sheet.FCos(wo, wi, Spectral::Constant(kPhotopicPeak_nm)) / wi.z();
    return static_cast<double>(f[0]);
  };
  try {
    return {table, rest};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

std::shared_ptr<const Bsdf> MakeRetroTable(JsonReader& json) {
  const auto sheet = std::make_shared<const Sheet>(ReadSheet(json));
  TableLobe lobe(ReadSurface(json, *sheet));
  for (const auto& [view_deg, albedo] : lobe.Albedos()) {
    const auto cosine = static_cast<float>(std::cos(RadFromDeg(view_deg)));
    const double cover = static_cast<double>(sheet->CoverAlbedo({0.0f, 0.0f, cosine}));
    const double total = albedo + cover + static_cast<double>(sheet->body.Max()) * (1.0 - cover);
    if (total <= 1.0) continue;
    json.Child("table").Fail(
        fmt::format("a lobe, cover and body that reflect {:.3f} of the light to {} degrees", total,
                    view_deg),
        "at most 1 at every angle: a smaller table, or a smaller diffuse_reflectance");
  }
  return std::make_shared<Sheeting<TableLobe>>(std::move(lobe), sheet);
}

}  // namespace retrolux
