#include "cli/job_files.h"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// For schedulers, whose names have no spaces or quotes.
std::string PlainName(std::string name) {
  for (char& c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  return name.substr(0, 100);
}

fs::path WriteScript(const fs::path& file, const std::string& text) {
  WriteTextFile(file, text);
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add);
  return file;
}

// Slurm copies a script before it runs it: the folder is the one that the job was submitted in.
// Time and memory limits, partition and account are given to submit.sh, which hands them on.
std::vector<fs::path> WriteSlurm(const JobPlan& plan, const fs::path& folder) {
  const std::string shard = fmt::format(
      R"SH(#!/bin/bash
#SBATCH --job-name={0}
#SBATCH --array=1-{1}
#SBATCH --cpus-per-task={2}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=jobs/slurm/shard-%a.log
# One shard. May be killed and run again at any time: what is done is kept.
exec "${{RETROLUX:-retrolux}}" dataset run . --shard "$SLURM_ARRAY_TASK_ID/{1}" --progress json
)SH",
      PlainName(plan.name), plan.shards, plan.threads);
  const std::string merge = fmt::format(
      R"SH(#!/bin/bash
#SBATCH --job-name={}-merge
#SBATCH --cpus-per-task=1
#SBATCH --open-mode=append
#SBATCH --output=jobs/slurm/merge.log
# After all shards, however they ended: checks every result and writes dataset.json and the card, or
# says what is missing (exit code 4).
exec "${{RETROLUX:-retrolux}}" dataset merge . --progress json
)SH",
      PlainName(plan.name));
  const std::string submit =
      R"SH(#!/bin/bash
# Submits the shards and, after them, the merge; arguments go to both, e.g. --partition=night --time=2:00:00.
# To be run again after a failure: only what is missing is done.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/../.."
shards=$(sbatch --parsable --chdir="$PWD" "$@" jobs/slurm/shard.sh)
merge=$(sbatch --parsable --chdir="$PWD" --dependency="afterany:${shards%%;*}" "$@" jobs/slurm/merge.sh)
echo "shards: job ${shards%%;*}; merge: job ${merge%%;*}; logs: $PWD/jobs/slurm"
)SH";
  return {WriteScript(folder / "submit.sh", submit), WriteScript(folder / "shard.sh", shard),
          WriteScript(folder / "merge.sh", merge)};
}

Json Action(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {"dataset"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return {{"actions", {{"onRun", {{"command", "{{Param.Retrolux}}"}, {"args", all}}}}}};
}

// Open Job Description, template schemas 2023-09. In the dataset's folder itself: the default of a
// PATH must not lead out of the template's folder.
std::vector<fs::path> WriteOpenJd(const JobPlan& plan) {
  const Json dataset = {
      {"name", "Dataset"},   {"type", "PATH"}, {"objectType", "DIRECTORY"},
      {"dataFlow", "INOUT"}, {"default", "."}, {"description", "The planned dataset"}};
  const Json program = {{"name", "Retrolux"}, {"type", "STRING"}, {"default", "retrolux"}};
  const Json vcpus = {{"amounts", {{{"name", "amount.worker.vcpu"}, {"min", plan.threads}}}}};
  const std::string of = fmt::format("{{{{Task.Param.Shard}}}}/{}", plan.shards);
  const Json shard = {
      {"name", "Shard"}, {"type", "INT"}, {"range", fmt::format("1-{}", plan.shards)}};
  const Json render = {{"name", "Render"},
                       {"hostRequirements", vcpus},
                       {"parameterSpace", {{"taskParameterDefinitions", {shard}}}},
                       {"script", Action({"run", "{{Param.Dataset}}", "--shard", of, "--threads",
                                          std::to_string(plan.threads), "--progress", "json"})}};
  const Json merge = {{"name", "Merge"},
                      {"dependencies", {{{"dependsOn", "Render"}}}},
                      {"script", Action({"merge", "{{Param.Dataset}}", "--progress", "json"})}};
  const Json job = {{"specificationVersion", "jobtemplate-2023-09"},
                    {"name", PlainName(plan.name)},
                    {"parameterDefinitions", {dataset, program}},
                    {"steps", {render, merge}}};
  WriteTextFile(plan.folder / "template.json", job.dump(2) + "\n");
  return {plan.folder / "template.json"};
}

std::vector<fs::path> WriteParallel(const JobPlan& plan, const fs::path& folder) {
  const std::string run = fmt::format(
      R"SH(#!/bin/bash
# All shards on this machine by GNU parallel, as many at once as fit, then the merge; arguments go to parallel,
# e.g. --jobs 4 or --sshloginfile hosts. To be run again after a failure: only what is missing is done.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/../.."
command -v parallel >/dev/null || {{ echo "GNU parallel is not installed" >&2; exit 2; }}
jobs=$(($(nproc) / {1})); [ "$jobs" -ge 1 ] || jobs=1
# It gives its arguments to a shell, and begins elsewhere on other hosts. Its exit code up to 101 counts shards that
# failed, of which the merge tells; beyond, it could not do its own work.
seq {0} | parallel --jobs "$jobs" --halt never --workdir "$PWD" "$@" \
  "$(printf %q "${{RETROLUX:-retrolux}}")" dataset run . --shard {{}}/{0} --threads {1} || [ $? -le 101 ]
exec "${{RETROLUX:-retrolux}}" dataset merge .
)SH",
      plan.shards, plan.threads);
  return {WriteScript(folder / "run.sh", run)};
}

}  // namespace

std::vector<fs::path> WriteJobFiles(const JobPlan& plan, const std::string& engine) {
  if (engine == "openjd") return WriteOpenJd(plan);
  const fs::path folder = plan.folder / "jobs" / engine;
  EnsureWritableFolder(folder);
  if (engine == "slurm") return WriteSlurm(plan, folder);
  return WriteParallel(plan, folder);
}

}  // namespace retrolux::cli
