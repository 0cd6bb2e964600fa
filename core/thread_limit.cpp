#include "core/thread_limit.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

namespace retrolux {

namespace fs = std::filesystem;

namespace {

std::string TextOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Version 2, "cpu.max": "QUOTA PERIOD", the quota may be "max".
std::optional<double> Quota2(const fs::path& group) {
  std::istringstream stream(TextOf(group / "cpu.max"));
  double quota = 0.0, period = 0.0;
  if (!(stream >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;
  return quota / period;
}

// Version 1: a quota of -1 is none.
std::optional<double> Quota1(const fs::path& group) {
  std::istringstream quota_stream(TextOf(group / "cpu.cfs_quota_us"));
  std::istringstream period_stream(TextOf(group / "cpu.cfs_period_us"));
  double quota = 0.0, period = 0.0;
  if (!(quota_stream >> quota) || !(period_stream >> period) || quota <= 0.0 || period <= 0.0)
    return std::nullopt;
  return quota / period;
}

template <typename Quota>
void Lower(std::optional<double>& least, const fs::path& root, fs::path group, Quota quota) {
  while (true) {
    const std::optional<double> cpus = quota(root / group.relative_path());
    if (cpus && (!least || *cpus < *least)) least = cpus;
    if (!group.has_relative_path()) return;
    group = group.parent_path();
  }
}

std::optional<int> SlurmCpus() {
  const char* text = std::getenv("SLURM_CPUS_PER_TASK");
  if (text == nullptr) return std::nullopt;
  const std::string_view view(text);
  int cpus = 0;
  const auto [end, error] = std::from_chars(view.data(), view.data() + view.size(), cpus);
  if (error != std::errc{} || end != view.data() + view.size() || cpus < 1) return std::nullopt;
  return cpus;
}

int AffinityCpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
  return CPU_COUNT(&set);
}

}  // namespace

std::string ThreadLimit::Text() const {
  return fmt::format("{} thread{} ({})", threads, threads == 1 ? "" : "s", source);
}

std::optional<double> CgroupCpus(const std::string& membership, const fs::path& root) {
  std::optional<double> least;
  std::istringstream lines(membership);
  // "0::/PATH" (version 2) or "N:CONTROLLER,CONTROLLER:/PATH"
  for (std::string line; std::getline(lines, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const fs::path group = line.substr(second + 1);
    if (controllers == ",,") Lower(least, root, group, Quota2);
    if (controllers.find(",cpu,") != std::string::npos) {
      Lower(least, root / "cpu", group, Quota1);
      Lower(least, root / "cpu,cpuacct", group, Quota1);
    }
  }
  return least;
}

ThreadLimit UsableThreads() {
  ThreadLimit limit{AffinityCpus(), "CPU affinity"};
  const auto lower = [&](int threads, const char* source) {
    if (threads < limit.threads) limit = {threads, source};
  };
  const std::optional<double> cpus = CgroupCpus(TextOf("/proc/self/cgroup"), "/sys/fs/cgroup");
  // A part of a CPU is left over rather than every thread throttled.
  if (cpus) lower(std::max(1, static_cast<int>(*cpus)), "control group's CPU limit");
  if (const std::optional<int> slurm = SlurmCpus()) lower(*slurm, "SLURM_CPUS_PER_TASK");
  return limit;
}

}  // namespace retrolux
