// Which compression for EXR and PNG? Writes a picture of ours with each and prints time and size,
// so that the choices in core/image_file.cpp can be judged on pictures that matter.
//   compression_bench FILE.exr FILE.png
// Files go to TMPDIR. Times are the least of five, ms of one thread, writing included, without
// sync.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Picture {
  OIIO::ImageSpec spec;
  std::vector<char> pixels;  // in the file's own types
};

Picture Read(const std::string& file) {
  const auto input = OIIO::ImageInput::open(file);
  if (!input) {
    fmt::print(stderr, "compression_bench: {}\n", OIIO::geterror());
    std::exit(2);
  }
  Picture picture{input->spec(), std::vector<char>(input->spec().image_bytes(true))};
  input->read_image(0, 0, 0, -1, OIIO::TypeUnknown, picture.pixels.data());
  return picture;
}

double WriteOnce(const Picture& picture, const OIIO::ImageSpec& spec, const std::string& file) {
  const auto start = std::chrono::steady_clock::now();
  const auto output = OIIO::ImageOutput::create(file);
  output->open(file, spec);
  output->write_image(OIIO::TypeUnknown, picture.pixels.data());
  output->close();
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Measure(const Picture& picture, const OIIO::ImageSpec& spec, const std::string& name,
             const std::string& extension) {
  const fs::path file = fs::temp_directory_path() / ("retrolux_compression." + extension);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) least = std::min(least, WriteOnce(picture, spec, file.string()));
  fmt::print("{:28} {:8.1f} ms {:10.1f} KiB\n", name, least,
             static_cast<double>(fs::file_size(file)) / 1024.0);
  fs::remove(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: compression_bench FILE.exr FILE.png\n");
    return 2;
  }
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", 1);
  const Picture exr = Read(argv[1]), png = Read(argv[2]);
  for (const char* compression : {"none", "rle", "zips", "zip:1", "zip:4", "zip:9", "piz"}) {
    OIIO::ImageSpec spec = exr.spec;
    spec.attribute("compression", compression);
    Measure(exr, spec, fmt::format("EXR, {} channels, {}", spec.nchannels, compression), "exr");
  }
  for (const int level : {0, 1, 3, 6, 9}) {
    for (const int filter : {0, 8, 16, 32, 64, 248}) {  // PNG_NO_FILTERS, NONE, SUB, UP, AVG, ALL
      OIIO::ImageSpec spec = png.spec;
      spec.attribute("png:compressionLevel", level);
      spec.attribute("png:filter", filter);
      Measure(png, spec, fmt::format("PNG, level {}, filters {}", level, filter), "png");
    }
  }
  return 0;
}
