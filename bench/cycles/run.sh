#!/usr/bin/env bash
# Cross-check with Blender's Cycles: bench/cycles/run.sh [OUT] [options, see cross_check.py --help]
# Needs Debian's packages blender, python3-numpy and python3-openimageio, installed by hand.
# RETROLUX names the program, PYTHON an interpreter that has both modules.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${PYTHON:-/usr/bin/python3}
retrolux=${RETROLUX:-$here/../../build/release/cli/retrolux}
out=$here/../../out/cycles
if [[ $# -gt 0 && $1 != -* ]]; then
  out=$1
  shift
fi
if ! command -v blender >/dev/null || ! "$python" -c "import numpy, OpenImageIO" 2>/dev/null; then
  echo "blender, numpy or OpenImageIO not found; expected the packages of Debian 12:" >&2
  echo "  apt-get install --no-install-recommends blender python3-numpy python3-openimageio" >&2
  exit 2
fi
if [[ ! -x $retrolux ]]; then
  echo "$retrolux not found; expected the program (scripts/setup.sh builds it, or set RETROLUX)" >&2
  exit 2
fi
export PYTHONDONTWRITEBYTECODE=1
exec "$python" "$here/cross_check.py" --retrolux "$retrolux" --out "$out" "$@"
