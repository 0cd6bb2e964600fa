#!/usr/bin/env bash
# view, diff and report as a user runs them, and their pages in a browser (screenshots beside them).
#   pages_test.sh RETROLUX_BINARY SCREENSHOT_FOLDER
set -u
screenshots=${2:?usage: pages_test.sh RETROLUX_BINARY SCREENSHOT_FOLDER}
set -- "$1"
. "$(dirname "$(realpath "$0")")/cli_checks.sh"

# whole NAME PAGE: the page is whole in a browser.
whole() {
  local name=$1 page=$2
  if "$tests/report_page.sh" "$page" "$screenshots/$(printf %s "${page%.html}" | tr -c "a-z0-9" "-")" >page.txt 2>&1; then good "$name"
  else bad "$name" "$(head -5 page.txt | tr '\n' '|')"; fi
}
code_is() {
  local name=$1 expected=$2 code
  shift 2
  run "$@"
  code=$?
  [ $code -eq "$expected" ] && good "$name" || bad "$name" "exit code $code, not $expected: $(head -c 300 stderr.txt)"
}

shot=(render oval --size 160x120 --spp 8)
for seed in 1 2; do succeed "render, seed $seed" "${shot[@]}" --seed $seed --out shot$seed; done

# ---------------------------------------------------------------------------------------------------------------- view
succeed "view of an EXR file" view shot1/camera.exr
whole "its page" shot1/camera.html
grep -q '"electrons.Y"' shot1/camera.html && grep -q '"id.triangle"' shot1/camera.html && good "all channels" || bad "all channels" "not there"
succeed "view of a PNG file" view shot1/camera.png --out png.html
whole "its page" png.html
succeed "view of two channels" view shot1/camera.exr --channel depth.Z,id.object --out two.html
grep -q '"electrons.Y"' two.html && bad "no others" "electrons.Y" || good "no others"
refuse "view of a channel that is not there" "no channel 'depth'; expected one of electrons\.Y, .*depth\.Z" bad.html view shot1/camera.exr --channel depth --out bad.html
refuse "view of no picture" 'truth\.json.*expected' bad.html view shot1/truth.json --out bad.html

# ---------------------------------------------------------------------------------------------------------------- diff
code_is "a picture and itself" 0 diff shot1/camera.exr shot1/camera.exr --check
grep -q 'the same in every pixel' stdout.txt && good "it says so" || bad "it says so" "$(cat stdout.txt)"
code_is "two seeds differ" 3 diff shot1/camera.exr shot2/camera.exr --check --json
cp stdout.txt diff.json
holds "by no more than the noise that they state, without bias" diff.json \
  'json.channels.filter((c) => c.channel === "electrons.Y").every((c) => c.different > 0 && c.rms_in_sigmas < 1.2 && Math.abs(c.bias) < 0.1 * c.rms)'
holds "the same ids" diff.json 'json.channels.filter((c) => c.channel.startsWith("id.")).every((c) => c.different === 0)'
succeed "diff with a page" diff shot1/camera.exr shot2/camera.exr --out diff.html
whole "its page" diff.html
code_is "two folders" 3 diff shot1 shot2 --check
grep -q '^camera.exr$' stdout.txt && grep -q '^camera.png$' stdout.txt && good "it names what differs" || bad "it names what differs" "$(cat stdout.txt)"
succeed "a smaller render" render oval --size 64x48 --spp 1 --out small
refuse "pictures of other sizes" '64 x 48 px; expected 160 x 120 px, as shot1/camera\.png' bad.html diff shot1/camera.png small/camera.png --out bad.html
refuse "a page of two folders" '--out: .*expected two files, found folders' bad.html diff shot1 shot2 --out bad.html

# -------------------------------------------------------------------------------------------------------------- report
succeed "report of a render" report shot1
whole "its page" shot1/report.html
grep -q '"type":"room"' shot1/report.html && good "with its room" || bad "with its room" "none"
study=(study markers --stride 14 --spp 1 --markers 3 --keep all)
succeed "a study" "${study[@]}" --out "a study"
whole "its page" "a study/report.html"
cp "a study/hits.csv" hits.csv
mv "a study" moved && rm moved/report.html moved/hits.csv
succeed "report of a study that was moved" report moved --quiet
whole "its page" moved/report.html
cmp -s hits.csv moved/hits.csv && good "its tables" || bad "its tables" "hits.csv differs"
holds "nothing was rendered" moved/run.json 'json.tasks.done_now === 0'
code_is "a study and itself" 0 diff moved moved --check
mkdir begun && cp moved/manifest.json begun/
code_is "report of a study that is not finished" 2 report begun
grep -q 'not finished; expected run.json; give its command again' stderr.txt && good "it says so" || bad "it says so" "$(cat stderr.txt)"
refuse "report of nothing" 'nowhere/run\.json.*expected' bad report nowhere

finish
