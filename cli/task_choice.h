// Which tasks of a long run one process does.
#pragma once

#include <functional>
#include <string>

namespace retrolux::cli {

// "i/n", i from 1: every n-th task, so that shards take equally long. InputError.
std::function<bool(size_t)> ParseShard(const std::string& text);

// "2,4,10-20": some of `tasks` by number, from 0, ranges with both ends. InputError.
std::function<bool(size_t)> ParseTasks(const std::string& text, size_t tasks);

}  // namespace retrolux::cli
