// Gives every file of the folders named to the target, without libFuzzer: what was found once must
// stay mended, with any compiler. A finding ends the process.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <vector>

#include "core/atomic_file.h"
#include "fuzz/target.h"

namespace fs = std::filesystem;

namespace {

// A size that a file only claims must not be taken. (A sanitizer reserves far more for itself.)
void LimitMemory() {
#ifndef __SANITIZE_ADDRESS__
  constexpr rlim_t kMost = rlim_t{1} << 30;
  const rlimit limit{kMost, kMost};
  RETROLUX_CHECK(::setrlimit(RLIMIT_DATA, &limit) == 0, "no limit of memory");
#endif
}

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  LimitMemory();
  size_t count = 0;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) continue;  // a target without findings has no folder of them
    for (const fs::path& file : FilesIn(argv[i])) {
      fmt::print("{}\n", file.string());
      std::fflush(stdout);  // the last line names the file that ends us
      retrolux::fuzz::FuzzOne(retrolux::ReadTextFile(file));
      ++count;
    }
  }
  fmt::print("{} inputs\n", count);
  return count > 0 ? 0 : 1;
}
