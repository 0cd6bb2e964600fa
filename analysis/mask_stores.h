// The masks of a run, each loaded once.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "analysis/visibility_store.h"

namespace retrolux {

// Masks that were loaded, and what has been seen of them so far. Shared by studies that run one
// after the other.
class MaskStores {
 public:
  MaskStores(VisibilityRule rule, double part_area_mm2)
      : rule_(rule), part_area_mm2_(part_area_mm2) {}
  // The store of a scenario's mask. InputError if its mesh can't be read or has no area.
  VisibilityStore& For(const Scenario& scenario, const std::string& mask_name);
  int64_t Made() const;
  int64_t Asked() const;

 private:
  struct Entry {
    Mask mask;
    VisibilityStore store;
    Entry(Mask the_mask) : mask(std::move(the_mask)), store(mask) {}
  };
  VisibilityRule rule_;
  double part_area_mm2_;
  std::map<std::string, std::unique_ptr<Entry>> entries_;
};

}  // namespace retrolux
