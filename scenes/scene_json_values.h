// The kinds of values that a scene file is made of, shared by the readers of its parts.
#pragma once

#include <string>

#include "core/json_reader.h"

namespace retrolux {

// "text"
std::string Quoted(const std::string& text);

// Whether there is a value under `key`. Absent and null both mean none.
bool HasSome(JsonReader& json, const std::string& key);

// A table of the data folder that exists.
std::string TableName(JsonReader& json, const std::string& key, const std::string& fallback);

// Nine numbers, row by row; Rotation demands orthonormal rows and the determinant +1 to within
// 1e-6.
Mat3d Matrix3(const JsonReader& node);
Mat3d Rotation(const JsonReader& node);

// A position or distance, each coordinate within 10 km.
Vec3d Position(JsonReader& json, const std::string& key);
Vec3d Position(JsonReader& json, const std::string& key, const Vec3d& fallback);

// Calls read(element) for each element of the array under `key`, if there is one.
template <typename Read>
void ForEach(JsonReader& json, const std::string& key, Read read) {
  if (!json.Has(key)) return;
  const JsonReader array = json.Child(key);
  for (size_t i = 0; i < array.Size(); ++i) read(array.Child(i));
}

}  // namespace retrolux
