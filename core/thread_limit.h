// How many threads this process should work on: not what the machine has, but what it was given.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace retrolux {

struct ThreadLimit {
  int threads = 1;
  std::string source;  // what says so

  std::string Text() const;  // "2 threads (CPU affinity)"
};

// The smallest of the processors that the process may run on (sched_getaffinity), the CPU time that
// its control group is allowed, and SLURM_CPUS_PER_TASK.
ThreadLimit UsableThreads();

// CPUs' worth of time that a process of these control groups may use, nothing if there is no limit.
// `membership` is the text of /proc/self/cgroup, `root` the mount point of the hierarchies.
// Versions 2 (cpu.max) and 1 (cpu.cfs_quota_us); the smallest of the group and those above it.
std::optional<double> CgroupCpus(const std::string& membership, const std::filesystem::path& root);

}  // namespace retrolux
