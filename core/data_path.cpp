#include "core/data_path.h"

#include <cstdlib>
#include <vector>

#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

fs::path DataPath(const fs::path& relative) {
  for (const fs::path& part : relative) {
    if (relative.is_absolute() || part == "..") {
      throw InputError(fmt::format("{}: a path that leaves the data folder; expected one within it",
                                   relative.string()));
    }
  }
  std::vector<fs::path> roots;
  if (const char* root = std::getenv("RETROLUX_DATA")) roots.emplace_back(root);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) roots.push_back(program.parent_path().parent_path() / "share/retrolux");
  roots.emplace_back(RETROLUX_SOURCE_DATA);
  for (const fs::path& root : roots) {
    if (fs::exists(root / relative, error)) return root / relative;
  }
  throw InputError(fmt::format("{}: data file not found; expected it under {} (set RETROLUX_DATA)",
                               relative.string(), roots.front().string()));
}

}  // namespace retrolux
