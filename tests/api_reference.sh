#!/usr/bin/env bash
# Doxygen reads all headers without a warning, and what the comments say arrives in the pages: a class, a field that
# is documented behind its declaration, a file.
#   api_reference.sh
set -euo pipefail
top=$(realpath "$(dirname "$0")/..")
command -v doxygen >/dev/null || { echo "doxygen: not found; expected the packages of scripts/packages-test.txt" >&2; exit 1; }
out=$(mktemp -d "${TMPDIR:-/tmp}/retrolux_api.XXXXXX")
trap 'rm -rf "$out"' EXIT
"$top/scripts/api.sh" "$out"

holds() { grep -q -- "$2" "$out/html/$1" || { echo "FAIL  $1: no '$2'" >&2; exit 1; }; echo "ok    $1: $2"; }
holds index.html 'The conventions of the whole project'
holds classretrolux_1_1Bsdf.html 'Scattering at an opaque surface'
holds structretrolux_1_1RobustOptions.html 'whether dark shapes on bright ground are looked for, too'
holds robust_8h.html 'every closed bright or dark outline is compared'
