// Pictures. First byte: e EXR, j JPEG, else PNG.
#include "core/image_file.h"
#include "fuzz/target.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input) {
  const Tagged tagged = TaggedInput(input);
  const char* const name = tagged.tag == 'e' ? "a.exr" : tagged.tag == 'j' ? "a.jpg" : "a.png";
  const std::filesystem::path file = FileOf(name, tagged.bytes);
  Try([&] { ReadGrey(file); });
  Try([&] { ReadExr(file); });
  Try([&] { DecodeLinearGrey(std::string(tagged.bytes), file); });
}

}  // namespace retrolux::fuzz
