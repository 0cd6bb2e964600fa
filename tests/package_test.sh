#!/usr/bin/env bash
# The Debian package of the program: made, looked at, unpacked and used.
#   package_test.sh BUILD_FOLDER
set -u
build=$(realpath "$1")
. "$(dirname "$(realpath "$0")")/cli_checks.sh" "$build/cli/retrolux"

cpack -G DEB --config "$build/CPackConfig.cmake" -B made -D CPACK_COMPONENTS_ALL=runtime >cpack.txt 2>&1
deb=$(find made -maxdepth 1 -name 'retrolux_*_*.deb')
[ -s "$deb" ] || { bad "cpack" "$(tail -c 500 cpack.txt)"; finish; exit 1; }
dpkg-deb -x "$deb" unpacked && dpkg-deb -c "$deb" >list.txt && dpkg-deb -f "$deb" >control.txt

control() { if grep -qE -- "$2" control.txt; then good "$1"; else bad "$1" "$(cat control.txt)"; fi; }
none() { if [ -z "$2" ]; then good "$1"; else bad "$1" "$2"; fi; }
control "libraries it needs" '^Depends: .*libc6 \(>= .*libembree3-3.*libopenimageio2'
control "maintainer" '^Maintainer: .+ <.+@.+>$'
control "section" '^Section: science$'
control "description" '^Description: .+'
none "all belongs to root" "$(awk '$2 != "root/root"' list.txt)"
none "nobody else may write" "$(awk '$1 !~ /^.rw[x-]r-[x-]r-[x-]$/' list.txt)"
none "nothing but usr" "$(grep -vE ' \./(usr/.*)?$' list.txt)"
none "no libraries and headers for others" "$(grep -E '\.a$|\.h$' list.txt)"
for file in man/man1/retrolux.1.gz doc/retrolux/copyright retrolux/analysis/report/node_modules/plotly.js-dist-min/LICENSE; do
  none "there: $file" "$([ -s unpacked/usr/share/$file ] || echo missing)"
done
none "the manual is packed" "$(gzip -t unpacked/usr/share/man/man1/retrolux.1.gz 2>&1)"
none "no symbols" "$(file unpacked/usr/bin/retrolux | grep -v ' stripped$')"

retrolux=$work/unpacked/usr/bin/retrolux
succeed "validate" validate --only projection,filter
succeed "pictures" render oval --spp 1 --size 64x48 --out pictures
succeed "their report" report pictures
none "the report has the plot library" "$(grep -q 'plotly\.js v' pictures/report.html || echo missing)"

finish
