// How the results of two runs differ: tables column by column, JSON value by value, pictures
// channel by channel.
#pragma once

#include "analysis/picture_difference.h"

namespace retrolux {

// A column of a table, or a list of JSON values: entry by entry.
struct ValueDifference {
  std::string name;       // of the column, or the value's JSON pointer
  int64_t entries = 0;    // compared
  int64_t different = 0;  // not the same text or number
  // Of b - a over the entries that are numbers in both.
  int64_t numbers = 0;
  double bias = 0.0, rms = 0.0, most = 0.0;
};

struct FileDifference {
  std::string file;  // relative to the folders
  bool same = false;
  std::string note;                          // "only in a", "12 rows and 14", ...; may be empty
  std::vector<ValueDifference> values;       // of tables and JSON, those that differ
  std::optional<PictureDifference> picture;  // of pictures
};

// Files of both folders and below, by name; those of the machinery (tasks/, manifest.json) and what
// tells times (run.json, report.html, which holds them) are left out. Rows of tables are compared
// in their order; tables of different columns or lengths are not compared further. Pictures that
// can't be compared differ, with the reason as note. InputError if a folder can't be read.
std::vector<FileDifference> CompareFolders(const std::filesystem::path& folder_a,
                                           const std::filesystem::path& folder_b);

}  // namespace retrolux
