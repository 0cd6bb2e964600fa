// What a dataset's scenes are drawn with: distributions as data, and numbers that cover them evenly
// over the scenes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/json_reader.h"

namespace retrolux {

// Uniform numbers of one scene, each with a name of its own. Over the scenes, the numbers of one
// name are an Owen-scrambled radical inverse in base 2, scrambled and shuffled by the name (as
// core/sampler.h): the first 2^k scenes have one in each 2^k-th of [0, 1). A number depends on
// seed, name and scene alone, so further names leave those there are as they are.
class SceneDraw {
 public:
  SceneDraw(uint64_t seed, uint32_t scene) : seed_(seed), scene_(scene) {}
  double Uniform(std::string_view name) const;  // [0, 1)
  bool Chance(std::string_view name, double probability) const {
    return Uniform(name) < probability;
  }

 private:
  uint64_t seed_;
  uint32_t scene_;
};

// In a file: a number, [min, max] (uniform), or {"log": [min, max]} (uniform in the logarithm).
struct Range {
  double min = 0.0, max = 0.0;
  bool log = false;

  double At(double uniform) const;
  double Draw(const SceneDraw& draw, std::string_view name) const { return At(draw.Uniform(name)); }
};

// min and max bound the numbers that the file may give.
Range ReadRange(JsonReader& json, const std::string& key, double min, double max,
                const Range& fallback);

// Whole numbers, both ends included; in a file a number or [min, max].
struct WholeRange {
  int min = 0, max = 0;
  int Draw(const SceneDraw& draw, std::string_view name) const;
};
WholeRange ReadWholeRange(JsonReader& json, const std::string& key, int min, int max,
                          const WholeRange& fallback);

// Which of the weights `uniform` falls on. One of them must be positive.
size_t PickWeighted(const std::vector<double>& weights, double uniform);

// In a file {"name": weight, ...}, or one name alone.
struct NameChoice {
  std::vector<std::string> names;
  std::vector<double> weights;
  const std::string& Draw(const SceneDraw& draw, std::string_view dimension) const {
    return names[PickWeighted(weights, draw.Uniform(dimension))];
  }
};
// `known`: the names that may be chosen.
NameChoice ReadNameChoice(JsonReader& json, const std::string& key,
                          const std::vector<std::string>& known, const std::string& fallback);

}  // namespace retrolux
