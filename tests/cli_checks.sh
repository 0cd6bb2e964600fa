# What the scripts that test the command line share; to be sourced with the script's arguments: RETROLUX_BINARY. Each
# case prints a line. All files are in a folder of its own under TMPDIR, removed at the end. Needs node to look into JSON.
# shellcheck shell=bash disable=SC2034
set -u
[ $# -eq 1 ] && [ -x "$1" ] || { echo "usage: $0 RETROLUX_BINARY" >&2; exit 2; }
retrolux=$(realpath "$1")
tests=$(dirname "$(realpath "$0")")
work=$(mktemp -d "${TMPDIR:-/tmp}/retrolux_cli.XXXXXX") || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
failed=0 cases=0

good() { cases=$((cases + 1)); printf 'ok    %s\n' "$1"; }
bad() { cases=$((cases + 1)); failed=$((failed + 1)); printf 'FAIL  %s: %s\n' "$1" "$2"; }

# run ARGS...: the program on files of this folder, with a limit, so that a hang is a failure (exit code 124).
limit_s=120
run() { timeout "$limit_s" "$retrolux" "$@" >stdout.txt 2>stderr.txt </dev/null; }

# refuse NAME PATTERN OUT ARGS...: exit code 2, one line on stderr that matches PATTERN (extended, place before what was
# found before what is expected), nothing on stdout, and nothing at OUT.
refuse() {
  local name=$1 pattern=$2 out=$3 code lines
  shift 3
  limit_s=20 run "$@"
  code=$?
  lines=$(wc -l <stderr.txt)
  if [ $code -ne 2 ]; then bad "$name" "exit code $code, not 2: $(head -c 300 stderr.txt)"
  elif [ "$lines" -ne 1 ]; then bad "$name" "$lines lines on stderr, not 1: $(head -c 300 stderr.txt | tr '\n' '|')"
  elif ! grep -qE -- "$pattern" stderr.txt; then bad "$name" "no /$pattern/ in: $(cat stderr.txt)"
  elif [ -s stdout.txt ]; then bad "$name" "something on stdout: $(head -c 100 stdout.txt)"
  elif [ -e "$out" ]; then bad "$name" "output was left: $(find "$out" | head -3 | tr '\n' ' ')"
  else good "$name"; fi
  rm -rf "$out"
}

# succeed NAME ARGS...: exit code 0 and a silent stderr.
succeed() {
  local name=$1 code
  shift
  run "$@"
  code=$?
  if [ $code -ne 0 ]; then bad "$name" "exit code $code: $(head -c 300 stderr.txt)"; return 1
  elif [ -s stderr.txt ]; then bad "$name" "on stderr: $(head -c 300 stderr.txt)"; return 1
  else good "$name"; fi
}

# same NAME A B FILES...: the files of both folders have the same bytes.
same() {
  local name=$1 a=$2 b=$3 file
  shift 3
  for file in "$@"; do
    [ -s "$a/$file" ] || { bad "$name" "no $a/$file"; return; }
    cmp -s "$a/$file" "$b/$file" || { bad "$name" "$file differs"; return; }
  done
  good "$name"
}

# holds NAME FILE EXPRESSION: a JSON file that is valid and for which the JavaScript EXPRESSION over `json` is true.
holds() {
  if node -e "const json = JSON.parse(require('fs').readFileSync('$2', 'utf8')); process.exit(($3) ? 0 : 1)" >node.txt 2>&1
  then good "$1"; else bad "$1" "not so in $2: $3 $(grep -m1 Error node.txt)"; fi
}

no_parts() {
  local parts
  parts=$(find . -name '*.part*')
  if [ -z "$parts" ]; then good "$1"; else bad "$1" "$parts"; fi
}

# The last line of a script: what came out, and the exit code.
finish() {
  echo "$(basename "$0"): $cases cases, $failed failed"
  [ $failed -eq 0 ]
}
