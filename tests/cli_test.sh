#!/usr/bin/env bash
# The command line from end to end: wrong input gives one clear line, exit code 2 and no output; the same seed gives
# the same bytes on any number of threads. Prints a line for each case; exit 1 if one fails.
#   cli_test.sh RETROLUX_BINARY
set -u
. "$(dirname "$(realpath "$0")")/cli_checks.sh"

# ------------------------------------------------------------------------------------------ scenes that are wrong
mkdir scene empty
run scene export oval --out scene || { bad "scene export oval" "$(cat stderr.txt)"; exit 1; }

# variant NAME SED: the exported scene with a change, beside its geometry.
variant() { sed -E "$2" scene/scene.json >"scene/$1.json"; cmp -s scene/scene.json "scene/$1.json" && bad "variant $1" "no change"; }
render_bad() { refuse "$1" "$2" bad "render" "$3" --size 64x48 --spp 1 --out bad; }

render_bad "missing scene file" 'nowhere\.json.*expected' nowhere.json
render_bad "folder without scene.json" 'empty/scene\.json.*No such file.*expected' empty
render_bad "unknown built-in" 'oval-room.*expected.*ct-room.*oval.*sphere' oval-room
variant wrong_type 's/"name": "oval"/"name": 7/'
render_bad "wrong type" 'wrong_type\.json: /name: found number 7; expected a string' scene/wrong_type.json
variant unknown_key 's/"full_well_e"/"full_wel_e"/'
render_bad "unknown key" "unknown_key\.json: /cameras/0/sensor: found the unknown key 'full_wel_e'; expected 'full_well_e'" scene/unknown_key.json
variant nan 's/"full_well_e": [0-9.]+/"full_well_e": NaN/'
render_bad "NaN in JSON" 'nan\.json.*line [0-9]+.*N.*expected' scene/nan.json
variant infinite 's/"full_well_e": [0-9.]+/"full_well_e": 1e999/'
render_bad "a number beyond double" 'infinite\.json.*too large.*expected' scene/infinite.json
head -c 5000 scene/oval.glb >scene/truncated.glb
variant truncated 's/oval\.glb/truncated.glb/'
render_bad "truncated GLB" 'truncated\.glb.*5000 bytes.*expected' scene/truncated.json
cat >scene/flat.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "mask", "mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"}]}
GLTF
variant flat 's/oval\.glb/flat.gltf/'
render_bad "mesh without area" "flat\.json: object 'mask'.*without area.*expected a surface" scene/flat.json
sed 's/"mesh": 0/"extras": 0/' scene/flat.gltf >scene/none.gltf
variant none 's/oval\.glb/none.gltf/'
render_bad "file without a mesh" "none\.gltf.*expected.*mesh" scene/none.json
variant no_glb 's/oval\.glb/gone.glb/'
render_bad "missing geometry" 'no_glb\.json: /objects/0/file.*gone\.glb.*expected' scene/no_glb.json
variant escape 's/"name": "camera"/"name": "..\/escaped"/'
render_bad "camera name that leaves the folder" 'escape\.json.*\.\./escaped.*expected' scene/escape.json
if compgen -G 'escaped*' >found.txt; then bad "nothing outside the folder" "$(tr '\n' ' ' <found.txt)"; rm -f escaped*; else good "nothing outside the folder"; fi
variant two_lines 's/"material": "mask"/"material": "no\\nsuch"/'
render_bad "line break in a name" 'two_lines\.json: /objects/0/material.*expected' scene/two_lines.json
{ printf '{"schema": '; head -c 200000 /dev/zero | tr '\0' '['; head -c 200000 /dev/zero | tr '\0' ']'; printf '}'; } >scene/deep.json
render_bad "nested 200,000 deep" 'deep\.json.*expected' scene/deep.json
variant dark 's/"radiant_intensity_w_sr": [0-9.]+/"radiant_intensity_w_sr": 0.0/; s/"dark_current_e_s": [0-9.]+/"dark_current_e_s": 0.0/'
render_bad "exposure that no light fixes" "sends no light.*expected" scene/dark.json
variant offset 's/"offset_dn": [0-9.]+/"offset_dn": 300.0/'
render_bad "black level above the ADC's range" 'offset.*300.*expected' scene/offset.json
mkfifo scene/pipe.json
render_bad "scene file that is a pipe" 'pipe\.json.*expected' scene/pipe.json

# ---------------------------------------------------------------------------------------------- options that are wrong
small=(--size 64x48 --out bad)
refuse "negative spp" '--spp.*-3.*1.*1048576' bad render oval --spp -3 "${small[@]}"
refuse "zero spp" '--spp.*0.*1.*1048576' bad render oval --spp 0 "${small[@]}"
refuse "spp that is not a number" '--spp.*nan' bad render oval --spp nan "${small[@]}"
refuse "negative seed" '--seed.*-1' bad render oval --seed -1 --spp 1 "${small[@]}"
refuse "negative threads" '--threads.*-1.*0.*1024' bad render oval --threads -1 --spp 1 "${small[@]}"
touch file
refuse "unwritable output" 'file/x.*expected' file/x render oval --spp 1 --size 64x48 --out file/x
refuse "output that is a file" 'file: .*expected' bad render oval --spp 1 --size 64x48 --out file
refuse "unknown camera" "camera 'front'.*expected.*camera" bad render oval --camera front --spp 1 "${small[@]}"
refuse "unknown pose" "pose 'middle'.*expected.*reference, start, end" bad render ct-room --pose middle --spp 1 "${small[@]}"
refuse "unknown rings" '--rings.*some.*all.*own' bad render oval --rings some --spp 1 "${small[@]}"
for size in 64 64x 0x48 -64x48 64x48x2 nanxnan 99999x48 4294967360x48; do
  refuse "size $size" "--size.*$size.*expected" bad render oval --spp 1 --size "$size" --out bad
done
refuse "render without --out" '--out.*required' bad render oval --spp 1
refuse "export without --out" '--out.*required' bad scene export oval
refuse "export of an unknown scene" 'cube.*expected.*oval' bad scene export cube --out bad
refuse "export to an unwritable place" 'file/x.*expected' file/x scene export oval --out file/x
refuse "unknown subcommand" 'paint' bad paint oval --out bad
refuse "unknown study" 'colours' bad study colours --out bad
refuse "no subcommand" 'subcommand' bad
refuse "unknown option" '--colour' bad render oval --spp 1 --colour "${small[@]}"
refuse "study without --out" '--out.*required' bad study markers
refuse "study of an unknown marker" 'marker 9.*expected.*1, 2, 3, 4, 5, 6' bad study markers --markers 2,9 --out bad
refuse "study of an unknown pose" "pose 'middle'.*expected.*reference, start, end" bad study markers --poses middle --out bad
refuse "study of an unknown scene" 'cube.*expected.*oval' bad study markers --scene cube --out bad
refuse "study with zero spp" '--spp.*0.*1.*65536' bad study markers --spp 0 --out bad
refuse "study with an unknown method" '--method.*magic.*edges' bad study markers --method magic --out bad

# ------------------------------------------------------------------------------------------------------- good pictures
files=(camera.png camera.exr truth.json cameras.yml)
succeed "render on 1 thread" render oval --size 64x48 --spp 2 --threads 1 --out one
sleep 1.1  # no time of day may get into the files
succeed "render on 2 threads" render oval --size 64x48 --spp 2 --threads 2 --out two
same "1 and 2 threads, identical bytes" one two "${files[@]}"
succeed "render with another seed" render oval --size 64x48 --spp 2 --seed 2 --noise-seed 1 --out seed
if cmp -s one/camera.exr seed/camera.exr; then bad "another seed, another picture" "the same"; else good "another seed, another picture"; fi
succeed "render with another noise seed" render oval --size 64x48 --spp 2 --noise-seed 2 --out noise
if cmp -s one/camera.png noise/camera.png; then bad "another noise seed, another noise" "the same"; else good "another noise seed, another noise"; fi
differing=$(cmp -l one/camera.exr noise/camera.exr | wc -l)  # the seed in the header, one digit
if [ "$differing" -eq 1 ]; then good "another noise seed, the same light"; else bad "another noise seed, the same light" "$differing bytes"; fi
holds "truth.json names its conventions and all seven markers" one/truth.json \
  'json.schema === "retrolux/truth-1" && json.pixel_origin === "center" && json.cameras.camera.markers.length === 7'
succeed "ids only" render oval --size 64x48 --ids-only --out ids
if [ -s ids/camera.exr ] && [ ! -e ids/camera.png ]; then good "ids only: EXR and no PNG"; else bad "ids only: EXR and no PNG" "$(ls ids)"; fi
same "ids only: cameras.yml as with light" ids one cameras.yml
succeed "own rings" render ct-room --size 32x24 --spp 1 --rings own --camera back-left --out own
succeed "all rings, two cameras" render ct-room --size 32x24 --spp 1 --camera back-left,front-middle --out all
if [ "$(cd all && echo *.png)" = "back-left.png front-middle.png" ]; then good "--camera chooses"; else bad "--camera chooses" "$(ls all)"; fi
if cmp -s own/back-left.exr all/back-left.exr; then bad "--rings matters" "the same picture"; else good "--rings matters"; fi
succeed "render at a pose" render ct-room --size 32x24 --spp 1 --camera back-left --pose start --out start
holds "the pose is in truth.json" start/truth.json 'json.pose === "start"'
succeed "render of the exported scene" render scene --size 64x48 --spp 2 --threads 2 --out exported
same "the exported scene gives the same picture" one exported camera.png cameras.yml
run scene export scene --out again
same "export of the export" scene again scene.json oval.glb
succeed "--json" render oval --size 32x24 --spp 1 --json --out json
cp stdout.txt result.json
holds "--json of render is JSON" result.json 'json.out === "json" && json.files.includes("truth.json")'
for command in "scene list" "scene show ct-room"; do
  # shellcheck disable=SC2086
  succeed "--json $command" $command --json
  cp stdout.txt result.json
  holds "--json of $command is JSON" result.json 'typeof json === "object"'
done
succeed "--quiet" render oval --size 32x24 --spp 1 --quiet --out quiet
if [ -s stdout.txt ]; then bad "--quiet is silent" "$(cat stdout.txt)"; else good "--quiet is silent"; fi

# -------------------------------------------------------------------------------------------------- identification
refuse "classify without a picture" 'IMAGE.*required' bad classify --out bad
refuse "classify a missing picture" 'gone\.png.*expected a picture' bad classify gone.png --out bad
echo "no picture" >text.png
refuse "classify a text file" 'text\.png.*expected a picture' bad classify text.png --out bad
refuse "classify a folder" 'empty: .*folder.*expected a picture' bad classify empty --out bad
succeed "render at full size" render oval --spp 8 --out full
head -c 20000 full/camera.png >truncated.png
refuse "classify a truncated PNG" 'truncated\.png.*expected a' bad classify truncated.png --out bad
refuse "classify one good and one truncated" 'truncated\.png.*expected a' bad classify full/camera.png truncated.png --out bad
refuse "classify by an unknown method" 'magic.*expected.*edges' bad classify full/camera.png --method magic --out bad
refuse "tags of an unknown family" 'magic.*expected one of' bad.json tags magic --out bad.json
refuse "classify without --out" '--out.*required' bad classify full/camera.png
refuse "classify to an unwritable place" 'file.*expected' file/x.json classify full/camera.png --out file/x.json
mkfifo pipe
run classify full/camera.png --out pipe
if [ $? -eq 2 ] && [ -p pipe ]; then good "classify replaces files only"; else bad "classify replaces files only" "the pipe is $(stat -c %F pipe)"; fi
succeed "classify" classify full/camera.png --out found.json
holds "classify names the frontal markers" found.json \
  '[2, 5, "standard"].every(m => json.images[0].detections.some(d => d.marker === m))'
holds "classify names no marker twice" found.json \
  '(names => new Set(names).size === names.length)(json.images[0].detections.map(d => d.marker).filter(m => m !== null))'
succeed "classify with --debug" classify full/camera.png --debug stages --out found2.json
if [ "$(find stages -name '*.png' -size +0 | wc -l)" -eq 6 ]; then good "--debug writes six stages"; else bad "--debug writes six stages" "$(ls stages)"; fi
cmp -s found.json found2.json && good "--debug changes nothing" || bad "--debug changes nothing" "detections differ"

# --------------------------------------------------------------------------------------------------------- the study
# The room with a quarter of the pixels: what is tested is that threads change nothing, not the areas.
run scene export ct-room --out room
sed -E -i 's/"size": \[640, 480\]/"size": [320, 240]/; s/"camera_matrix": \[[^]]*\]/"field_of_view_deg": [12.18, 9.15]/' room/scene.json
sed 's/"name": "front-left"/"name": "side-left"/' room/scene.json >room/side.json
refuse "study of a room whose cameras are neither front nor back" "'side-left'.*expected.*front.*back" bad study markers --scene room/side.json --out bad
study=(study markers --scene room --stride 14 --spp 1 --poses reference)
succeed "study on 1 thread" "${study[@]}" --threads 1 --out study1
succeed "study on 2 threads" "${study[@]}" --threads 2 --json --out study2
cp stdout.txt result.json
holds "--json of the study is JSON" result.json 'json.schema === "retrolux/marker-study-1"'
same "study: 1 and 2 threads, identical tables" study1 study2 hits.csv coverage.csv summary.json
if [ "$(wc -l <study1/hits.csv)" -eq 25 ]; then good "hits.csv: 2 markers x 6 cameras x 2 positions"; else bad "hits.csv: 2 markers x 6 cameras x 2 positions" "$(wc -l <study1/hits.csv) lines"; fi
head -1 study1/hits.csv | grep -qx 'marker,pose,camera,row,col,x_mm,y_mm,z_mm,incidence_deg,visible_fraction,hit,detected,reason,edges_hit' &&
  good "hits.csv: columns" || bad "hits.csv: columns" "$(head -1 study1/hits.csv)"
head -1 study1/coverage.csv | grep -qx 'marker,pose,row,col,cameras_hit,satisfies' &&
  good "coverage.csv: columns" || bad "coverage.csv: columns" "$(head -1 study1/coverage.csv)"
# With all pixels: of a marker of ten pixels `robust` does not give the name of three or four edges.
succeed "study with robust" study markers --stride 14 --spp 1 --poses reference --method robust --out study3
holds "study with robust: the gain over edges" study3/summary.json \
  'json.method === "robust" && json.gain_over_edges.sets.length === json.sets.length && json.gain_over_edges.pictures.both > 0'
holds "study with edges: no gain" study1/summary.json 'json.gain_over_edges === null'
holds "run.json tells how it was made" study1/run.json 'json.schema === "retrolux/run-1" && json.threads === 1 && json.seed === 1'
[ -s study1/report.html ] && good "report.html" || bad "report.html" "missing"

# ---------------------------------------------------------------------------------------- a study that is interrupted
# 18 tasks: six cameras in three poses.
long=(study markers --scene room --stride 7 --spp 2)
tables=(hits.csv coverage.csv summary.json manifest.json)
results() { find "$1/tasks" -name '[0-9a-f]*.json' 2>/dev/null | wc -l; }

# interrupt NAME SIGNAL FOLDER COUNT: runs the study until COUNT results are there, then sends the signal.
interrupt() {
  local pid i
  "$retrolux" "${long[@]}" --out "$3" >stdout.txt 2>stderr.txt </dev/null &
  pid=$!
  for ((i = 0; i < limit_s * 20 && $(results "$3") < $4; ++i)); do sleep 0.05; done
  kill -"$2" $pid
  wait $pid 2>/dev/null
  local code=$? count
  count=$(results "$3")
  if [ $code -le 128 ]; then bad "$1" "exit code $code before the signal: $(head -c 300 stderr.txt)"
  elif [ "$count" -lt "$4" ] || [ "$count" -ge 18 ]; then bad "$1" "$count results"
  elif [ -e "$3/summary.json" ]; then bad "$1" "there is a summary already"
  else good "$1"; fi
}

# same_as_whole NAME: the study in `killed` has the files of the one that was not interrupted, to the byte.
same_as_whole() {
  same "$1: the tables" whole killed "${tables[@]}"
  rm -f killed/tasks/.*.part* killed/pictures/.*.part*  # of the run that was killed
  local part
  for part in tasks pictures; do
    diff -rq whole/$part killed/$part >diff.txt && good "$1: $part" || bad "$1: $part" "$(head -3 diff.txt)"
  done
}

succeed "study, not interrupted" "${long[@]}" --out whole
holds "a task for each camera and pose" whole/manifest.json \
  'json.stages.length === 1 && json.stages[0].tasks.length === 18 && json.stages[0].tasks[0].name === "camera front-middle, pose reference"'
interrupt "study killed" KILL killed 3
interrupt "study ended" TERM killed 7
done_before=$(results killed)
succeed "study goes on" "${long[@]}" --out killed
grep -q "; skipped $done_before of 18 tasks (done before)" stdout.txt && good "it says what was done before" || bad "it says what was done before" "$(cat stdout.txt)"
same_as_whole "interrupted and not interrupted"
holds "run.json: what this run did" killed/run.json "json.tasks.done_before === $done_before && json.tasks.done_now === 18 - $done_before"

rm killed/hits.csv
succeed "finished study again" "${long[@]}" --out killed
holds "nothing is rendered again" killed/run.json 'json.tasks.done_now === 0 && json.times.background_wall === 0'
same_as_whole "finished study again"

# again NAME PATTERN: one task is done again, with a warning that matches.
again() {
  run "${long[@]}" --out killed
  local code=$?
  if [ $code -ne 0 ]; then bad "$1" "exit code $code: $(head -c 300 stderr.txt)"
  elif [ "$(wc -l <stderr.txt)" -ne 1 ] || ! grep -qE "$2" stderr.txt; then bad "$1" "on stderr: $(head -c 300 stderr.txt)"
  else good "$1"; fi
  holds "$1: one task" killed/run.json 'json.tasks.done_now === 1'
  same_as_whole "$1"
}
result=$(find killed/tasks -name '[0-9a-f]*.json' | head -1)
truncate -s 1000 "$result"
again "truncated result" "$result: damaged.*is done again"
rm "$(find killed/pictures -name '*.png' | head -1)"
again "kept picture that is gone" "killed/tasks/.*no longer usable.*is done again"
succeed "one pose of a study that is done" "${long[@]}" --poses start --out killed
holds "its tasks are taken over" killed/run.json 'json.tasks.done_before === 6 && json.tasks.done_now === 0'
grep -q "; 12 results of other work left alone" stdout.txt && good "it says what it left alone" || bad "it says what it left alone" "$(cat stdout.txt)"

# -------------------------------------------------------------------------------------------------------------- masks
for mask in face body oval sphere; do
  succeed "mask make $mask" mask make $mask --out masks/$mask.glb --json
  cp stdout.txt result.json
  holds "mask make $mask: no warnings" result.json 'json.warnings.length === 0 && json.inside_out_pieces === 0'
done
succeed "mask make face" mask make face --out masks/face.glb --json
cp stdout.txt result.json
holds "face: 2,542 vertices, 76,459 mm2, one rim" result.json \
  'json.vertices === 2542 && Math.abs(json.area_mm2 - 76459) < 0.01 && json.holes === 1'
succeed "mask import of our own GLB" mask import masks/face.glb --out masks/again.glb --json
cp stdout.txt result.json
holds "imported as it was" result.json 'json.vertices === 2542 && Math.abs(json.area_mm2 - 76459) < 0.1'
cmp -s masks/face.glb masks/again.glb && good "import changes nothing" ||
  bad "import changes nothing" "GLB differs"
succeed "mask import --flip" mask import masks/face.glb --flip --out masks/flipped.glb
grep -q 'warning: 1 of 1 pieces inside out' stdout.txt && good "inside out is told" || bad "inside out is told" "$(cat stdout.txt)"

# An OBJ of a cup, in metres.
cat >cup.obj <<'OBJ'
v 0 0 0
v 0.2 0 0
v 0.2 0.2 0
v 0 0.2 0
v 0.1 0.1 0.1
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
OBJ
succeed "mask import OBJ in metres" mask import cup.obj --unit m --out masks/cup.glb --json
cp stdout.txt result.json
holds "OBJ in metres" result.json 'Math.abs(json.area_mm2 - 56568.54) < 1 && json.holes === 1 && json.warnings.length === 0'
succeed "mask import OBJ in the wrong unit" mask import cup.obj --unit mm --out masks/cup.glb --smooth
grep -q 'warning: largest extent 0.2 mm.*1000 times as long.*is --unit right' stdout.txt && good "the unit is doubted" ||
  bad "the unit is doubted" "$(cat stdout.txt)"
cat >masks/scene.json <<'JSON'
{"schema": "retrolux/scene-1", "name": "cup", "up_axis": "z",
 "objects": [{"name": "cup", "file": "cup.obj", "unit": "m", "material": "mask"},
             {"name": "face", "file": "face.glb", "material": "mask", "translation_mm": [0, 300, 0]}],
 "cameras": [{"name": "c", "size": [32, 24], "field_of_view_deg": [12, 9], "eye_mm": [1600, 0, 0], "look_at_mm": [0, 0, 0],
              "up": [0, 0, 1], "ring": {}}]}
JSON
cp cup.obj masks/
succeed "OBJ and made GLB as objects of a scene" scene show masks/scene.json --json
cp stdout.txt result.json
holds "their areas" result.json \
  'Math.abs(json.objects[0].area_mm2 - 56568.54) < 1 && Math.abs(json.objects[1].area_mm2 - 76459) < 0.1'

succeed "mask sample" mask sample face --points 20000 --noise-mm 0.3 --out masks/cloud.ply
succeed "mask reconstruct" mask reconstruct masks/cloud.ply --unit mm --compare face --out masks/surface.glb --json
cp stdout.txt result.json
holds "a mask through noisy points: 0.3 mm of noise, less than 0.12 mm from the truth" result.json \
  'json.compare.to_truth.rms_mm < 0.12 && json.compare.from_truth.max_mm < 3.5 && json.pieces === 1 && json.holes === 1'
succeed "mask reconstruct again" mask reconstruct masks/cloud.ply --unit mm --threads 1 --out masks/surface2.glb
cmp -s masks/surface.glb masks/surface2.glb && good "the same points, the same bytes" || bad "the same points, the same bytes" "GLB differs"

refuse "unknown mask" "no mask 'fase'; expected 'face'" bad.glb mask make fase --out bad.glb
refuse "mask to no .glb" "bad\.ply.*'\.ply'; expected \.glb" bad.ply mask make face --out bad.ply
refuse "relief of a sphere" "--relief.*'sphere'; expected.*'face'" bad.glb mask make sphere --relief 0.5 --out bad.glb
refuse "import without a unit" 'cup\.obj.*no unit.*expected --unit' bad.glb mask import cup.obj --out bad.glb
refuse "import of glTF in mm" 'face\.glb.*expected m: glTF is in metres' bad.glb mask import masks/face.glb --unit mm --out bad.glb
refuse "import in inches" '--unit.*inch.*mm,cm,m' bad.glb mask import cup.obj --unit inch --out bad.glb
refuse "import of an unknown format" "text\.png.*'\.png'; expected \.glb" bad.glb mask import text.png --unit mm --out bad.glb
refuse "import of a missing file" 'gone\.ply.*expected' bad.glb mask import gone.ply --unit mm --out bad.glb
refuse "import of points" 'cloud\.ply.*no triangles; expected a mesh' bad.glb mask import masks/cloud.ply --unit mm --out bad.glb
head -c 3000 masks/cloud.ply >cut.ply
refuse "import of a truncated PLY" 'cut\.ply.*expected' bad.glb mask import cut.ply --unit mm --out bad.glb
printf '1 2 3\n4 five 6\n' >bad.xyz
refuse "a cloud with a word" "bad\.xyz: line 2: '4 five 6'; expected x y z" bad.glb mask reconstruct bad.xyz --unit mm --out bad.glb
printf '1 2 3\n4 5 6\n' >two.xyz
refuse "a cloud of two points" '2 different points; expected at least 12' bad.glb mask reconstruct two.xyz --unit mm --out bad.glb
for i in $(seq 0 99); do echo "$((i % 10)) $((i / 10)) 5"; done >plane.xyz
refuse "a cloud in a plane" 'in a plane; expected' bad.glb mask reconstruct plane.xyz --unit mm --out bad.glb
refuse "comparison with nothing" "no mask and no file 'hand'; expected one of face" bad.glb mask reconstruct masks/cloud.ply --unit mm --compare hand --out bad.glb

# ------------------------------------------------------------------------------------------------- cameras in the vault
cat >tiny.json <<'JSON'
{"schema": "retrolux/scenario-1", "base": "1a", "name": "tiny",
 "cameras": {"width_px": 160, "height_px": 120},
 "masks": {"face": {"x_deg": [0], "y_deg": [-10], "z_deg": {"from": 0, "to": 180, "step": 90}}},
 "search": {"phi_b_deg": {"from": 40, "to": 60, "step": 20}, "theta_deg": {"from": 31.67, "to": 70.52, "step": 38.85},
            "refined_phi_b_step_deg": 10, "refined_theta_step_deg": 38.85, "refined_optima": 1},
 "variations": []}
JSON
vault=(study vault --scenario tiny.json --sample-area 40 --quick)
cut='warning: the mask is larger than the field of view in [1-9][0-9]* of [0-9]+ views'

# vault NAME ARGS...: exit code 0, and on stderr at most that the mask is larger than a picture, as this face is in some.
vault() {
  local name=$1 code
  shift
  run "$@"
  code=$?
  if [ $code -ne 0 ]; then bad "$name" "exit code $code: $(head -c 300 stderr.txt)"; return 1
  elif grep -qvE "$cut" stderr.txt || [ "$(wc -l <stderr.txt)" -gt 1 ]; then bad "$name" "on stderr: $(head -c 300 stderr.txt)"; return 1
  else good "$name"; fi
}

# cost FOLDER: of the optimum.
cost() { node -p "JSON.parse(require('fs').readFileSync('$1/solution.json', 'utf8')).cost"; }

tables=(evaluations.csv orientations.csv solution.json)
vault "study vault on 1 thread" "${vault[@]}" --visibility rays --threads 1 --out vault1
vault "study vault on 2 threads" "${vault[@]}" --visibility rays --threads 2 --json --out vault2
cp stdout.txt result.json
holds "--json of study vault is JSON" result.json 'json.length === 1 && json[0].schema === "retrolux/vault-solution-1"'
same "study vault: 1 and 2 threads, identical tables" vault1 vault2 "${tables[@]}"
head -1 vault1/evaluations.csv | grep -qx 'phase,phi_b_deg,theta1_deg,theta2_deg,cost,area_pct,area_cm2,min_angle_deg,min_angle_nominal_deg,recon_error_mm,combination,rot_x_deg,rot_y_deg,rot_z_deg,mask' &&
  good "evaluations.csv: columns" || bad "evaluations.csv: columns" "$(head -1 vault1/evaluations.csv)"
head -1 vault1/orientations.csv | grep -qx 'rot_x_deg,rot_y_deg,rot_z_deg,cost,combination,mask' &&
  good "orientations.csv: columns" || bad "orientations.csv: columns" "$(head -1 vault1/orientations.csv)"
[ "$(grep -c '^1,' vault1/evaluations.csv)" -eq 8 ] && good "evaluations.csv: 2 x 2 x 2 placements of phase 1" ||
  bad "evaluations.csv: 2 x 2 x 2 placements of phase 1" "$(grep -c '^1,' vault1/evaluations.csv)"
[ "$(wc -l <vault1/orientations.csv)" -eq 4 ] && good "orientations.csv: three orientations" ||
  bad "orientations.csv: three orientations" "$(wc -l <vault1/orientations.csv) lines"
holds "solution.json has placement and cost" vault1/solution.json \
  'json.cost > 0 && json.combination.length >= 3 && ["phi_b_deg", "theta1_deg", "theta2_deg"].every(k => json.placement[k] > 0)'
node -e "
const rows = require('fs').readFileSync('vault1/evaluations.csv', 'utf8').trim().split('\n').slice(1).map(row => Number(row.split(',')[4]));
process.exit(Math.abs(Math.max(...rows) - $(cost vault1)) < 1e-4 ? 0 : 1)" && good "the optimum is the best row" || bad "the optimum is the best row" "$(cost vault1)"
[ -s vault1/report.html ] && good "report.html of the vault" || bad "report.html of the vault" "missing"
holds "run.json: all tasks are new" vault1/run.json 'json.tasks.done_before === 0 && json.tasks.done_now > 0'
cp -r vault1 vault_before
vault "study vault again" "${vault[@]}" --visibility rays --out vault1
holds "no task anew" vault1/run.json 'json.tasks.done_before > 0 && json.tasks.done_now === 0'
same "study vault again: identical tables" vault_before vault1 "${tables[@]}" manifest.json
vault "study vault with finer samples, same folder" study vault --scenario tiny.json --sample-area 20 --quick --visibility rays --out vault1
holds "other samples, other tasks" vault1/run.json 'json.tasks.done_before === 0'

vault "study vault --placement" "${vault[@]}" --visibility rays --placement vault2/solution.json --out vault_placed
[ "$(cost vault_placed)" = "$(cost vault2)" ] && good "--placement: the same cost" || bad "--placement: the same cost" "$(cost vault_placed), not $(cost vault2)"
[ "$(wc -l <vault_placed/evaluations.csv)" -eq 2 ] && good "--placement: no search" || bad "--placement: no search" "$(wc -l <vault_placed/evaluations.csv) lines"
vault "study vault --mask both" "${vault[@]}" --visibility rays --phase 1 --mask both --out vault_both
node -e "
const columns = file => require('fs').readFileSync('vault_both/' + file, 'utf8').trim().split('\n').slice(1).map(row => row.split(',')[4]);
const [worse, face, body] = ['evaluations.csv', 'evaluations_face.csv', 'evaluations_body.csv'].map(columns);
process.exit(worse.length === 8 && worse.every((cost, i) => Number(cost) === Math.min(face[i], body[i])) ? 0 : 1)" &&
  good "--mask both: the worse counts" || bad "--mask both: the worse counts" "$(tail -n +1 vault_both/evaluations*.csv | head -c 300)"
vault "study vault --mask FILE" "${vault[@]}" --visibility rays --mask masks/face.glb --out vault_file
holds "--mask FILE: nearly the cost of the same mask by name" vault_file/solution.json "Math.abs(json.cost - $(cost vault2)) < 0.01 * $(cost vault2)"
for rule in triangles ids; do
  vault "study vault --visibility $rule" "${vault[@]}" --visibility $rule --out "vault_$rule"
  holds "--visibility $rule: nearly the cost of rays" "vault_$rule/solution.json" "Math.abs(json.cost - $(cost vault2)) < 0.05 * $(cost vault2)"
done

# scenario NAME MERGE: the tiny one with a JavaScript object merged over it.
scenario() {
  node -e "
const merge = (over, patch) => { for (const [key, value] of Object.entries(patch))
  over[key] = value !== null && value.constructor === Object ? merge(over[key] ?? {}, value) : value; return over; };
const fs = require('fs');
fs.writeFileSync('$1.json', JSON.stringify(merge(JSON.parse(fs.readFileSync('tiny.json', 'utf8')), $2)));" || bad "scenario $1" "not made"
}
scenario huge '{masks: {face: {mesh: "sphere", scale: 3}}}'
run study vault --scenario huge.json --sample-area 400 --quick --visibility rays --out vault_huge
code=$?
if [ $code -ne 0 ]; then bad "a mask larger than the pictures" "exit code $code: $(head -c 300 stderr.txt)"
elif [ "$(wc -l <stderr.txt)" -ne 1 ] || ! grep -qE "$cut" stderr.txt; then bad "a mask larger than the pictures" "on stderr: $(head -c 300 stderr.txt)"
else good "a mask larger than the pictures"; fi
holds "every view is cut" vault_huge/solution.json 'json.views === 27 && json.views_cut === 27'
scenario no_body '{masks: {body: null}}'
refuse "a mask that was taken away" "--mask body: neither.*expected face, both" bad study vault --scenario no_body.json --mask body --quick --out bad

# vault_bad NAME PATTERN MERGE: the tiny scenario with a change is refused.
vault_bad() { scenario wrong "$3"; refuse "$1" "$2" bad study vault --scenario wrong.json --sample-area 40 --quick --visibility rays --out bad; }
vault_bad "empty interval" 'wrong\.json: /search/phi_b_deg: found an empty interval: from 60 to 40; expected from <= to' '{search: {phi_b_deg: {from: 60, to: 40}}}'
vault_bad "empty interval of a mask" '/masks/face/z_deg: found an empty interval.*expected' '{masks: {face: {z_deg: {to: -90}}}}'
vault_bad "step of 0" '/search/theta_deg: found the step 0; expected a step above 0' '{search: {theta_deg: {step: 0}}}'
vault_bad "refined step of 0" '/search/refined_theta_step_deg: found the step 0; expected' '{search: {refined_theta_step_deg: 0}}'
vault_bad "theta 181" '/search/theta_deg/to: found number 181; expected a number from 0 to 180' '{search: {theta_deg: {to: 181}}}'
vault_bad "one camera" '/cameras/count: found one camera; expected at least two' '{cameras: {count: 1}}'
vault_bad "a camera that is not there" '/combinations/extra/0/2: found camera 10; expected a camera from 1 to 9' '{combinations: {extra: [[1, 2, 10]]}}'
vault_bad "unknown key in a scenario" "/search: found the unknown key 'phi_d'; expected" '{search: {phi_d: 3}}'
vault_bad "a base that is not there" '/base: no such scenario; expected.*1a, 1b, 2' '{base: "nobase"}'
vault_bad "a scenario that is its own base" '/base: more than 8 bases; expected' '{base: "wrong.json"}'
vault_bad "a nozzle whose radii fall" '\(slim\): /nozzle: found radii 1000.*expected' '{variations: [{name: "slim", change: {nozzle: {tip_radius_mm: 1000}}}]}'
vault_bad "two known errors" '/reconstruction_error/points: found 2 known points; expected three or more' '{reconstruction_error: {points: [[30, 4], [90, 2]]}}'
vault_bad "known errors out of order" '/reconstruction_error/points/1: found 30 degrees after 90; expected ascending' '{reconstruction_error: {points: [[90, 2], [30, 4], [60, 3]]}}'
vault_bad "a known error of 0" '/reconstruction_error/points/0: found an error of 0 mm; expected a positive one' '{reconstruction_error: {points: [[30, 0], [60, 3], [90, 2]]}}'
vault_bad "gamma_max below the least error" '/reconstruction_error: found gamma_max_mm 1; expected more than the least known error, 1.5238 mm' '{reconstruction_error: {gamma_max_mm: 1}}'
vault_bad "nothing that can be built" '/search: no placement that can be built.*below 5000 mm; expected' '{rigs: {min_height_mm: 5000}}'
refuse "unknown simulation" '9z: no such scenario.*expected.*1a, 1b, 2, 3a, 3b, 4, 5' bad study vault --simulation 9z --quick --out bad
refuse "no simulation" 'no simulation; expected --simulation' bad study vault --quick --out bad
refuse "simulation and scenario" '--simulation excludes --scenario' bad "${vault[@]}" --simulation 1a --out bad
refuse "study vault without --out" '--out.*required' bad "${vault[@]}"
refuse "study vault to an unwritable place" 'file/x.*expected' file/x "${vault[@]}" --out file/x
refuse "--mask of a missing file" '--mask gone\.ply: neither.*expected body, face, both, or a mesh file' bad "${vault[@]}" --mask gone.ply --out bad
refuse "--mask of a text" "text\.png.*'\.png'; expected \.glb" bad "${vault[@]}" --mask text.png --out bad
printf 'v 0 0 0\nv 100 0 0\nv 200 0 0\nf 1 2 3\n' >flat.obj
refuse "--mask without area" 'flat\.obj: a mesh without area; expected a surface' bad "${vault[@]}" --mask flat.obj --out bad
for size in 64 64x 0x48 -64x48 64x48x2 nanxnan 99999x48 4294967360x48; do
  refuse "study vault, size $size" "--size.*${size%%x*}.*expected" bad "${vault[@]}" --size "$size" --out bad
done
echo '{"cost": 3}' >nowhere.json
refuse "--placement without a placement" "nowhere\.json: /: found no key 'placement'; expected" bad "${vault[@]}" --placement nowhere.json --out bad
echo '{"placement": {"phi_b_deg": 40, "theta1_deg": 181, "theta2_deg": 70}}' >nowhere.json
refuse "--placement beyond 180 degrees" 'nowhere\.json: /placement/theta1_deg: found number 181; expected' bad "${vault[@]}" --placement nowhere.json --out bad
refuse "--placement of a missing file" 'gone\.json: cannot be read.*expected' bad "${vault[@]}" --placement gone.json --out bad

# ----------------------------------------------------------------------------------------------------------------- areas
areas=(study areas --triangles 1280 --sample-area 1 --size 160x120)
succeed "study areas on 1 thread" "${areas[@]}" --threads 1 --out areas1
succeed "study areas on 2 threads" "${areas[@]}" --threads 2 --json --out areas2
cp stdout.txt result.json
holds "--json of study areas is JSON" result.json 'json.schema === "retrolux/area-study-1" && json.targets.length > 20'
same "study areas: 1 and 2 threads, identical tables" areas1 areas2 areas.csv summary.json
head -1 areas1/areas.csv | grep -qx 'test,case,psi_deg,rendered_mm2,analytic_mm2,analytic_far_mm2,rel_error' &&
  good "areas.csv: columns" || bad "areas.csv: columns" "$(head -1 areas1/areas.csv)"
# 1280 flat triangles lack half a per cent of the sphere.
grep '^single,camera 1,' areas1/areas.csv | awk -F, '{exit !($7 > -0.008 && $7 < -0.002 && $5 > 58904 && $5 < 58906)}' &&
  good "areas.csv: one camera's cap" || bad "areas.csv: one camera's cap" "$(grep '^single,camera 1,' areas1/areas.csv)"
[ -s areas1/report.html ] && good "study areas: a report" || bad "study areas: a report" "none"
rm areas2/summary.json
succeed "study areas again" "${areas[@]}" --out areas2
grep -q 'skipped [0-9]* of [0-9]* tasks (done before)' stdout.txt && good "nothing is done twice" || bad "nothing is done twice" "$(tail -2 stdout.txt)"
same "study areas again: the same tables" areas1 areas2 areas.csv summary.json
succeed "validate, a part" validate --only "centroids,filter" --out validated --json && cp stdout.txt result.json
holds "validate: what was measured, expected, from where" result.json 'json.schema === "retrolux/validate-1" && json.failed === 0 && json.count === json.checks.length && json.checks.length > 8 && json.checks.every((c) => c.pass && c.source && c.independent_of && Math.abs(c.measured - c.expected) <= c.tolerance)'
node -e 'const f = (n) => JSON.stringify(JSON.parse(require("fs").readFileSync(n))); process.exit(f("validated/validate.json") === f("result.json") ? 0 : 1)' && good "validate: the same on stdout and in the file" || bad "validate: the same on stdout and in the file" "they differ"
[ -s validated/report.html ] && good "validate: a report" || bad "validate: a report" "none"
refuse "validate: unknown checks" "no checks 'gravity'; expected one of white furnace" bad validate --only gravity --out bad
succeed "scene export of a distorted camera" scene export chessboard --out chessboard
succeed "render of it" render chessboard/scene.json --out distorted --size 64x48 --spp 1
holds "distortion in the exported scene" chessboard/scene.json 'json.cameras[0].distortion[0] === -0.2'
grep -q 'distortion_coefficients' distorted/cameras.yml && grep -q -- '-0.2' distorted/cameras.yml && good "distortion in cameras.yml" || bad "distortion in cameras.yml" "not there"
sed 's/"distortion": \[[^]]*\]/"distortion": [-9, 0, 0, 0, 0]/' chessboard/scene.json >chessboard/folded.json
refuse "a distortion that folds the picture" "folded\.json: camera 'camera': a distortion that brings no light to pixel.*expected coefficients" bad render chessboard/folded.json --out bad --ids-only
sed 's/"focus_distance_mm": [0-9.]*/"focus_distance_mm": 20/' chessboard/scene.json >chessboard/near.json
refuse "a focus within the focal length" 'near\.json: /cameras/0/lens: found focus_distance_mm 20; expected more than the focal length' bad render chessboard/near.json --out bad --ids-only
refuse "study areas: bad --size" '--size 640by480: expected WIDTHxHEIGHT' bad study areas --size 640by480 --out bad
refuse "study areas: --size of nothing" '--size 0x0: expected' bad study areas --size 0x0 --out bad
refuse "study areas: --triangles 1000" '--triangles 1000; expected one of.*1280.*81920' bad study areas --triangles 1000 --out bad
refuse "study areas: unknown rule" '--visibility.*magic.*ids,rays,triangles' bad study areas --visibility magic --out bad
refuse "study areas without --out" '--out.*required' bad study areas

# ------------------------------------------------------------------------------------ materials and the goniometer
succeed "material list" --json material list
cp stdout.txt result.json
holds "material list: the library" result.json 'json.materials.some((m) => m.name === "retro_prismatic" && m.type === "retro_table")'
succeed "material show" material show retro_bead_table
grep -q ra_bead_iso20471.csv stdout.txt && good "material show: its table" || bad "material show: its table" "$(head -c 200 stdout.txt)"
printf 'observation_deg,entrance_deg,ra_cd_lx_m2\n0.2,5,330\n0.33,5,250\n1,5,25\n1.5,5,10\n' >table.csv
succeed "material fit" --json material fit table.csv --lobes 1
cp stdout.txt result.json
# The fit of one lobe made with another program: width 0.0054, albedo 0.147, rms 0.13.
holds "material fit: the lobe" result.json 'Math.abs(json.lobes[0].roughness - 0.0054) < 1e-4 && Math.abs(json.rms_ln_ra - 0.13) < 0.006 && json.residuals_ln_ra.length === 4'
refuse "material fit: too many lobes" '3 lobes.*6 parameters, the table 4 points; expected' bad material fit table.csv --lobes 3
refuse "material fit: no table" 'absent.csv' bad material fit absent.csv
printf 'wavelength_nm,reflectance\n400,0.5\n' >spectrum.csv
refuse "material fit: a table of something else" 'spectrum.csv: header: wavelength_nm.*expected observation_deg' bad material fit spectrum.csv
for threads in 1 2; do
  succeed "goniometer, $threads threads" goniometer retro_high_gain --observation 0.2,1 --entrance 5,40 --out "gonio$threads" --threads $threads
done
same "goniometer: 1 and 2 threads, identical table" gonio1 gonio2 goniometer.csv
# 500 cd/(lx m2) at 0.2 / 5 degrees is what the sheeting is defined by: 2 %.
awk -F, 'NR == 2 {exit !($6 > 490 && $6 < 510)}' gonio1/goniometer.csv &&
  good "goniometer: R_A" || bad "goniometer: R_A" "$(head -2 gonio1/goniometer.csv | tr '\n' ' ')"
refuse "goniometer: unknown material" "material 'felt' is not in the library; expected one of" bad goniometer felt --out bad
refuse "goniometer: too oblique" 'entrance angle 89 degrees; expected -85 to 85' bad goniometer mask --entrance 89 --out bad

# -------------------------------------------------------------------------------------------------------------- bench
succeed "bench" --json bench --seconds 0.01
cp stdout.txt bench.json
holds "bench: a rate beside each limit" bench.json 'json.schema === "retrolux/bench-1" && json.rates.length === 14 && json.rates.every((r) => r.per_second > 0 && (r.limit === undefined || (r.limit_per_second > 0 && r.share > 0)))'
refuse "bench: no time" 'seconds.*0' bad bench --seconds 0

# ------------------------------------------------------------------------------------------------------------- dataset
cat >tiny.json <<'END'
{"schema": "retrolux/dataset-1", "name": "tiny", "licence": "CC0-1.0", "scenes": 4, "spp": 2,
 "splits": {"train": 0.5, "test": 0.5}, "masks": [{"mesh": "oval"}, {"mesh": "face"}],
 "views": [{"kind": "free", "cameras": 2, "distance_mm": [1200, 1600], "incidence_deg": [0, 50]}],
 "markers": {"identifiable": 4, "standard": 2, "at_rim": 0.5},
 "recording": {"size_px": [160, 120], "sensor": {"default": 1, "icx414al": 1}, "distortion_k1": -0.1},
 "distractors": {"cables": {"probability": 1}, "plate": {"probability": 0.5}}}
END
succeed "dataset plan" dataset plan tiny.json --out set
[ -s set/manifest.json ] && [ -z "$(ls set/images)" ] && good "dataset plan: nothing rendered" ||
  bad "dataset plan: nothing rendered" "$(ls set set/images | tr '\n' ' ')"
sed 's/"standard"/"standart"/' tiny.json >wrong.json
refuse "dataset: unknown key" '/markers: found the unknown key .standart.; expected .standard.' bad dataset plan wrong.json --out bad
refuse "dataset run: no plan" 'no config.json; expected a folder that .retrolux dataset plan. made' bad dataset run bad
refuse "dataset run: no such time" '--time-limit' bad dataset run set --time-limit soon
refuse "dataset run: shard 3 of 2" '--shard 3/2: expected i/n' bad dataset run set --shard 3/2
refuse "dataset run: tasks" '--tasks 4-2: expected' bad dataset run set --tasks 4-2
refuse "dataset export: not done" 'no dataset.json; expected a dataset whose scenes are all done' bad dataset export set --format csv
succeed "dataset run" dataset run set --threads 1
holds "dataset: pictures, pixel origin" set/dataset.json 'json.pixel_origin === "center" && json.pictures === 8 && json.scenes.length === 4 && json.markers > 8'
succeed "dataset: plan again" dataset plan tiny.json --out shards
succeed "dataset plan, never run" dataset plan tiny.json --out unfinished
for i in 2 1; do succeed "dataset run, shard $i of 2" dataset run shards --shard $i/2 --threads 2; done
same "dataset: shards on 2 threads, the bytes of one run on 1" set shards dataset.json contact_sheet.png $(cd set && ls images/*.png)
succeed "dataset status" --json dataset status shards
cp stdout.txt status.json
holds "dataset status: all done" status.json 'json.scenes === 4 && json.done === 4 && json.missing === 0'
sed 's/"spp": 2/"spp": 3/' tiny.json >other.json
run dataset plan other.json --out set
[ $? -eq 2 ] && grep -q '/config/spp was 2, is 3' stderr.txt && good "dataset plan: another plan is refused" ||
  bad "dataset plan: another plan is refused" "$(cat stderr.txt)"
for format in coco bop csv; do succeed "dataset export $format" dataset export set --format $format; done
if command -v python3 >/dev/null; then
  python3 "$tests/labels_readback.py" set >readback.txt 2>&1 && good "dataset: labels read back by Python" ||
    bad "dataset: labels read back by Python" "$(tail -3 readback.txt | tr '\n' ' ')"
fi

# ------------------------------------------------------------------------------------------------------------ evaluate
succeed "evaluate: both methods" evaluate set --split all --threads 1 --out scores1
succeed "evaluate on 2 threads" evaluate set --split all --threads 2 --out scores2
same "evaluate: the same on 2 threads" scores1 scores2 evaluation.json misses.csv false_positives.csv
holds "evaluate: the contract's keys" scores1/evaluation.json \
  'json.method === "robust" && json.pictures === 8 && json.markers > 8 && json.found <= json.markers && json.misnamed >= 0 && json.false_positives >= 0 && "precision" in json && json.recall === json.found / json.markers && "centroid_rms_px" in json && "centroid_bias_px" in json && Array.isArray(json.by.incidence_deg) && Array.isArray(json.by.size_px)'
holds "evaluate: methods on the same markers" scores1/evaluation.json \
  'json.compared.length === 1 && json.compared[0].method === "edges" && json.compared[0].markers === json.markers && json.paired[0].both + json.paired[0].first_only === json.found'
holds "evaluate: speed in run.json" scores1/run.json 'json.rates.length === 2 && json.rates.every((r) => r.pictures_per_second > 0)'
[ -s scores1/report.html ] && good "evaluate: report" || bad "evaluate: report" "$(ls scores1)"
# The method itself and the file that `classify` writes of the same pictures. (8 bits: classify can't know that a 16-bit
# file holds 12.)
sed 's/"sensor": {[^}]*}/"sensor": "default"/; s/"scenes": 4/"scenes": 2/; s/160, 120/480, 360/' tiny.json >eight.json
succeed "dataset of 8 bits" dataset plan eight.json --out eight
run dataset run eight
for method in edges robust; do
  succeed "classify a dataset, $method" classify eight/images/*.png --method $method --out found.json
  succeed "evaluate --detections, $method" evaluate eight --split all --detections found.json --out from-file
  succeed "evaluate --method, $method" evaluate eight --split all --method $method --out from-method
  same "evaluate: --detections gives what --method $method gives" from-file from-method evaluation.json misses.csv
  holds "evaluate: $method finds some" from-method/evaluation.json 'json.found > 0'
done
refuse "evaluate: no dataset" 'scene: no dataset.json; expected a dataset whose scenes are all done' bad evaluate scene --out bad
refuse "evaluate: unfinished dataset" 'no dataset.json; expected' bad evaluate unfinished --out bad
refuse "evaluate: no pictures in the split" '--split val: no pictures' bad evaluate set --split val --out bad
refuse "evaluate: unknown method" "no method 'guess'; expected one of edges, robust" bad evaluate set --method guess --out bad
refuse "evaluate: a method twice" '--method edges twice' bad evaluate set --method edges --method edges --out bad
refuse "evaluate: no such file" 'none.json' bad evaluate eight --split all --detections none.json --out bad
sed 's/"center"/"corner"/' found.json >wrong.json
refuse "evaluate: another pixel origin" '/pixel_origin: found string "corner"' bad evaluate eight --split all --detections wrong.json --out bad
node -e 'const f = JSON.parse(fs.readFileSync("found.json")); f.images[1].detections = [{marker: 9, centroid_px: [1, 2]}]; fs.writeFileSync("wrong.json", JSON.stringify(f))'
refuse "evaluate: unknown marker" '/images/1/detections/0/marker: found 9; expected 1, 2, 3, 4, 5, 6' bad evaluate eight --split all --detections wrong.json --out bad
node -e 'const f = JSON.parse(fs.readFileSync("found.json")); f.images.pop(); fs.writeFileSync("wrong.json", JSON.stringify(f))'
refuse "evaluate: a picture is missing" '/images: 1 of the 4 pictures are missing' bad evaluate eight --split all --detections wrong.json --out bad
node -e 'const f = JSON.parse(fs.readFileSync("found.json")); f.images[2].file = "other.png"; fs.writeFileSync("wrong.json", JSON.stringify(f))'
refuse "evaluate: a picture of another dataset" "/images/2/file: 'other.png'; expected a picture of the dataset" bad evaluate eight --split all --detections wrong.json --out bad
cp set/images/scene-00000_camera-1.png eight/images/scene-00000_camera-2.png
refuse "evaluate: a picture was changed" 'another picture than the one that was labelled' bad evaluate eight --split all --method edges --out bad

# -------------------------------------------------------------------------------------------------------------- stereo
# Two cameras 30 degrees apart look at the oval's six markers and its standard one.
node -e 'const s = JSON.parse(fs.readFileSync("scene/scene.json"));
const at = (name, deg) => { const c = structuredClone(s.cameras[0]), a = deg * Math.PI / 180; delete c.R; delete c.t_mm;
  return {...c, name, eye_mm: [1600 * Math.cos(a), 1600 * Math.sin(a), 0], look_at_mm: [0, 0, 0], up: [0, 0, 1]}; };
s.cameras = [at("left", 15), at("right", -15)];
for (const m of s.markers) m.at_mm[1] *= 0.6;
fs.writeFileSync("scene/pair.json", JSON.stringify(s))'
succeed "render a pair" render scene/pair.json --spp 2 --out pair
succeed "stereo" stereo pair --threads 1 --out space1
succeed "stereo on 2 threads" stereo pair --threads 2 --out space2
same "stereo: the same on 2 threads" space1 space2 stereo.json markers3d.csv constellation.json
holds "stereo: all markers, the standard one by its position, to 0.3 mm" space1/stereo.json \
  'json.pixel_origin === "center" && json.constellation === "truth.json" && json.detections === "method robust" && json.markers.length === 7 && json.markers.every((m) => m.at_mm && Math.hypot(...m.error_mm) < 0.3) && json.markers[6].views.every((v) => v.named_by === "position") && json.pose.error.rotation_deg < 0.2'
[ -s space1/report.html ] && good "stereo: report" || bad "stereo: report" "$(ls space1)"
succeed "classify for stereo" classify pair/left.png pair/right.png --method robust --out detections.json
succeed "stereo --detections" stereo pair --detections detections.json --out space3
same "stereo: --detections gives what the method gives" space1 space3 markers3d.csv
succeed "stereo --constellation" stereo pair --constellation space1/constellation.json --out space4
holds "stereo: on its own constellation nothing is left over" space4/stereo.json 'json.pose.fre_mm < 1e-6 && json.markers.every((m) => m.at_mm)'
mkdir bare && cp pair/cameras.yml pair/*.png bare
succeed "stereo without truth" stereo bare --out space5
holds "stereo without truth: six markers, no pose" space5/stereo.json 'json.markers.length === 6 && json.pose === null && json.pose_refusal !== null && json.rms_error_mm === null'
refuse "stereo: no cameras" 'empty/cameras.yml: no such file; expected cameras.yml' bad stereo empty --out bad
rm bare/right.png
refuse "stereo: no picture" 'right.png: no such file; expected the picture of each camera' bad stereo bare --out bad
cp pair/left.png bare/right.png && sed -i 's/image_width: 640/image_width: 320/' bare/cameras.yml
refuse "stereo: a picture of another size" 'left.png: 640 x 480 px; expected 320 x 480 as in cameras.yml' bad stereo bare --out bad
echo 'no yaml' >bare/cameras.yml
refuse "stereo: cameras.yml that is none" 'bare/cameras.yml: .*; expected' bad stereo bare --out bad
sed 's/"camera": "left"/"camera": "middle"/' detections.json >wrong.json
refuse "stereo: detections of another camera" "camera 'middle'; expected one of left, right" bad stereo pair --detections wrong.json --out bad
sed 's/"marker": 1/"marker": 12/' space1/constellation.json >wrong.json
refuse "stereo: unknown marker in the constellation" '/markers/0/marker: found 12; expected 1, 2' bad stereo pair --constellation wrong.json --out bad
refuse "stereo: unknown point" '--point.*corner.*centre.*light' bad stereo pair --point corner --out bad
succeed "render one camera" render scene/pair.json --camera left --spp 1 --size 64x48 --out single
refuse "stereo: one camera" 'cameras: one; expected at least two' bad stereo single --out bad
succeed "study stereo" study stereo --quick --out loop
holds "study stereo: targets" loop/summary.json 'json.errors.length === 28 && json.targets.length === 12 && json.targets[0].pass'
succeed "study stereo again, 1 thread" study stereo --quick --threads 1 --out loop1
same "study stereo: the same on any number of threads" loop loop1 stereo_error.csv budget.csv summary.json
# Marker 5 is hidden in frames 8 to 11: too short to be lost.
succeed "study motion" study motion --frames 14 --spp 1 --limit 0.01 --out motion
holds "study motion: followed, hidden, back; the alarm" motion/summary.json \
  'json.rms_error_mm < 0.3 && json.hidden.length === 1 && json.hidden[0].marker === 5 && !json.hidden[0].lost && json.hidden[0].back_after_frames === 0 && json.crossing_s > 0 && json.alarm_s !== null'
[ "$(grep -c missed motion/motion.csv)" -eq 4 ] && good "study motion: missed in four frames" ||
  bad "study motion: missed in four frames" "$(cut -d, -f1,16- motion/motion.csv | grep missed | head -5 | tr '\n' ' ')"
[ -s motion/report.html ] && good "study motion: report" || bad "study motion: report" "$(ls motion)"

# ------------------------------------------------------------------------------------------------------ study hotspot
hotspot="study hotspot --angles 3,15 --scene none --variations none --placements 1 --exposures 2 --spp 1"
# shellcheck disable=SC2086
succeed "study hotspot" $hotspot --threads 1 --out hot1
# shellcheck disable=SC2086
succeed "study hotspot on 2 threads" $hotspot --threads 2 --out hot2
same "study hotspot: the same on 2 threads" hot1 hot2 hotspot.csv rings.csv verdict.csv summary.json pictures/default_15_0_neighbours.png
rm hot2/tasks/*.json
# shellcheck disable=SC2086
succeed "study hotspot again" $hotspot --out hot2
same "study hotspot: the same again" hot1 hot2 hotspot.csv rings.csv
holds "study hotspot: the retro-reflective tail is gone at 15 degrees" hot1/summary.json \
  'json.limits.find((l) => l.rings === "both" && l.criterion === "retro tail").limit_deg === 15'
refuse "study hotspot: angles" "--angles: found '2:x:1'; expected FROM:TO:STEP" bad study hotspot --angles 2:x:1 --out bad
refuse "study hotspot: unknown variation" "variation: found 'gold'; expected one of face" bad study hotspot --variations gold --out bad
refuse "study hotspot: unknown mask" "mask: found 'hat'; expected oval or face" bad study hotspot --mask hat --out bad
refuse "study hotspot: a room without a mask" "chessboard" bad study hotspot --scene chessboard --out bad
cat >three.json <<'JSON'
{"schema": "retrolux/scenario-1", "base": "1a", "name": "three", "cameras": {"count": 3, "width_px": 320, "height_px": 240},
 "masks": {"face": {"x_deg": [0], "y_deg": [10], "z_deg": [40, 60]}}, "combinations": {"extra": []}}
JSON
echo '{"placement": {"phi_b_deg": 48, "theta1_deg": 31.67, "theta2_deg": 70.52}}' >placement.json
hotspot="study hotspot --placement placement.json --scenario three.json --rotations 1 --exposures 2 --spp 1"
# shellcheck disable=SC2086
succeed "study hotspot of a placement" $hotspot --threads 1 --out hotv1
# shellcheck disable=SC2086
succeed "study hotspot of a placement on 2 threads" $hotspot --threads 2 --out hotv2
same "study hotspot of a placement: the same on 2 threads" hotv1 hotv2 placement.csv placement_pairs.csv summary.json
[ "$(wc -l <hotv1/placement.csv)" -eq 13 ] && good "placement.csv: 3 cameras x 2 rings x 2 rotations" ||
  bad "placement.csv: 3 cameras x 2 rings x 2 rotations" "$(wc -l <hotv1/placement.csv) lines"
holds "study hotspot of a placement: one rotation of two is rendered" hotv1/summary.json \
  'json.placement.rotations === 2 && json.placement.rotations_rendered_deg.length === 1 && json.limits.length === 0'
refuse "study hotspot: a placement without a simulation" "placement.json: .*no key 'simulation'; expected a built-in simulation" bad study hotspot --placement placement.json --out bad
refuse "study hotspot: no placement" "three.json: .*'placement'" bad study hotspot --placement three.json --out bad
refuse "study hotspot: placement or scene" "--scene excludes --placement" bad study hotspot --placement placement.json --scene ct-room --out bad

# ------------------------------------------------------------------------------------------------------- study layout
succeed "study layout" study layout --poses reference --spp 1 --threads 1 --out layout1
succeed "study layout on 2 threads" study layout --poses reference --spp 1 --threads 2 --out layout2
same "study layout: the same on 2 threads" layout1 layout2 layout.json sightings.csv pairs.csv
holds "study layout: a pair names three" layout1/layout.json \
  'json.margin >= 0 && json.misnamed === 0 && json.markers.length === 6 && json.poses[0].position_error_mm < 1'
[ -s layout1/report.html ] && good "study layout: report" || bad "study layout: report" "$(ls layout1)"
succeed "study layout on the face" study layout --mask face --poses start --spp 1 --out layout-face
holds "study layout on the face: what the search promised" layout-face/layout.json \
  'json.margin + 3 >= json.promised.least_common && json.promised.least_common >= 4'
run scene export ct-room --out ct-room
sed 's/"size": \[640, 480\]/"size": [40, 30]/' ct-room/scene.json >ct-room/corner.json
run study layout --scene ct-room/corner.json --poses reference --out corner
[ $? -eq 2 ] && grep -q "no 6 places let a pair of cameras see three markers" stderr.txt && good "study layout: cameras that see nothing of the mask" ||
  bad "study layout: cameras that see nothing of the mask" "$(head -c 300 stderr.txt)"
refuse "study layout: no mask" "no object 'mask' that moves with the pose" bad study layout --scene sphere --out bad

# --------------------------------------------------------------------------------------------------------------- help
for command in "" bench render scene "scene list" "scene show" "scene export" mask "mask make" "mask sample" "mask import" "mask reconstruct" classify study "study markers" "study vault" material "material fit" goniometer dataset "dataset plan" "dataset run" "dataset status" "dataset verify" "dataset merge" "dataset export" evaluate stereo "study stereo" "study motion" "study layout" "study hotspot"; do
  # shellcheck disable=SC2086
  succeed "help of retrolux $command" $command --help
  [ -s stdout.txt ] || bad "help of retrolux $command" "nothing on stdout"
done
succeed "--version" --version
no_parts "no temporary file is left"

finish
