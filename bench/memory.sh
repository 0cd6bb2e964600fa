#!/usr/bin/env bash
# Memory of `dataset run` over thousands of tasks: samples the resident set of the process while it works, prints
# done,seconds,rss_mib as CSV and draws it.
#   bench/memory.sh OUT.svg [SCENES]        default: 4,000 scenes of one small picture
set -euo pipefail
out=$(realpath -m "$1") scenes=${2:-4000}
cd "$(dirname "$0")/.."
retrolux=$PWD/build/release/cli/retrolux
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >config.json <<END
{"schema": "retrolux/dataset-1", "name": "memory", "licence": "CC0-1.0", "scenes": $scenes, "spp": 2,
 "splits": {"train": 1}, "masks": [{"mesh": "oval"}, {"mesh": "face"}],
 "views": [{"kind": "free", "cameras": 1, "distance_mm": [1200, 1600], "incidence_deg": [0, 50]}],
 "markers": {"identifiable": 6, "standard": 4}, "recording": {"size_px": [160, 120], "sensor": "default"}}
END
"$retrolux" dataset plan config.json --out set >/dev/null
"$retrolux" dataset run set --quiet &
pid=$!
begun=$(date +%s%N)
echo "done,seconds,rss_mib" | tee samples.csv
while kill -0 $pid 2>/dev/null; do
  child=$(pgrep -P $pid || true)
  kib=$(awk '/VmRSS/ {print $2}' "/proc/${child:-$pid}/status" 2>/dev/null || true)
  tasks=$(find set/tasks -name '[0-9a-f]*.json' | wc -l)
  [ -z "$kib" ] || awk -v d="$tasks" -v ns=$(($(date +%s%N) - begun)) -v k="$kib" 'BEGIN { printf "%d,%.1f,%.1f\n", d, ns / 1e9, k / 1024 }' | tee -a samples.csv
  sleep 1
done
wait $pid
awk -F, -v scenes="$scenes" '
  NR > 1 { n++; x[n] = $1; y[n] = $3; if ($3 > top) top = $3 }
  END {
    w = 720; h = 300; l = 60; b = 40; max = 100 * (int(top / 100) + 1)
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n", w, h
    for (i = 0; i <= 4; ++i) {
      py = h - b - i * (h - b - 20) / 4; px = l + i * (w - l - 20) / 4
      printf "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%d</text>\n", l, w - 20, py, py, l - 6, py + 4, i * max / 4
      printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%d</text>\n", px, h - b + 18, i * scenes / 4
    }
    printf "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">scenes done</text><text x=\"14\" y=\"16\">resident memory, MiB</text>\n<polyline fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\" points=\"", (w + l) / 2, h - 6
    for (i = 1; i <= n; ++i) printf "%.1f,%.1f ", l + x[i] * (w - l - 20) / scenes, h - b - y[i] * (h - b - 20) / max
    printf "\"/>\n</svg>\n"
  }' samples.csv >"$out"
