#!/usr/bin/env bash
# Batches under bad conditions: whatever happens to a run, running it again gives the bytes of an unbroken one, and
# nothing half-written ever has a final name. What this machine can't do (mounts need root) is said in a "skip" line.
#   batch_test.sh RETROLUX_BINARY
set -u
. "$(dirname "$(realpath "$0")")/cli_checks.sh"
RANDOM=20261130  # moments of the kills

skip() { printf 'skip  %s: %s\n' "$1" "$2"; }

cat >batch.json <<'END'
{"schema": "retrolux/dataset-1", "name": "a batch 'by night'", "licence": "CC0-1.0", "scenes": 24, "spp": 4,
 "splits": {"train": 0.5, "test": 0.5}, "masks": [{"mesh": "oval"}],
 "views": [{"kind": "free", "cameras": 3, "distance_mm": [1200, 1600], "incidence_deg": [0, 50]}],
 "markers": {"identifiable": 4, "standard": 2},
 "recording": {"size_px": [160, 120], "sensor": "default"}}
END
plan() { run dataset plan batch.json --out "$1" || { bad "plan $1" "$(cat stderr.txt)"; exit 1; }; }

# What must not depend on how it was run: all but the log of the run, and the lock.
listing() { (cd "$1" && find . -type f ! -name run.json ! -name .lock ! -path './jobs/*' ! -name template.json | sort | xargs md5sum); }
# as_whole NAME FOLDER: the folder has the files of the unbroken run, to the byte, and no others.
as_whole() {
  if diff <(listing whole) <(listing "$2") >diff.txt; then good "$1"; else bad "$1" "$(head -4 diff.txt | tr '\n' '|')"; fi
}
# exits NAME CODE ARGS...: the exit code of the program.
exits() {
  local name=$1 expected=$2 code
  shift 2
  run "$@"
  code=$?
  if [ $code -eq "$expected" ]; then good "$name"
  else bad "$name" "exit code $code, not $expected: $(head -c 300 stderr.txt | tr '\n' '|')"; fi
}
# says NAME FILE PATTERN
says() { if grep -qE -- "$3" "$2"; then good "$1"; else bad "$1" "no /$3/ in: $(head -c 300 "$2" | tr '\n' '|')"; fi; }

plan whole
succeed "an unbroken run on one thread" dataset run whole --threads 1
exits "verify: all is there" 0 dataset verify whole
succeed "the same again" dataset run whole
says "skipped N of M" stdout.txt 'skipped 24 of 24 tasks \(done before\)'

# ------------------------------------------------------------------------------------------------- killed at any moment
# 50 times kill -9; whenever a folder is done in spite of it, the next one.
kills=0 folders=0 early=0
plan killed0
while [ $kills -lt 50 ]; do
  "$retrolux" dataset run killed$folders --threads 2 >stdout.txt 2>stderr.txt </dev/null &
  pid=$!
  sleep "$(printf '0.%03d' $((RANDOM % 900 + 20)))"
  if kill -KILL $pid 2>/dev/null; then kills=$((kills + 1)); else early=$((early + 1)); fi
  wait $pid 2>/dev/null
  if [ -e killed$folders/card.md ] && [ -e killed$folders/report.html ]; then
    folders=$((folders + 1))
    plan killed$folders
  fi
done
worse=0
for ((i = 0; i <= folders; ++i)); do
  run dataset run killed$i || worse=$((worse + 1))
  diff <(listing whole) <(listing killed$i) >diff.txt || worse=$((worse + 1))
done
[ $worse -eq 0 ] && good "50 times kill -9 over $((folders + 1)) sets, then to the end: the bytes of an unbroken run" ||
  bad "50 times kill -9" "$worse of $((folders + 1)) sets: $(head -3 diff.txt | tr '\n' '|')"

# --------------------------------------------------------------------------------------------------------- asked to end
# ends NAME SIGNAL CODE: within two seconds, with that exit code; nothing damaged, nothing left over.
ends() {
  local name=$1 signal=$2 expected=$3 folder=ended_$2 begun ms code
  plan "$folder"
  env --default-signal="$signal" "$retrolux" dataset run "$folder" --threads 2 >stdout.txt 2>stderr.txt </dev/null &
  local pid=$!
  sleep 0.6
  begun=$(date +%s%N)
  kill -"$signal" $pid
  wait $pid
  code=$?
  ms=$((($(date +%s%N) - begun) / 1000000))
  if [ $code -ne "$expected" ]; then bad "$name" "exit code $code, not $expected: $(head -c 300 stderr.txt)"
  elif [ $ms -gt 2000 ]; then bad "$name" "after $ms ms"
  elif [ -n "$(find "$folder" -name '*.part*')" ]; then bad "$name" "left $(find "$folder" -name '*.part*' | head -3)"
  else good "$name"; fi
  exits "$name: nothing damaged" 4 dataset verify "$folder"
  says "$name: verify" stdout.txt ', 0 damaged, '
  run dataset run "$folder"
  as_whole "$name: goes on" "$folder"
}
ends "SIGTERM" TERM 143
ends "SIGINT" INT 130
ends "SIGHUP" HUP 129
# One long picture: the end does not wait for the task.
run scene export oval --out scene
"$retrolux" render scene --spp 20000 --out slow >stdout.txt 2>stderr.txt </dev/null &
pid=$!
sleep 1.5
begun=$(date +%s%N)
kill -TERM $pid
wait $pid
code=$?
ms=$((($(date +%s%N) - begun) / 1000000))
[ $code -eq 143 ] && [ $ms -lt 2000 ] && [ -z "$(find slow -type f)" ] && good "SIGTERM amid one long picture" ||
  bad "SIGTERM amid one long picture" "exit code $code after $ms ms; $(find slow -type f | head -3)"

# ---------------------------------------------------------------------------------------------------- no room, no right
plan full
(ulimit -f 6 && limit_s=60 run dataset run full)  # KiB: smaller than most pictures
code=$?
[ $code -eq 75 ] && good "files that may not grow: try again" || bad "files that may not grow: try again" "exit code $code: $(head -c 300 stderr.txt)"
says "it says which file" stderr.txt 'full/.*File too large'
[ -z "$(find full -name '*.part*')" ] && good "no half-written file" || bad "no half-written file" "$(find full -name '*.part*')"
run dataset run full
as_whole "with room: goes on" full
if unshare -m true 2>/dev/null; then
  plan disk
  unshare -m bash -c "mkdir -p small && mount -t tmpfs -o size=400k tmpfs small && cp -r disk/. small/ &&
    '$retrolux' dataset run small >stdout.txt 2>stderr.txt; echo \$? >code.txt; '$retrolux' dataset verify small >verified.txt 2>&1; cp -r small/. disk/"
  [ "$(cat code.txt)" = 75 ] && good "a full disk: try again" || bad "a full disk: try again" "exit code $(cat code.txt): $(head -c 300 stderr.txt)"
  says "it says so" stderr.txt 'No space left on device'
  says "nothing damaged on the full disk" verified.txt ', 0 damaged, '
  run dataset run disk
  as_whole "with a larger disk: goes on" disk
  plan readonly
  unshare -m bash -c "mount --bind readonly readonly && mount -o remount,ro,bind readonly &&
    '$retrolux' dataset run readonly >stdout.txt 2>stderr.txt; echo \$? >code.txt; '$retrolux' dataset status readonly >status.txt"
  [ "$(cat code.txt)" = 2 ] && good "a read-only folder is refused" || bad "a read-only folder is refused" "exit code $(cat code.txt)"
  says "it says so" stderr.txt 'Read-only file system.*expected a place that can be written to'
  says "status of a read-only folder" status.txt '0 of 24 scenes are done'
else
  skip "full disk, read-only folder" "no right to mount (root only)"
fi

# ------------------------------------------------------------------------------------------------- what was there is gone
run mask make oval --out egg.glb
sed 's/"oval"/"egg.glb"/' batch.json >egg.json
run dataset plan egg.json --out egg
rm egg/egg.glb
exits "an input that is gone" 2 dataset run egg
says "it says which" stderr.txt 'egg/egg.glb'
plan damaged
run dataset run damaged
picture=$(find damaged/images -name '*.png' | sort | sed -n 5p)
result=$(find damaged/tasks -name '[0-9a-f]*.json' | sort | sed -n 9p)
printf 'X' | dd of="$picture" bs=1 seek=300 conv=notrunc 2>/dev/null
printf 'X' | dd of="$result" bs=1 seek=900 conv=notrunc 2>/dev/null
exits "verify: damage" 3 dataset verify damaged
says "verify: damaged picture" stderr.txt "${picture#damaged/}: not what was written"
says "verify: damaged result" stderr.txt "$result: damaged"
run dataset run damaged
says "what is damaged is made again" stdout.txt 'skipped 22 of 24 tasks'
as_whole "made again" damaged

# ------------------------------------------------------------------------------------------------- several at once, parts
plan shared
pids=()
for _ in 1 2 3; do
  "$retrolux" dataset run shared --threads 1 --json >shared_${#pids[@]}.json 2>stderr_${#pids[@]}.txt </dev/null &
  pids+=($!)
done
codes=""
for pid in "${pids[@]}"; do wait "$pid"; codes+=$?; done
[ $codes = 000 ] && good "three runs on one folder at once" || bad "three runs on one folder at once" "exit codes $codes: $(cat stderr_*.txt)"
done_now=$(node -e 'let n = 0; for (const i of [0, 1, 2]) n += JSON.parse(fs.readFileSync(`shared_${i}.json`)).tasks.done_now; console.log(n)')
[ "$done_now" = 24 ] && good "no scene was done twice" || bad "no scene was done twice" "$done_now done"
as_whole "what they made" shared

for i in 1 2 3; do
  plan part$i
  run dataset run part$i --shard $i/3
done
exits "merge of two parts of three" 4 dataset merge part1 part3
says "it says what is missing" stderr.txt 'not done: scene-00001 \(number 1\)'
exits "merge of all" 0 dataset merge part1 part2 part3
as_whole "merged" part1
sed 's/"spp": 4/"spp": 5/' batch.json >other.json
run dataset plan other.json --out other
exits "merge with another plan" 2 dataset merge part1 other
says "it says what differs" stderr.txt '/spp was 4, is 5'
exits "a changed config is refused" 2 dataset plan other.json --out part1
says "it says what changed" stderr.txt '/config/spp was 4, is 5'
exits "other samples are refused" 2 dataset run part1 --spp 7
says "it says what changed" stderr.txt '/spp was 4, is 7'

sed 's/"scenes": 24/"scenes": 2/' batch.json >two.json
run dataset plan two.json --out channels --keep-exr
exits "what is planned with --keep-exr" 0 dataset run channels
[ "$(find channels/exr -name '*.exr' | wc -l)" = 6 ] && good "keeps all channels" || bad "keeps all channels" "$(ls channels/exr)"
truncate -s -100 channels/exr/scene-00001_camera-2.exr
exits "verify: a damaged EXR file" 3 dataset verify channels
says "it says which" stderr.txt 'scene-00001 \(number 1\): exr/scene-00001_camera-2.exr: not what was written'

plan limited
exits "the time is over" 75 dataset run limited --threads 1 --time-limit 0.2s
says "it says so" stdout.txt 'the time was over before [0-9]+ of 24'
run dataset run limited
as_whole "after the time limit: goes on" limited

plan begun
exits "no time at all: nothing is begun" 75 dataset run begun --time-limit 0s
says "it says so" stdout.txt 'the time was over before 24 of 24'
exits "a time limit below zero" 2 dataset run limited --time-limit=-5min
exits "a scene that there is not" 2 dataset run limited --tasks 3,24
says "it says which there are" stderr.txt 'there are 24; expected numbers from 0 to 23'

# Other options while somebody is at work and has no result yet.
sed 's/"spp": 4/"spp": 3000/; s/"scenes": 24/"scenes": 3/' batch.json >slow.json
run dataset plan slow.json --out mixed
"$retrolux" dataset run mixed --threads 1 >other_stdout.txt 2>other_stderr.txt </dev/null &
pid=$!
sleep 0.7
exits "other samples beside a run without results" 2 dataset run mixed --spp 5
says "it says so" stderr.txt 'another process is at other work here; .*/spp was 3000, is 5'
sed 's/"spp": 3000/"spp": 6/' slow.json >slow_too.json
exits "another plan beside a run without results" 2 dataset plan slow_too.json --out mixed
cmp -s mixed/config.json slow.json && good "its config is still there" || bad "its config is still there" "replaced"
kill -TERM $pid
wait $pid

# dataset.json is looked at by bytes, and missed.
cp -r whole indexed
sed -i 's/CC0-1.0/CC0-1.1/' indexed/dataset.json
exits "verify: a changed index" 3 dataset verify indexed
truncate -s -10 indexed/dataset.json
exits "verify: an index cut off" 3 dataset verify indexed
rm indexed/dataset.json
exits "verify: no index" 4 dataset verify indexed
says "it says so" stderr.txt 'not done: dataset.json'

# A damaged copy is passed over if another folder has the scene whole.
for i in 1 2; do
  plan copy$i
  cp -r part2/tasks part2/images copy$i/
done
plan target
cp -r part1/tasks part1/images target/
victim=$(node -e 'console.log(JSON.parse(fs.readFileSync("whole/dataset.json")).scenes[4].pictures[0].file)')
for folder in copy1 target; do rm -f "$folder/$victim"; printf 'no picture' >"$folder/$victim"; done
exits "merge: only a damaged copy" 3 dataset merge target copy1
says "it says which" stderr.txt 'copy1: scene-00004 .*not taken'
exits "merge: another copy is whole" 0 dataset merge target copy1 copy2
as_whole "what was merged" target

# ------------------------------------------------------------------------------------------------ nobody reads, no room to tell
plan unread
"$retrolux" dataset run unread --threads 2 --progress json 2> >(head -1 >/dev/null) >stdout.txt </dev/null &&
  good "a log whose reader has gone" || bad "a log whose reader has gone" "exit code $?"
as_whole "what it made" unread
(sleep 0.2; "$retrolux" dataset status whole 2>stderr.txt; echo $? >code.txt) | true
sleep 0.5
[ "$(cat code.txt)" = 0 ] && good "a result that nobody reads" || bad "a result that nobody reads" "exit code $(cat code.txt)"
"$retrolux" dataset status nowhere 2>/dev/full >stdout.txt
[ $? -eq 2 ] && good "an error that can't be told" || bad "an error that can't be told" "another exit code"
"$retrolux" dataset verify whole --json >/dev/full 2>stderr.txt
[ $? -eq 75 ] && good "a result without room" || bad "a result without room" "another exit code"
timeout 20 env --ignore-signal=CHLD "$retrolux" dataset verify nowhere >stdout.txt 2>stderr.txt
[ $? -eq 2 ] && good "a launcher that ignores children" || bad "a launcher that ignores children" "another exit code"
if unshare -m true 2>/dev/null; then
  plan loud
  unshare -m bash -c "mkdir -p tiny && mount -t tmpfs -o size=4k tmpfs tiny && head -c 3800 /dev/zero >tiny/log &&
    '$retrolux' dataset run loud --threads 3 --progress json 2>>tiny/log >stdout.txt; echo \$? >code.txt"
  [ "$(cat code.txt)" = 0 ] && good "a log on a full disk" || bad "a log on a full disk" "exit code $(cat code.txt)"
  as_whole "what it made" loud
fi
wrong=0
plan early
for ((i = 0; i < 40; ++i)); do
  "$retrolux" dataset run early --tasks 0 --threads 1 >stdout.txt 2>stderr.txt </dev/null &
  pid=$!
  sleep "0.0$((i % 10))$((RANDOM % 10))"
  kill -TERM $pid 2>/dev/null
  wait $pid
  case $? in 0 | 143) ;; *) wrong=$((wrong + 1)) ;; esac
  rm -rf early/tasks/[0-9a-f]*.json early/images/*
done
[ $wrong -eq 0 ] && good "SIGTERM at 40 moments of the beginning: 143" || bad "SIGTERM at the beginning" "$wrong of 40: $(cat stderr.txt)"

# ------------------------------------------------------------------------------------------------------- clocks that jump
if command -v faketime >/dev/null; then
  plan clock
  faketime -f '+10y' "$retrolux" dataset run clock --shard 1/3 >stdout.txt 2>stderr.txt || bad "a clock ahead" "$(cat stderr.txt)"
  faketime -f '-30y' "$retrolux" dataset run clock --shard 2/3 >stdout.txt 2>stderr.txt || bad "a clock behind" "$(cat stderr.txt)"
  faketime -f '+0 x300' "$retrolux" dataset run clock >stdout.txt 2>stderr.txt || bad "a clock that runs" "$(cat stderr.txt)"
  as_whole "clocks ten years ahead, thirty behind, 300 times as fast" clock
else
  skip "clocks that jump" "no faketime"
fi

# ------------------------------------------------------------------------------------------------------ tasks that fail
if "${CC:-cc}" -shared -fPIC -o fault.so "$tests/rename_fault.c" -ldl 2>cc.txt; then
  plan crash
  FAULT=crash FAULT_AT=scene-00003_ LD_PRELOAD=$work/fault.so exits "a task that crashes always" 4 dataset run crash --threads 2
  says "it is named" stderr.txt 'scene-00003 \(number 3\): crashed \(Segmentation fault\)'
  run dataset status crash
  says "the others are done" stdout.txt '23 of 24 scenes are done'
  says "status tells it, too" stdout.txt 'failed: scene-00003 \(number 3\): crashed'
  run dataset run crash
  as_whole "when that is mended" crash
  plan fail
  FAULT=fail FAULT_AT=scene-00003_camera-2 LD_PRELOAD=$work/fault.so exits "a task that fails" 4 dataset run fail
  says "it is named" stderr.txt 'scene-00003 \(number 3\): .*Permission denied'
  run dataset run fail
  as_whole "when that is mended" fail
else
  skip "tasks that fail" "no C compiler: $(head -1 cc.txt)"
fi
plan struck
"$retrolux" dataset run struck --threads 2 >stdout.txt 2>stderr.txt </dev/null &
pid=$!
for ((i = 0; i < 200 && $(find struck/tasks -name '[0-9a-f]*.json' | wc -l) < 3; ++i)); do sleep 0.05; done
pkill -SEGV -P $pid
wait $pid
[ $? -eq 0 ] && good "a process that dies once is replaced" || bad "a process that dies once is replaced" "$(head -c 300 stderr.txt)"
says "it says so" stderr.txt 'crashed \(Segmentation fault\); going on'
as_whole "what both made" struck
# The time limit is the program's, whatever it got over: struck at 2.5 s of 3 s, it ends before 5.5 s.
sed 's/"spp": 4/"spp": 30/; s/"scenes": 24/"scenes": 200/' batch.json >longer.json
run dataset plan longer.json --out struck_late
begun=$(date +%s%N)
"$retrolux" dataset run struck_late --threads 1 --time-limit 3s >stdout.txt 2>stderr.txt </dev/null &
pid=$!
sleep 2.5
pkill -SEGV -P $pid
wait $pid
code=$? ms=$((($(date +%s%N) - begun) / 1000000))
[ $code -eq 75 ] && [ $ms -lt 5400 ] && good "a time limit across a crash" || bad "a time limit across a crash" "exit code $code after $ms ms"

# ------------------------------------------------------------------------------------------------------ logs and threads
plan logged
SLURM_CPUS_PER_TASK=1 limit_s=60 run dataset run logged --progress json
node -e 'const lines = fs.readFileSync("stderr.txt", "utf8").trim().split("\n").map((l) => JSON.parse(l));
  const end = lines.at(-1); process.exit(lines[0].threads === 1 && /SLURM|affinity/.test(lines[0].threads_from) && end.finished && end.done === 24 ? 0 : 1)' &&
  good "progress as JSON lines, with the threads" || bad "progress as JSON lines, with the threads" "$(head -2 stderr.txt)"
says "threads on stdout" stdout.txt 'on 1 thread \((SLURM_CPUS_PER_TASK|CPU affinity)\)'

# ------------------------------------------------------------------------------------------------------- other engines
for engine in slurm openjd parallel; do
  exits "plan --emit $engine" 0 dataset plan batch.json --out emit_$engine --emit $engine
done
says "a job's name is plain" emit_slurm/jobs/slurm/shard.sh '^#SBATCH --job-name=a_batch__by_night_$'
says "a set of less than a minute is one shard" emit_slurm/jobs/slurm/shard.sh '^#SBATCH --array=1-1$'
for script in emit_slurm/jobs/slurm/*.sh emit_parallel/jobs/parallel/run.sh; do
  bash -n "$script" && [ -x "$script" ] || bad "script $script" "not a script that can be run"
done
export RETROLUX=$retrolux
if command -v parallel >/dev/null; then
  emit_parallel/jobs/parallel/run.sh >stdout.txt 2>stderr.txt || bad "GNU parallel" "$(head -c 300 stderr.txt)"
  as_whole "GNU parallel" emit_parallel
  run dataset plan batch.json --out emit_refused --emit parallel --shards 1
  emit_refused/jobs/parallel/run.sh --no-such-option >stdout.txt 2>stderr.txt
  [ $? -ne 0 ] && ! grep -q 'scenes checked' stdout.txt && good "an option that parallel refuses: no merge" ||
    bad "an option that parallel refuses: no merge" "$(tail -1 stdout.txt)"
  mkdir "my tools" && cp "$retrolux" "my tools/retrolux"
  run dataset plan batch.json --out emit_spaced --emit parallel --shards 1
  rm -rf emit_spaced/tasks/[0-9a-f]*.json
  RETROLUX_DATA=${RETROLUX_DATA:-$(dirname "$tests")} RETROLUX="$work/my tools/retrolux" emit_spaced/jobs/parallel/run.sh >stdout.txt 2>stderr.txt ||
    bad "a program in a folder with a space" "$(head -c 300 stderr.txt)"
  as_whole "a program in a folder with a space" emit_spaced
else
  skip "GNU parallel" "not there"
fi
node "$tests/openjd_run.mjs" emit_openjd/template.json >stdout.txt 2>stderr.txt || bad "Open Job Description" "$(head -c 300 stderr.txt)"
as_whole "Open Job Description: steps in their order, a task for each shard" emit_openjd
no_parts "no temporary file is left"
finish
