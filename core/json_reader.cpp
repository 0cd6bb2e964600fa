#include "core/json_reader.h"

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/file_below.h"

namespace retrolux {

namespace {

// What a node is, in few words, for "found ...".
std::string Describe(const nlohmann::json& node) {
  if (node.is_structured())
    return fmt::format("{} of {} entries", node.is_array() ? "an array" : "an object", node.size());
  std::string text = node.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 37) + "...";
  return fmt::format("{} {}", node.type_name(), text);
}

std::string Range(double min, double max) {
  return fmt::format("a number from {} to {}", min, max);
}

bool IsDeeperThan(int depth, const nlohmann::json& node) {
  if (!node.is_structured()) return false;
  return depth == 0 || std::any_of(node.begin(), node.end(), [&](const nlohmann::json& child) {
           return IsDeeperThan(depth - 1, child);
         });
}

}  // namespace

JsonReader JsonReader::FromFile(const std::filesystem::path& file) {
  return FromText(ReadTextFile(file), file);
}

JsonReader JsonReader::FromText(const std::string& text, const std::filesystem::path& file) {
  auto document = std::make_shared<Document>();
  document->file = file;
  try {
    document->root = nlohmann::json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const nlohmann::json::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ...": keep what follows
    // the tag.
    const std::string what = error.what();
    const size_t start = what.find("] ");
    throw InputError::At(file, "", start == std::string::npos ? what : what.substr(start + 2),
                         "JSON");
  } catch (const nlohmann::json::out_of_range&) {
    throw InputError::At(file, "", "a number too large for a double", "finite numbers");
  }
  if (IsDeeperThan(kMaxJsonDepth, document->root)) {
    throw InputError::At(file, "", fmt::format("JSON nested more than {} deep", kMaxJsonDepth),
                         "a document that is less deep");
  }
  const nlohmann::json* root = &document->root;
  return JsonReader(std::move(document), root, "");
}

void JsonReader::Fail(std::string_view found, std::string_view expected) const {
  throw InputError::At(File(), Pointer(), fmt::format("found {}", found), expected);
}

void JsonReader::RequireObject() const {
  if (!node_->is_object()) Fail(Describe(*node_), "an object");
}

bool JsonReader::Has(const std::string& key) {
  RequireObject();
  read_->insert(key);
  return node_->contains(key);
}

JsonReader JsonReader::Child(const std::string& key) {
  if (!Has(key)) Fail(fmt::format("no key '{}'", key), fmt::format("'{}'", key));
  return JsonReader(document_, &(*node_)[key], pointer_ + "/" + key);
}

JsonReader JsonReader::Child(size_t index) const {
  RETROLUX_CHECK(index < Size(), "index {} of {}", index, Size());
  return JsonReader(document_, &(*node_)[index], fmt::format("{}/{}", pointer_, index));
}

size_t JsonReader::Size() const {
  if (!node_->is_array()) Fail(Describe(*node_), "an array");
  return node_->size();
}

double JsonReader::AsNumber(double min, double max) const {
  if (!node_->is_number()) Fail(Describe(*node_), Range(min, max));
  const double value = node_->get<double>();
  if (!std::isfinite(value) || value < min || value > max) Fail(Describe(*node_), Range(min, max));
  return value;
}

std::string JsonReader::AsString() const {
  if (!node_->is_string()) Fail(Describe(*node_), "a string");
  return node_->get<std::string>();
}

std::vector<double> JsonReader::Numbers(size_t count) const {
  if (!node_->is_array() || node_->size() != count) {
    Fail(Describe(*node_), fmt::format("an array of {} numbers", count));
  }
  std::vector<double> numbers;
  for (size_t i = 0; i < count; ++i) numbers.push_back(Child(i).AsNumber(-1e9, 1e9));
  return numbers;
}

double JsonReader::Number(const std::string& key, double min, double max) {
  return Child(key).AsNumber(min, max);
}

double JsonReader::Number(const std::string& key, double min, double max, double fallback) {
  return Has(key) ? Number(key, min, max) : fallback;
}

int JsonReader::Integer(const std::string& key, int min, int max) {
  const JsonReader child = Child(key);
  const double value = child.AsNumber(min, max);
  if (value != std::floor(value)) {
    child.Fail(Describe(*child.node_), fmt::format("a whole number from {} to {}", min, max));
  }
  return static_cast<int>(value);
}

int JsonReader::Integer(const std::string& key, int min, int max, int fallback) {
  return Has(key) ? Integer(key, min, max) : fallback;
}

bool JsonReader::Bool(const std::string& key, bool fallback) {
  if (!Has(key)) return fallback;
  const JsonReader child = Child(key);
  if (!child.node_->is_boolean()) child.Fail(Describe(*child.node_), "true or false");
  return child.node_->get<bool>();
}

std::string JsonReader::String(const std::string& key) {
  return Child(key).AsString();
}

std::string JsonReader::String(const std::string& key, const std::string& fallback) {
  return Has(key) ? String(key) : fallback;
}

std::string JsonReader::PathBelow(const std::string& key) {
  const JsonReader node = Child(key);
  const std::filesystem::path path = node.AsString();
  if (!StaysBelow(path))
    node.Fail('"' + path.string() + '"', "a relative path that does not leave its folder");
  return path.lexically_normal().string();
}

std::filesystem::path JsonReader::FileBelow(const std::string& key) {
  const std::filesystem::path name = PathBelow(key), folder = File().parent_path();
  if (const auto found = ObjectionToFile(folder, name)) {
    Child(key).Fail(*found,
                    fmt::format("a file below the folder of {}", File().filename().string()));
  }
  return folder / name;
}

std::string JsonReader::Choice(const std::string& key, const std::vector<std::string>& names) {
  const JsonReader child = Child(key);
  const std::string value = child.AsString();
  for (const std::string& name : names) {
    if (name == value) return value;
  }
  child.Fail(Describe(*child.node_), fmt::format("one of {}", JoinNames(names)));
}

Vec3d JsonReader::Vector3(const std::string& key) {
  const std::vector<double> v = Child(key).Numbers(3);
  return {v[0], v[1], v[2]};
}

Vec3d JsonReader::Vector3(const std::string& key, const Vec3d& fallback) {
  return Has(key) ? Vector3(key) : fallback;
}

void JsonReader::Schema(const std::string& name) {
  RequireObject();
  Has("$schema");
  const JsonReader child = Child("schema");
  if (child.AsString() != name) child.Fail(Describe(*child.node_), fmt::format("\"{}\"", name));
}

std::vector<std::string> JsonReader::Keys() const {
  RequireObject();
  std::vector<std::string> keys;
  for (const auto& item : node_->items()) keys.push_back(item.key());
  return keys;
}

void JsonReader::Finish() {
  RequireObject();
  const std::vector<std::string> known(read_->begin(), read_->end());
  for (const auto& item : node_->items()) {
    if (read_->count(item.key()) > 0) continue;
    const std::string nearest = NearestName(item.key(), known);
    Fail(fmt::format("the unknown key '{}'", item.key()),
         nearest.empty() ? fmt::format("one of {}", JoinNames(known))
                         : fmt::format("'{}', perhaps", nearest));
  }
}

}  // namespace retrolux
