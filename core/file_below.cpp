#include "core/file_below.h"

#include <fmt/format.h>

namespace retrolux {

namespace fs = std::filesystem;

bool StaysBelow(const fs::path& name) {
  return !name.empty() && !name.is_absolute() && *name.lexically_normal().begin() != "..";
}

std::optional<std::string> ObjectionToFile(const fs::path& folder, const fs::path& name) {
  const std::string quoted = '"' + name.string() + '"';
  if (!StaysBelow(name)) return fmt::format("a path {} that leaves the folder", quoted);
  std::error_code error;
  const fs::path file = fs::canonical(folder / name, error);
  if (error) return fmt::format("no file {}", quoted);
  const fs::path root = fs::canonical(folder.empty() ? "." : folder, error);
  if (error || !StaysBelow(file.lexically_relative(root)))
    return fmt::format("a link {} that leaves the folder", quoted);
  if (!fs::is_regular_file(file, error)) return fmt::format("{}, no ordinary file", quoted);
  return std::nullopt;
}

}  // namespace retrolux
