// Jobs of existing engines that run a dataset's shards: files below DIR/jobs/, or
// DIR/template.json, to be submitted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace retrolux::cli {

struct JobPlan {
  std::string name;
  std::filesystem::path folder;  // of the dataset
  int shards = 1;
  int threads = 1;  // of each
};

// `engine`: slurm (submit.sh, shard.sh, merge.sh), openjd (template.json, Open Job Description
// 2023-09) or parallel (run.sh, GNU parallel on this machine). Returns what was written, the file
// to begin with first. The files find the dataset from where they lie; moving the folder breaks
// nothing. They call $RETROLUX, or `retrolux` of the PATH.
std::vector<std::filesystem::path> WriteJobFiles(const JobPlan& plan, const std::string& engine);

}  // namespace retrolux::cli
