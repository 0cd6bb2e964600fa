#include "scenes/ply_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "core/error.h"

namespace retrolux {

namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };

struct NumberType {
  size_t size = 0;
  enum { kSigned, kUnsigned, kReal } kind = kReal;
};

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> list_count;  // of a list: how its length is given
};

struct Element {
  std::string name;
  size_t count = 0;
  std::vector<Property> properties;

  std::optional<size_t> Find(const std::string& property) const {
    for (size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return std::nullopt;
  }
};

struct Header {
  Format format = Format::kAscii;
  std::vector<Element> elements;
  size_t size = 0;  // bytes
};

std::optional<NumberType> TypeNamed(const std::string& name) {
  if (name == "char" || name == "int8") return NumberType{1, NumberType::kSigned};
  if (name == "uchar" || name == "uint8") return NumberType{1, NumberType::kUnsigned};
  if (name == "short" || name == "int16") return NumberType{2, NumberType::kSigned};
  if (name == "ushort" || name == "uint16") return NumberType{2, NumberType::kUnsigned};
  if (name == "int" || name == "int32") return NumberType{4, NumberType::kSigned};
  if (name == "uint" || name == "uint32") return NumberType{4, NumberType::kUnsigned};
  if (name == "float" || name == "float32") return NumberType{4, NumberType::kReal};
  if (name == "double" || name == "float64") return NumberType{8, NumberType::kReal};
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, const std::string& bytes)
      : file_(file), bytes_(bytes) {}

  Header Read() {
    if (NextLine() != "ply") Fail("'ply'");
    while (true) {
      std::istringstream words(NextLine());
      std::string word;
      words >> word;
      if (word == "end_header") break;
      if (word == "format") {
        ReadFormat(words);
      } else if (word == "element") {
        ReadElement(words);
      } else if (word == "property") {
        ReadProperty(words);
      } else if (word != "comment" && word != "obj_info") {
        Fail("format, comment, element, property or end_header");
      }
    }
    if (!has_format_) Fail("a line 'format' before end_header");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  std::string NextLine() {
    ++number_;
    const size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos) {
      line_ = "the end of the file";
      Fail("end_header before it");
    }
    line_ = bytes_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.pop_back();
    at_ = end + 1;
    return line_;
  }

  void ReadFormat(std::istringstream& words) {
    std::string name, version;
    words >> name >> version;
    if (name == "ascii") {
      header_.format = Format::kAscii;
    } else if (name == "binary_little_endian") {
      header_.format = Format::kLittleEndian;
    } else if (name == "binary_big_endian") {
      header_.format = Format::kBigEndian;
    } else {
      Fail("ascii, binary_little_endian or binary_big_endian");
    }
    has_format_ = true;
  }

  void ReadElement(std::istringstream& words) {
    Element element;
    std::string count;
    words >> element.name >> count;
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc{} || end != count.data() + count.size()) Fail("element NAME COUNT");
    for (const Element& other : header_.elements) {
      if (other.name == element.name) Fail("each element once");
    }
    header_.elements.push_back(std::move(element));
  }

  void ReadProperty(std::istringstream& words) {
    Property property;
    std::string type;
    words >> type;
    if (type == "list") {
      words >> type;
      property.list_count = TypeNamed(type);
      if (!property.list_count || property.list_count->kind == NumberType::kReal)
        Fail("an integer type for the length of the list");
      words >> type;
    }
    words >> property.name;
    const std::optional<NumberType> known = TypeNamed(type);
    if (!known || property.name.empty()) Fail("property [list TYPE] TYPE NAME");
    property.type = *known;
    if (header_.elements.empty()) Fail("an element before its properties");
    header_.elements.back().properties.push_back(std::move(property));
  }

  [[noreturn]] void Fail(const std::string& expected) const {
    throw InputError::At(file_, fmt::format("line {}", number_),
                         fmt::format("'{}'", line_.substr(0, 60)), expected);
  }

  const std::filesystem::path& file_;
  const std::string& bytes_;
  Header header_;
  std::string line_;
  size_t at_ = 0, number_ = 0;
  bool has_format_ = false;
};

template <typename T>
double Decode(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), sizeof(T));
  return static_cast<double>(value);
}

// Takes numbers from the body, one after the other.
class Numbers {
 public:
  Numbers(const std::filesystem::path& file, const std::string& bytes, const Header& header)
      : file_(file), bytes_(bytes), format_(header.format), at_(header.size) {}

  double Next(const NumberType& type, const std::string& element, size_t index) {
    return format_ == Format::kAscii ? NextWord(element, index) : NextBinary(type, element, index);
  }

  // Each number takes a byte at least: the body can't hold more.
  size_t BytesLeft() const { return bytes_.size() - at_; }

  [[noreturn]] void Fail(const std::string& element, size_t index, const std::string& found,
                         const std::string& expected) const {
    throw InputError::At(file_, fmt::format("{} {}", element, index), found, expected);
  }

 private:
  double NextWord(const std::string& element, size_t index) {
    constexpr const char* kBlanks = " \t\r\n";
    at_ = std::min(bytes_.find_first_not_of(kBlanks, at_), bytes_.size());
    const size_t end = std::min(bytes_.find_first_of(kBlanks, at_), bytes_.size());
    if (at_ == end) Fail(element, index, "the end of the file", "numbers");
    double number = 0.0;
    const auto [rest, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + end, number);
    if (error != std::errc{} || rest != bytes_.data() + end)
      Fail(element, index, fmt::format("'{}'", bytes_.substr(at_, std::min<size_t>(end - at_, 40))),
           "a number");
    at_ = end;
    return number;
  }

  double NextBinary(const NumberType& type, const std::string& element, size_t index) {
    if (BytesLeft() < type.size) Fail(element, index, "the end of the file", "numbers");
    const char* const bytes = bytes_.data() + at_;
    at_ += type.size;
    const bool swap = (format_ == Format::kBigEndian) != (std::endian::native == std::endian::big);
    if (type.kind == NumberType::kReal)
      return type.size == 4 ? Decode<float>(bytes, swap) : Decode<double>(bytes, swap);
    const bool is_signed = type.kind == NumberType::kSigned;
    switch (type.size) {
      case 1:
        return is_signed ? Decode<int8_t>(bytes, swap) : Decode<uint8_t>(bytes, swap);
      case 2:
        return is_signed ? Decode<int16_t>(bytes, swap) : Decode<uint16_t>(bytes, swap);
      default:
        return is_signed ? Decode<int32_t>(bytes, swap) : Decode<uint32_t>(bytes, swap);
    }
  }

  const std::filesystem::path& file_;
  const std::string& bytes_;
  const Format format_;
  size_t at_;
};

class BodyReader {
 public:
  BodyReader(const std::filesystem::path& file, const std::string& bytes, const Header& header)
      : file_(file), header_(header), numbers_(file, bytes, header) {}

  TriangleMesh Read() {
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        ReadVertices(element);
      } else if (element.name == "face") {
        ReadFaces(element);
      } else {
        for (size_t i = 0; i < Count(element); ++i) ReadRow(element, i);
      }
    }
    CheckIndices();
    return std::move(mesh_);
  }

 private:
  // The values of each property; one, or those of a list.
  using Row = std::vector<std::vector<double>>;

  // Of an element without properties nothing is in the file, however many there are said to be.
  static size_t Count(const Element& element) {
    return element.properties.empty() ? 0 : element.count;
  }

  Row ReadRow(const Element& element, size_t index) {
    Row row;
    for (const Property& property : element.properties) {
      double count = 1.0;
      if (property.list_count) {
        count = numbers_.Next(*property.list_count, element.name, index);
        if (!(count >= 0.0) || count != std::floor(count) ||
            count > static_cast<double>(numbers_.BytesLeft())) {
          numbers_.Fail(element.name, index, fmt::format("a list of {}", count),
                        "a length that the file can hold");
        }
      }
      std::vector<double>& values = row.emplace_back();
      for (size_t i = 0; i < static_cast<size_t>(count); ++i)
        values.push_back(numbers_.Next(property.type, element.name, index));
    }
    return row;
  }

  // Places of three plain properties, if all are there.
  static std::optional<std::array<size_t, 3>> FindThree(const Element& element,
                                                        const std::array<const char*, 3>& names) {
    std::array<size_t, 3> places{};
    for (size_t i = 0; i < 3; ++i) {
      const std::optional<size_t> place = element.Find(names[i]);
      if (!place || element.properties[*place].list_count) return std::nullopt;
      places[i] = *place;
    }
    return places;
  }

  static Vec3f Vector(const Row& row, const std::array<size_t, 3>& places) {
    return Vec3d(row[places[0]][0], row[places[1]][0], row[places[2]][0]).cast<float>();
  }

  void ReadVertices(const Element& element) {
    const auto position = FindThree(element, {"x", "y", "z"});
    const auto normal = FindThree(element, {"nx", "ny", "nz"});
    if (!position)
      throw InputError::At(file_, "element vertex", "no properties x y z", "coordinates");
    for (size_t i = 0; i < element.count; ++i) {
      const Row row = ReadRow(element, i);
      mesh_.positions.push_back(Vector(row, *position));
      if (normal) mesh_.normals.push_back(Vector(row, *normal));
    }
  }

  void ReadFaces(const Element& element) {
    std::optional<size_t> list = element.Find("vertex_indices");
    if (!list) list = element.Find("vertex_index");
    if (!list || !element.properties[*list].list_count)
      throw InputError::At(file_, "element face", "no list vertex_indices", "the corners of faces");
    for (size_t i = 0; i < element.count; ++i) {
      const std::vector<double> corners = ReadRow(element, i)[*list];
      for (const double corner : corners) {
        if (!(corner >= 0.0) || corner > 4294967295.0 || corner != std::floor(corner))
          numbers_.Fail("face", i, fmt::format("vertex {}", corner), "the number of a vertex");
      }
      for (size_t k = 2; k < corners.size(); ++k) {
        mesh_.triangles.push_back({static_cast<uint32_t>(corners[0]),
                                   static_cast<uint32_t>(corners[k - 1]),
                                   static_cast<uint32_t>(corners[k])});
      }
    }
  }

  // At the end, because faces may come before vertices.
  void CheckIndices() const {
    for (const auto& triangle : mesh_.triangles) {
      const uint32_t largest = *std::max_element(triangle.begin(), triangle.end());
      if (largest >= mesh_.positions.size()) {
        throw InputError::At(file_, "element face", fmt::format("vertex {}", largest),
                             fmt::format("one below {}", mesh_.positions.size()));
      }
    }
  }

  const std::filesystem::path& file_;
  const Header& header_;
  Numbers numbers_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh ReadPly(const std::filesystem::path& file, const std::string& bytes) {
  const Header header = HeaderReader(file, bytes).Read();
  return BodyReader(file, bytes, header).Read();
}

}  // namespace retrolux
