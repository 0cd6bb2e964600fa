#include "cli/task_choice.h"

#include <charconv>
#include <optional>
#include <vector>

#include "core/error.h"

namespace retrolux::cli {

namespace {

std::optional<size_t> Whole(std::string_view text) {
  size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct TaskSpan {
  size_t first, last;
};

std::optional<TaskSpan> Span(std::string_view text) {
  const size_t dash = text.find('-');
  const auto first = Whole(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : Whole(text.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return TaskSpan{*first, *last};
}

}  // namespace

std::function<bool(size_t)> ParseShard(const std::string& text) {
  const size_t slash = text.find('/');
  const auto shard = Whole(text.substr(0, slash));
  const auto shards =
      slash == std::string::npos ? std::nullopt : Whole(std::string_view(text).substr(slash + 1));
  if (!shard || !shards || *shard < 1 || *shard > *shards) {
    throw InputError(fmt::format("--shard {}: expected i/n with i from 1 to n, e.g. 2/8", text));
  }
  return [i = *shard - 1, n = *shards](size_t task) { return task % n == i; };
}

std::function<bool(size_t)> ParseTasks(const std::string& text, size_t tasks) {
  std::vector<TaskSpan> spans;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const auto span = Span(std::string_view(text).substr(from, comma - from));
    if (!span) {
      throw InputError(
          fmt::format("--tasks {}: expected numbers from 0 and ranges, e.g. 2,4,10-20", text));
    }
    if (span->last >= tasks) {
      throw InputError(fmt::format("--tasks {}: there are {}; expected numbers from 0 to {}", text,
                                   tasks, tasks - 1));
    }
    spans.push_back(*span);
    from = comma + 1;
  }
  return [spans](size_t task) {
    for (const TaskSpan& span : spans) {
      if (task >= span.first && task <= span.last) return true;
    }
    return false;
  };
}

}  // namespace retrolux::cli
