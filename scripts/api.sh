#!/usr/bin/env bash
# The API reference by Doxygen, from the comments of the headers (docs/Doxyfile): api.sh [FOLDER], default build/api.
# A warning is an error.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-build/api}
mkdir -p "$out"
{ cat docs/Doxyfile; printf 'OUTPUT_DIRECTORY = "%s"\n' "$out"; } | doxygen -
echo "$out/html/index.html"
