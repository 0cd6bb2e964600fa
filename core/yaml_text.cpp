#include "core/yaml_text.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <sstream>
#include <vector>

#include "core/json_reader.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

Json PlainValue(const std::string& word) {
  const char* const end = word.data() + word.size();
  int64_t whole = 0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, whole);
      error == std::errc{} && rest == end)
    return whole;
  double number = 0.0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, number);
      error == std::errc{} && rest == end)
    return number;
  return word;
}

// Builds the JSON as the library reads on: no tree of its own that could be expanded or nested
// without end.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(const std::filesystem::path& file) : file_(file) {}

  const Json& Result() const { return result_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { Add(mark, nullptr); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { Fail(mark, "an alias"); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    if (AwaitsKey()) {
      key_.back() = value;
      has_key_.back() = true;
    } else {
      Add(mark, tag == "?" ? PlainValue(value) : Json(value));  // "!": in quotes
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Open(mark, Json::array());
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Open(mark, Json::object());
  }
  void OnMapEnd() override { Close(); }

 private:
  [[noreturn]] void Fail(const YAML::Mark& mark, const std::string& found) const {
    throw InputError::At(file_, fmt::format("line {}", mark.line + 1), found,
                         "YAML as OpenCV's FileStorage writes it");
  }

  bool AwaitsKey() const { return !open_.empty() && open_.back()->is_object() && !has_key_.back(); }

  // The place where the value now is.
  Json* Add(const YAML::Mark& mark, Json value) {
    if (AwaitsKey()) Fail(mark, "a key that is no text");
    if (open_.empty()) {
      result_ = std::move(value);
      return &result_;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    has_key_.back() = false;
    return &((*open_.back())[key_.back()] = std::move(value));
  }

  void Open(const YAML::Mark& mark, Json empty) {
    if (open_.size() >= kMaxJsonDepth)
      Fail(mark, fmt::format("YAML nested more than {} deep", kMaxJsonDepth));
    open_.push_back(Add(mark, std::move(empty)));
    key_.emplace_back();
    has_key_.push_back(false);
  }

  void Close() {
    open_.pop_back();
    key_.pop_back();
    has_key_.pop_back();
  }

  const std::filesystem::path& file_;
  Json result_;
  // From the outermost in. A place stays where it is while its parent waits for its end.
  std::vector<Json*> open_;
  std::vector<std::string> key_;
  std::vector<bool> has_key_;
};

}  // namespace

Json JsonOfYaml(const std::string& text, const std::filesystem::path& file) {
  Builder builder(file);
  std::istringstream stream(text);
  try {
    YAML::Parser(stream).HandleNextDocument(builder);
  } catch (const YAML::Exception& error) {
    throw InputError::At(file, fmt::format("line {}", error.mark.line + 1), error.msg,
                         "YAML as OpenCV's FileStorage writes it");
  }
  return builder.Result();
}

}  // namespace retrolux
