#!/usr/bin/env bash
# Pictures per minute of `dataset run`: one process of one thread, two of one thread (shards), one of two threads, in
# turn, ROUNDS times; then the cost of a picture by stage. On an idle machine with two cores at least.
#   bench/throughput.sh [SCENES [ROUNDS]]        default: 24 scenes of markers.json, 3 rounds
set -euo pipefail
cd "$(dirname "$0")/.."
scenes=${1:-24} rounds=${2:-3}
retrolux=$PWD/build/release/cli/retrolux
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed "s/\"scenes\": [0-9]*/\"scenes\": $scenes/" scenes/data/datasets/markers.json >"$work/config.json"
cd "$work"
# rate NAME COMMAND...: pictures per minute of wall time, from what was written.
rate() {
  local name=$1 begun
  shift
  "$retrolux" dataset plan config.json --out set >/dev/null
  begun=$(date +%s%N)
  "$@"
  local ns=$(($(date +%s%N) - begun)) pictures
  pictures=$(find set/images -name '*.png' | wc -l)
  awk -v n="$pictures" -v ns="$ns" -v name="$name" 'BEGIN { printf "%-28s %4d pictures in %6.1f s: %6.1f a minute\n", name, n, ns / 1e9, n * 60e9 / ns }'
  cp set/run.json "run-${name// /-}.json"
  rm -r set
}
one() { "$retrolux" dataset run set --threads "$1" --quiet; }
shards() {
  "$retrolux" dataset run set --shard 1/2 --threads 1 --quiet &
  "$retrolux" dataset run set --shard 2/2 --threads 1 --quiet
  wait
}
for ((i = 0; i < rounds; ++i)); do
  rate "1 process of 1 thread" one 1
  rate "2 processes of 1 thread" shards
  rate "1 process of 2 threads" one 2
done
echo "ms a picture, 1 process of 1 thread:"
grep -A8 '"cost_ms"' run-1-process-of-1-thread.json
