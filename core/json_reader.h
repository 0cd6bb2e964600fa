// Reads JSON (comments allowed) with errors that name file, place, what was found and what was
// expected. A key that nobody asked for is an error, with the nearest known name. So is nesting
// deeper than kMaxJsonDepth: whoever walks through a document may do so recursively.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/conventions.h"
#include "core/error.h"

namespace retrolux {

inline constexpr int kMaxJsonDepth = 64;

// One node of a document. Cheap to copy; copies share the record of which keys were read.
class JsonReader {
 public:
  static JsonReader FromFile(const std::filesystem::path& file);
  static JsonReader FromText(const std::string& text, const std::filesystem::path& file);

  const std::filesystem::path& File() const { return document_->file; }
  // JSON pointer of this node, "/" for the whole document.
  std::string Pointer() const { return pointer_.empty() ? "/" : pointer_; }
  [[noreturn]] void Fail(std::string_view found, std::string_view expected) const;

  // --- objects ---
  bool Has(const std::string& key);
  JsonReader Child(const std::string& key);
  double Number(const std::string& key, double min, double max);
  double Number(const std::string& key, double min, double max, double fallback);
  int Integer(const std::string& key, int min, int max);
  int Integer(const std::string& key, int min, int max, int fallback);
  bool Bool(const std::string& key, bool fallback);
  std::string String(const std::string& key);
  std::string String(const std::string& key, const std::string& fallback);
  // One of `names`; the error lists them.
  std::string Choice(const std::string& key, const std::vector<std::string>& names);
  // A path to something below a folder: not absolute, no way out by "..". Normalised.
  std::string PathBelow(const std::string& key);
  // The file of that name beside this one or below its folder (core/file_below.h).
  std::filesystem::path FileBelow(const std::string& key);
  Vec3d Vector3(const std::string& key);
  Vec3d Vector3(const std::string& key, const Vec3d& fallback);
  // The document must say "schema": name. A "$schema" key for editors may stand beside it.
  void Schema(const std::string& name);
  std::vector<std::string> Keys() const;
  // Every key of this object was read, or an error. Call it last.
  void Finish();

  // --- arrays ---
  size_t Size() const;
  JsonReader Child(size_t index) const;

  // --- this node itself ---
  bool IsObject() const { return node_->is_object(); }
  bool IsArray() const { return node_->is_array(); }
  bool IsNumber() const { return node_->is_number(); }
  bool IsString() const { return node_->is_string(); }
  double AsNumber(double min, double max) const;
  std::string AsString() const;
  // The JSON of this node as it stands in the file, without comments.
  const nlohmann::json& Raw() const { return *node_; }
  // An array of exactly `count` finite numbers.
  std::vector<double> Numbers(size_t count) const;

 private:
  struct Document {
    std::filesystem::path file;
    nlohmann::json root;
  };
  JsonReader(std::shared_ptr<const Document> document, const nlohmann::json* node,
             std::string pointer)
      : document_(std::move(document)),
        node_(node),
        pointer_(std::move(pointer)),
        read_(std::make_shared<std::set<std::string>>()) {}
  void RequireObject() const;

  std::shared_ptr<const Document> document_;
  const nlohmann::json* node_;
  std::string pointer_;
  std::shared_ptr<std::set<std::string>> read_;
};

}  // namespace retrolux
