#include "analysis/visibility_store.h"

#include <array>
#include <cmath>
#include <mutex>
#include <unordered_map>

#include "core/hash.h"

namespace retrolux {

namespace {

// A camera in the mask's frame: lens and picture, and two rows of its rotation with its centre,
// rounded.
struct Key {
  std::array<int64_t, 10> values;
  bool operator==(const Key&) const = default;
};

constexpr double kPerMm = 1e6;
constexpr double kPerUnit = 1e9;

int64_t Rounded(double value, double per) {
  return std::llround(value * per);
}

Key KeyOf(const CameraModel& camera, const Vec3d& centre, const Vec3d& up) {
  Key key{};
  for (int axis = 0; axis < 3; ++axis) {
    key.values[static_cast<size_t>(axis)] = Rounded(centre[axis], kPerMm);
    key.values[static_cast<size_t>(axis + 3)] = Rounded(up[axis], kPerUnit);
  }
  key.values[6] = camera.width;
  key.values[7] = camera.height;
  key.values[8] = Rounded(camera.fx, kPerMm);
  key.values[9] = Rounded(camera.fy, kPerMm);
  return key;
}

RigidTransform CameraOf(const Key& key) {
  Vec3d centre, up;
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = static_cast<double>(key.values[static_cast<size_t>(axis)]) / kPerMm;
    up[axis] = static_cast<double>(key.values[static_cast<size_t>(axis + 3)]) / kPerUnit;
  }
  return LookAt(centre, Vec3d::Zero(), up);
}

struct KeyHash {
  size_t operator()(const Key& key) const {
    return HashBytes({reinterpret_cast<const char*>(key.values.data()), sizeof(key.values)});
  }
};

}  // namespace

// Many small tables, so that threads seldom wait for each other. Whoever asks for a set that
// another thread is making waits for it.
struct VisibilityStore::Sets {
  struct Table {
    std::mutex mutex;
    std::unordered_map<Key, std::shared_ptr<const SampleSet>, KeyHash> sets;
  };
  std::array<Table, 256> tables;
  Table& TableOf(const Key& key) { return tables[KeyHash()(key) % tables.size()]; }
};

VisibilityStore::VisibilityStore(const Mask& mask, size_t max_bytes)
    : mask_(mask), max_bytes_(max_bytes), sets_(std::make_unique<Sets>()) {}

VisibilityStore::~VisibilityStore() = default;

std::shared_ptr<const SampleSet> VisibilityStore::SeenBy(const Scenario& scenario,
                                                         const Vec3d& centre,
                                                         const Mat3d& world_from_mask) {
  ++asked_;
  CameraModel camera = VaultCamera(scenario, "", centre);
  const Vec3d up = -camera.camera_from_world.rotation.row(1).transpose();
  const Mat3d mask_from_world = world_from_mask.transpose();
  const Key key = KeyOf(camera, mask_from_world * centre, mask_from_world * up);
  const auto make = [&]() -> std::shared_ptr<const SampleSet> {
    ++made_;
    camera.camera_from_world = CameraOf(key);
    return std::make_shared<const SampleSet>(mask_.SeenBy(camera));
  };
  Sets::Table& table = sets_->TableOf(key);
  const std::lock_guard lock(table.mutex);
  const auto known = table.sets.find(key);
  if (known != table.sets.end()) return known->second;
  const size_t set_bytes = mask_.Samples().Size() / 8 + sizeof(Key) + 64;
  const std::shared_ptr<const SampleSet> set = make();
  if (table.sets.size() * set_bytes < max_bytes_ / sets_->tables.size()) table.sets[key] = set;
  return set;
}

}  // namespace retrolux
