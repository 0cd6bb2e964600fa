#!/usr/bin/env bash
# Builds the fuzz targets and runs each for so many seconds (60 unless told), one after the other. Ends with the first
# finding: its input is in build/fuzz/findings/.
#   fuzz.sh [SECONDS [TARGET...]]      e.g. fuzz.sh 3600 glb mesh
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=($(basename -s _fuzz.cpp -a fuzz/*_fuzz.cpp))

scripts/setup.sh packages scripts/packages-fuzz.txt
cmake --preset fuzz
cmake --build --preset fuzz

TMPDIR=$(mktemp -d)  # of the inputs as files
export TMPDIR
trap 'rm -r "$TMPDIR"' EXIT
export ASAN_OPTIONS=quarantine_size_mb=32 UBSAN_OPTIONS=print_stacktrace=1
for target in "${targets[@]}"; do
  echo "fuzz: $target, $seconds s"
  grown=build/fuzz/corpus/$target  # what the runs find worth keeping; the tree has the seeds only
  mkdir -p "$grown" build/fuzz/findings
  dictionary=fuzz/dictionaries/$target.dict
  old=fuzz/findings/$target
  build/fuzz/fuzz/"${target}"_fuzz -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/findings/"$target"- $([ -e "$dictionary" ] && echo "-dict=$dictionary") \
    "$grown" fuzz/corpus/"$target" $([ -d "$old" ] && echo "$old")
done
