#include "core/yaml_text.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "core/json_reader.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

Json PlainValue(std::string_view word) {
  const char* const end = word.data() + word.size();
  int64_t whole = 0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, whole);
      error == std::errc{} && rest == end)
    return whole;
  double number = 0.0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, number);
      error == std::errc{} && rest == end)
    return number;
  return std::string(word);
}

class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}

  Json Document() {
    if (!text_.starts_with("%YAML")) Fail("no %YAML");
    at_ = LineEnd();
    Next();
    if (text_.substr(at_).starts_with("---")) at_ += 3;
    Json value = Value(-1, false);
    Next();
    if (!AtEnd() && !text_.substr(at_).starts_with("...")) Fail("something left over");
    return value;
  }

 private:
  [[noreturn]] void Fail(std::string_view found) const {
    const size_t end = std::min(at_, text_.size());
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(end), '\n');
    throw InputError::At(file_, fmt::format("line {}", line), found,
                         "YAML as OpenCV's FileStorage writes it");
  }

  bool AtEnd() const { return at_ >= text_.size(); }
  char Here() const { return AtEnd() ? '\0' : text_[at_]; }
  size_t LineEnd() const { return std::min(text_.find('\n', at_), text_.size()); }
  int Column() const {
    const size_t newline = text_.substr(0, at_).rfind('\n');
    return static_cast<int>(newline == std::string_view::npos ? at_ : at_ - newline - 1);
  }
  bool IsItem() const {
    return Here() == '-' && (at_ + 1 == text_.size() || IsBlank(text_[at_ + 1]));
  }

  // To the next word.
  void Next() {
    while (!AtEnd() && (IsBlank(Here()) || Here() == '#'))
      at_ = Here() == '#' ? LineEnd() : at_ + 1;
  }

  // What belongs to a key or dash in that column of the file; null if nothing does. A list may
  // begin in the column of its key.
  Json Value(int column, bool of_key) {
    if (++depth_ > kMaxJsonDepth) Fail(fmt::format("YAML nested more than {} deep", kMaxJsonDepth));
    Next();
    if (Here() == '!') {
      while (!AtEnd() && !IsBlank(Here())) ++at_;
      Next();
    }
    Json value;
    if (AtEnd() || Column() < column + (of_key && IsItem() ? 0 : 1)) {
      // null
    } else if (Here() == '[' || Here() == '{') {
      value = InBrackets();
    } else if (IsItem()) {
      value = List(Column());
    } else if (KeyHere()) {
      value = Map(Column());
    } else {
      value = Word("");
    }
    --depth_;
    return value;
  }

  Json List(int column) {
    Json list = Json::array();
    for (; !AtEnd() && Column() == column && IsItem(); Next()) {
      ++at_;
      list.push_back(Value(column, false));
    }
    return list;
  }

  Json Map(int column) {
    Json map = Json::object();
    for (; !AtEnd() && Column() == column && !IsItem(); Next()) {
      const std::optional<std::string> key = KeyHere();
      if (!key) break;
      at_ = text_.find(':', at_) + 1;
      map[*key] = Value(column, true);
    }
    return map;
  }

  // Of "key:", where there is one.
  std::optional<std::string> KeyHere() const {
    const std::string_view line = text_.substr(at_, LineEnd() - at_);
    const size_t colon = line.find(':');
    const bool is_key = colon != std::string_view::npos && colon > 0 &&
                        (colon + 1 == line.size() || IsBlank(line[colon + 1])) &&
                        line.substr(0, colon).find_first_of("\"'#[]{},") == std::string_view::npos;
    return is_key ? std::optional<std::string>(line.substr(0, colon)) : std::nullopt;
  }

  Json InBrackets() {
    const bool is_map = Here() == '{';
    const char close = is_map ? '}' : ']';
    Json all = is_map ? Json::object() : Json::array();
    ++at_;
    for (Next(); Here() != close; Next()) {
      std::string key;
      if (is_map) {
        const size_t colon = text_.find(':', at_);
        if (colon == std::string_view::npos) Fail("a map without keys");
        key = text_.substr(at_, colon - at_);
        at_ = colon + 1;
      }
      Next();
      if (AtEnd()) Fail("the end of the file in brackets");
      Json value = Here() == '[' || Here() == '{' || Here() == '!' ? Value(-1, false) : Word(",]}");
      if (is_map) {
        all[key] = std::move(value);
      } else {
        all.push_back(std::move(value));
      }
      Next();
      if (Here() == ',') {
        ++at_;
      } else if (Here() != close) {
        Fail("a list or map without an end");
      }
    }
    ++at_;
    return all;
  }

  // A quoted text or a plain value, which ends with the line, a comment or one of `ends`.
  Json Word(std::string_view ends) {
    if (Here() == '"' || Here() == '\'') return Quoted();
    const size_t begin = at_;
    while (!AtEnd() && Here() != '\n' && Here() != '#' && ends.find(Here()) == ends.npos) ++at_;
    size_t end = at_;
    while (end > begin && IsBlank(text_[end - 1])) --end;
    if (end == begin) Fail("no value");
    return PlainValue(text_.substr(begin, end - begin));
  }

  std::string Quoted() {
    const char quote = Here();
    std::string text;
    for (++at_; Here() != quote; ++at_) {
      if (Here() == '\\' && quote == '"') ++at_;
      if (AtEnd() || Here() == '\n') Fail("a quoted text without an end");
      text += Here();
    }
    ++at_;
    return text;
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Json JsonOfYaml(const std::string& text, const std::filesystem::path& file) {
  return Parser(text, file).Document();
}

}  // namespace retrolux
