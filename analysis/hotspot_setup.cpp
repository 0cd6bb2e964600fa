#include "analysis/hotspot_setup.h"

#include "analysis/stereo_bench.h"
#include "renderer/exposure.h"
#include "scenes/masks.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

// On the face: forehead, temples, cheeks, chin; the cross highlight falls between them.
const Vec3d kOnFace[] = {{100, -30, 65}, {100, 30, 65}, {80, -60, 30}, {80, 60, 30},
                         {90, -45, -30}, {90, 45, -30}, {110, 0, -85}};

void PutOnFace(Scene& scene) {
  scene.objects.front().mesh = MakeMask("face");
  for (size_t i = 0; i < scene.markers.size(); ++i) scene.markers[i].at = kOnFace[i];
}

CameraSpec Neighbour(const HotspotSetup& setup, double psi_deg, int index) {
  const double azimuth = RadFromDeg((0.5 - index) * psi_deg);
  return ThesisCamera(fmt::format("neighbour-{}", index),
                      setup.distance_mm * Vec3d(std::cos(azimuth), std::sin(azimuth), 0.0),
                      Vec3d::UnitZ());
}

void SetUp(const HotspotSetup& setup, bool is_neighbour, CameraSpec& camera) {
  DiodeRing& ring = *camera.ring;
  ring.radius_mm = setup.ring_radius_mm;
  ring.half_angle_deg = setup.half_angle_deg;
  if (is_neighbour) {
    ring.peak_nm = setup.neighbour_nm;
    ring.fwhm_nm = setup.neighbour_fwhm_nm;
    camera.filter->centre_nm = setup.neighbour_nm;
  }
  camera.lens.veiling_glare = setup.veiling_glare;
  if (setup.ccd) {
    camera.sensor.blooming = Blooming{};
    camera.sensor.smear = Smear{};
  }
}

void CheckRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InputError(fmt::format("{}: found {}; expected {} to {}", name, value, low, high));
}

}  // namespace

void HotspotSetup::Check() const {
  if (mask != "oval" && mask != "face")
    throw InputError(fmt::format("mask: found '{}'; expected oval or face", mask));
  LibraryMaterial(sheeting);
  CheckRange("roughness of the mask", roughness, 0.001, 1.0);
  CheckRange("radius of the rings (mm)", ring_radius_mm, 1.0, 200.0);
  CheckRange("half angle of the diodes (degrees)", half_angle_deg, 1.0, 80.0);
  CheckRange("peak of the neighbours' diodes (nm)", neighbour_nm, 450.0, 1050.0);
  CheckRange("width of the neighbours' diodes (nm)", neighbour_fwhm_nm, 5.0, 200.0);
  CheckRange("exposure", exposure, 0.01, 1000.0);
  CheckRange("veiling glare", veiling_glare, 0.0, 0.5);
  CheckRange("cameras", cameras, 2, 8);
  CheckRange("distance (mm)", distance_mm, 500.0, 5000.0);
}

nlohmann::json HotspotSetup::ToJson() const {
  return {{"mask", mask},
          {"roughness", roughness},
          {"sheeting", sheeting},
          {"ring_radius_mm", ring_radius_mm},
          {"half_angle_deg", half_angle_deg},
          {"neighbour_nm", neighbour_nm},
          {"neighbour_fwhm_nm", neighbour_fwhm_nm},
          {"exposure", exposure},
          {"veiling_glare", veiling_glare},
          {"ccd", ccd},
          {"cameras", cameras},
          {"distance_mm", distance_mm}};
}

Scene HotspotScene(const HotspotSetup& setup, double psi_deg, int placement, uint64_t seed) {
  StereoShotOptions options;
  options.seed = seed;
  options.distance_mm = setup.distance_mm;
  options.material = setup.sheeting;
  Scene scene = StereoScene({StereoTarget::kOval, psi_deg, placement}, options);
  scene.name = "hotspot";
  // Off the highlights, which fall in the middle of the mask.
  scene.markers.back().at = Vec3d(90, 0, 60);
  if (setup.mask == "face") PutOnFace(scene);
  SetCoatRoughness(scene, scene.objects.front().material, setup.roughness);
  for (int i = 2; i < setup.cameras; ++i) scene.cameras.push_back(Neighbour(setup, psi_deg, i));
  for (size_t i = 0; i < scene.cameras.size(); ++i) SetUp(setup, i > 0, scene.cameras[i]);
  scene.exposure.time_s = setup.exposure * ExposureSeconds(scene, scene.cameras.front());
  return scene;
}

void FurnishRoom(const HotspotSetup& setup, Scene& scene) {
  SetCoatRoughness(scene, scene.Object("mask").material, setup.roughness);
  scene.UseMaterial(setup.sheeting);
  for (MarkerSpec& marker : scene.markers) marker.material = setup.sheeting;
  for (CameraSpec& camera : scene.cameras) SetUp(setup, false, camera);
  scene.exposure.time_s = setup.exposure * ExposureSeconds(scene, scene.cameras.front());
}

void SetCoatRoughness(Scene& scene, const std::string& material, double roughness) {
  nlohmann::json spec = scene.materials.at(material).spec;
  if (spec.at("type") != "coated_diffuse") {
    throw InputError(
        fmt::format("material '{}': found {}; expected coated_diffuse, whose coat can "
                    "be given another roughness",
                    material, spec.at("type").dump()));
  }
  spec["roughness"] = roughness;
  scene.materials[material] = ReadMaterial(material, JsonReader::FromText(spec.dump(), material));
}

const std::vector<HotspotVariation>& HotspotVariations() {
  static const std::vector<HotspotVariation> variations = {
      {"face", "a face mask", [](HotspotSetup& s) { s.mask = "face"; }},
      {"roughness-0.02", "a coat as smooth as glossy film",
       [](HotspotSetup& s) { s.roughness = 0.02; }},
      {"roughness-0.05", "a glossy coat", [](HotspotSetup& s) { s.roughness = 0.05; }},
      {"roughness-0.1", "a satin coat", [](HotspotSetup& s) { s.roughness = 0.1; }},
      {"roughness-0.3", "a matt coat", [](HotspotSetup& s) { s.roughness = 0.3; }},
      {"wide-sheeting", "sheeting that falls off slowly with the entrance angle",
       [](HotspotSetup& s) { s.sheeting = "retro_bead_wide"; }},
      {"prismatic", "prismatic sheeting", [](HotspotSetup& s) { s.sheeting = "retro_prismatic"; }},
      {"ring-60", "rings of 60 mm radius", [](HotspotSetup& s) { s.ring_radius_mm = 60.0; }},
      {"narrow-beam", "diodes of 5 degrees half angle",
       [](HotspotSetup& s) { s.half_angle_deg = 5.0; }},
      {"other-wavelength", "the neighbour at 780 nm (30 nm wide), each filter as its own ring",
       [](HotspotSetup& s) {
         s.neighbour_nm = 780.0;
         s.neighbour_fwhm_nm = 30.0;
       }},
      {"other-wavelength-wide", "the same with diodes as wide as the own ones (80 nm)",
       [](HotspotSetup& s) { s.neighbour_nm = 780.0; }},
      {"exposure-4", "four times the exposure: markers saturate",
       [](HotspotSetup& s) { s.exposure = 4.0; }},
      {"exposure-4-ccd", "the same on a CCD with blooming and smear",
       [](HotspotSetup& s) {
         s.exposure = 4.0;
         s.ccd = true;
       }},
      {"glare", "a lens with 5 % veiling glare", [](HotspotSetup& s) { s.veiling_glare = 0.05; }},
      {"three-cameras", "two neighbours, at one and at two separations",
       [](HotspotSetup& s) { s.cameras = 3; }},
  };
  return variations;
}

}  // namespace retrolux
