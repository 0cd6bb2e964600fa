#!/usr/bin/env bash
# Set-up and all tests in one command. Arguments go to ctest, e.g. `scripts/test.sh -L fast`.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh release scripts/packages-test.txt
ctest --preset release -j "$(nproc)" "$@"
