#include "analysis/mask_stores.h"

#include <fmt/format.h>

#include "scenes/mask_mesh.h"

namespace retrolux {

namespace {

std::string KeyOf(const MaskSpec& spec, const std::filesystem::path& file) {
  return fmt::format("{} {} {} {} {}", spec.mesh, spec.unit, spec.scale, spec.relief,
                     file.parent_path().string());
}

}  // namespace

VisibilityStore& MaskStores::For(const Scenario& scenario, const std::string& mask_name) {
  const MaskSpec& spec = scenario.Mask(mask_name);
  std::unique_ptr<Entry>& entry = entries_[KeyOf(spec, scenario.file)];
  if (!entry) {
    entry = std::make_unique<Entry>(
        Mask(mask_name, MaskMesh(spec, scenario.file), rule_, part_area_mm2_));
  }
  return entry->store;
}

int64_t MaskStores::Made() const {
  int64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry->store.Made();
  return sum;
}

int64_t MaskStores::Asked() const {
  int64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry->store.Asked();
  return sum;
}

}  // namespace retrolux
