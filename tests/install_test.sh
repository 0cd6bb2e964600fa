#!/usr/bin/env bash
# `cmake --install` to a prefix of its own: the program there works on the data there and on no others, and a program of
# somebody else's (examples/seen) is built with the layers and says where markers are.
#   install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -u
build=$(realpath "$1") source=$(realpath "$2")
. "$(dirname "$(realpath "$0")")/cli_checks.sh" "$build/cli/retrolux"

prefix=$work/prefix
try() { # try NAME COMMAND...
  local name=$1
  shift
  if "$@" >try.txt 2>&1; then good "$name"; else bad "$name" "$(tail -c 500 try.txt)"; fi
}
there() { if [ -s "$prefix/$1" ]; then good "installed: $1"; else bad "installed: $1" "not there"; fi; }

try "cmake --install" cmake --install "$build" --prefix "$prefix"
for file in bin/retrolux share/man/man1/retrolux.1.gz share/bash-completion/completions/retrolux \
  share/zsh/vendor-completions/_retrolux share/fish/vendor_completions.d/retrolux.fish \
  share/doc/retrolux/LICENSE share/doc/retrolux/docs/physics.md include/retrolux/core/camera_model.h; do
  there $file
done

# ---------------------------------------------------------------------------------------------------- the program
retrolux=$prefix/bin/retrolux
succeed "a scene of the installed program" scene export oval --out oval
succeed "its pictures" render oval --spp 1 --size 64x48 --out pictures
succeed "their report, with the page and the plot library" report pictures
# The source tree has this file, too.
mv "$prefix/share/retrolux/materials/data/library.json" library.json
refuse "data that are not installed are not taken from the source tree" \
  "library\.json: data file not found; expected it under $prefix/share/retrolux \(" bad render oval --spp 1 --size 64x48 --out bad
export RETROLUX_DATA=$work/ours
mkdir -p ours/materials/data
refuse "both folders that were looked into are named" "under $work/ours or $prefix/share/retrolux \(" bad \
  render oval --spp 1 --size 64x48 --out bad
mv library.json ours/materials/data
succeed "RETROLUX_DATA's file, and the installed ones" render oval --spp 1 --size 64x48 --out pictures2
same "the same pictures" pictures pictures2 camera.png
unset RETROLUX_DATA
mkdir -p elsewhere/bin && cp "$retrolux" elsewhere/bin
retrolux=$work/elsewhere/bin/retrolux
succeed "a program beside which there are no data: those of the source tree" render oval --spp 1 --size 64x48 --out pictures3
mv ours/materials/data/library.json "$prefix/share/retrolux/materials/data"

# ----------------------------------------------------------------------------------------------------- the layers
if grep -rE -- "COMPILE_OPTIONS|LINK_OPTIONS|$source" "$prefix"/lib/cmake >leaks.txt; then
  bad "how we build ourselves is nobody else's matter" "$(cat leaks.txt)"
else
  good "how we build ourselves is nobody else's matter"
fi
(cd "$prefix/include/retrolux" && find . -name '*.h' -printf '#include "%P"\n') >headers.cpp
try "all $(wc -l <headers.cpp) headers, with what consumers have" \
  g++ -std=c++20 -fsyntax-only -I "$prefix/include/retrolux" -isystem /usr/include/eigen3 headers.cpp
try "the example finds Retrolux" cmake -S "$source/examples/seen" -B seen -DCMAKE_PREFIX_PATH="$prefix"
try "the example is built" cmake --build seen
RETROLUX_DATA=$prefix/share/retrolux seen/seen >seen.txt 2>&1
# The standard marker lies at the top of the oval, straight before the camera: in the middle of its 640 x 480 pixels.
if grep -qx 'standard: at (319.50, 239.50) px, 100 % of it seen, at 0.0 degrees' seen.txt && [ "$(wc -l <seen.txt)" -eq 7 ]
then good "the example's markers"; else bad "the example's markers" "$(cat seen.txt)"; fi

finish
