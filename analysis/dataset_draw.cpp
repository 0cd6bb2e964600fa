#include "analysis/dataset_draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/hash.h"
#include "core/sampler.h"

namespace retrolux {

double SceneDraw::Uniform(std::string_view name) const {
  const uint64_t key = CombineKeys(seed_, HashBytes(name));
  const uint32_t index = sobol::OwenScramble(scene_, static_cast<uint32_t>(key));
  return sobol::OwenScramble(sobol::ReverseBits(index), static_cast<uint32_t>(key >> 32)) * 0x1p-32;
}

double Range::At(double uniform) const {
  if (log) return min * std::pow(max / min, uniform);
  return min + (max - min) * uniform;
}

namespace {

// The two ends of a range.
std::array<JsonReader, 2> Ends(const JsonReader& node) {
  if (node.Size() != 2) node.Fail(fmt::format("{} numbers", node.Size()), "[min, max]");
  const size_t first = 0, second = 1;
  return {node.Child(first), node.Child(second)};
}

void CheckAscending(const JsonReader& node, double min, double max) {
  if (min > max) node.Fail(fmt::format("{} before {}", min, max), "the smaller number first");
}

}  // namespace

Range ReadRange(JsonReader& json, const std::string& key, double min, double max,
                const Range& fallback) {
  if (!json.Has(key)) return fallback;
  JsonReader node = json.Child(key);
  if (node.IsNumber()) {
    const double value = node.AsNumber(min, max);
    return {value, value, false};
  }
  Range range;
  if (node.IsObject()) {
    range.log = true;
    JsonReader ends = node.Child("log");
    node.Finish();
    node = ends;
  }
  const std::array<JsonReader, 2> two = Ends(node);
  range.min = two[0].AsNumber(range.log ? std::max(min, 1e-9) : min, max);
  range.max = two[1].AsNumber(min, max);
  CheckAscending(node, range.min, range.max);
  return range;
}

int WholeRange::Draw(const SceneDraw& draw, std::string_view name) const {
  return min + static_cast<int>(draw.Uniform(name) * (max - min + 1));
}

WholeRange ReadWholeRange(JsonReader& json, const std::string& key, int min, int max,
                          const WholeRange& fallback) {
  if (!json.Has(key)) return fallback;
  const JsonReader node = json.Child(key);
  const auto whole = [&](const JsonReader& number) {
    const double value = number.AsNumber(min, max);
    if (value != std::floor(value)) number.Fail(fmt::format("{}", value), "a whole number");
    return static_cast<int>(value);
  };
  if (node.IsNumber()) return {whole(node), whole(node)};
  const std::array<JsonReader, 2> two = Ends(node);
  const WholeRange range{whole(two[0]), whole(two[1])};
  CheckAscending(node, range.min, range.max);
  return range;
}

size_t PickWeighted(const std::vector<double>& weights, double uniform) {
  double rest = uniform * std::accumulate(weights.begin(), weights.end(), 0.0);
  size_t chosen = 0;
  for (size_t i = 0; i < weights.size() && rest >= 0.0; ++i) {
    if (weights[i] <= 0.0) continue;
    chosen = i;
    rest -= weights[i];
  }
  return chosen;
}

NameChoice ReadNameChoice(JsonReader& json, const std::string& key,
                          const std::vector<std::string>& known, const std::string& fallback) {
  if (!json.Has(key)) return {{fallback}, {1.0}};
  JsonReader node = json.Child(key);
  if (node.IsString()) return {{json.Choice(key, known)}, {1.0}};
  NameChoice choice;
  double sum = 0.0;
  for (const std::string& name : known) {
    if (!node.Has(name)) continue;
    choice.names.push_back(name);
    choice.weights.push_back(node.Number(name, 0.0, 1e6));
    sum += choice.weights.back();
  }
  node.Finish();
  if (!(sum > 0.0)) {
    node.Fail("no weight above 0", fmt::format("weights for some of {}", JoinNames(known)));
  }
  return choice;
}

}  // namespace retrolux
