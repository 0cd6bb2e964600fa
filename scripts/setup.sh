#!/usr/bin/env bash
# Everything that a fresh Debian 12 needs to build retrolux: packages (as root or with sudo), the npm packages of
# the report's page, configure, build. Safe to run again; does only what is missing.
#   setup.sh [PRESET [LIST...]]      lists of further packages, e.g. scripts/packages-test.txt
#   setup.sh packages [LIST...]      the packages only
set -euo pipefail
cd "$(dirname "$0")/.."

as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

# npm may be there without Debian's package (and then conflicts with it): what counts is the program.
missing=()
for package in $(grep -hvE '^ *(#|$)' scripts/packages.txt "${@:2}"); do
  case $package in
    nodejs) command -v node >/dev/null && continue ;;
    npm) command -v npm >/dev/null && continue ;;
  esac
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "setup: installing ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
fi

[ "${1:-release}" != packages ] || exit 0

page=analysis/report
if [ ! -e $page/node_modules/.package-lock.json ] || [ $page/package-lock.json -nt $page/node_modules/.package-lock.json ]; then
  echo "setup: npm packages of the report's page"
  npm ci --no-audit --no-fund --prefix $page
fi

preset=${1:-release}
cmake --preset "$preset"
cmake --build --preset "$preset"
