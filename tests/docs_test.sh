#!/usr/bin/env bash
# What the documentation says is so: every command of README.md and docs/*.md is run with the built program, in the order of its page;
# commands too long for a test run in a shorter form of the same subcommand with the same options (tests/docs_commands.txt). A command that is neither
# run nor in that table fails, and so does a line of the table that no page has. Beside that: README's table names every subcommand;
# options that pages mention exist; links between pages lead somewhere. Prints a line for each case; exit 1 if one fails.
#   docs_test.sh RETROLUX_BINARY [PAGE...]      pages, e.g. quick-start, to run only their commands
set -u
only=("${@:2}")
set -- "${1:-}"
. "$(dirname "$(realpath "$0")")/cli_checks.sh"
top=$(dirname "$tests")
limit_s=120
mkdir bin && ln -s "$retrolux" bin/retrolux
PATH=$work/bin:$PATH
export RETROLUX_DATA=${RETROLUX_DATA:-$top}
pages=(README.md)
for page in "$top"/docs/*.md; do pages+=("docs/$(basename "$page")"); done

# ---------------------------------------------------------------------------------------- what the program has
# help/COMMAND: its --help, for each subcommand; `leaves`: those that have none below.
mkdir help
: >leaves
helps() {
  local name subcommand
  name=$(echo "$*" | tr ' ' '_')
  # shellcheck disable=SC2086
  retrolux $* --help >"help/${name:-retrolux}" 2>&1 || bad "retrolux $* --help" "$(head -1 "help/${name:-retrolux}")"
  if grep -q '^Subcommands:' "help/${name:-retrolux}"; then
    for subcommand in $(sed -n '/^Subcommands:/,$p' "help/${name:-retrolux}" | grep -oE '^  [a-z][a-z0-9-]*' ); do helps "$@" "$subcommand"; done
  else echo "$*" >>leaves; fi
}
helps
[ "$(wc -l <leaves)" -gt 20 ] && good "--help of $(wc -l <leaves) commands" || bad "--help" "only $(wc -l <leaves) commands"

# has OPTION COMMAND...: COMMAND, or the program as a whole, has the option.
has() {
  local option=$1
  shift
  grep -qE -- "(^|[ ,])$option( |$|:|,)" "help/$(echo "$*" | tr ' ' '_')" help/retrolux 2>/dev/null
}

# ------------------------------------------------------------------------------------ README's table of commands
# Lines `retrolux A B | C ARGS --option   description`: prints "A B<tab>options" and "A C<tab>options".
sed -n '/^## What it does/,/^## /p' "$top/README.md" | grep -E '^ +retrolux ' | sed -E 's/^ +//; s/  .*//' | while read -r _ first rest; do
  options=$(echo "$rest" | grep -oE -- '--[a-z-]+' | tr '\n' ' ')
  words=$(echo "$rest" | sed -E 's/ --.*//; s/[A-Z.].*//; s/ *\| */ /g')
  if grep -q '^Subcommands:' "help/$first"; then for word in $words; do printf '%s %s\t%s\n' "$first" "$word" "$options"; done
  else printf '%s\t%s\n' "$first" "$options"; fi
done >table
while IFS=$'\t' read -r command options; do
  missing=
  grep -qxF -- "$command" leaves || missing=" no such command"
  for option in $options; do has "$option" "$command" || missing+=" no $option"; done
  [ -z "$missing" ] || bad "README: retrolux $command" "$missing"
done <table
while read -r command; do
  cut -f1 table | grep -qxF -- "$command" || bad "README's table" "retrolux $command is not in it"
done <leaves
good "README's table: $(cut -f1 table | sort -u | wc -l) commands"

# --------------------------------------------------------------------------------------------- options and links
# Options of others: Slurm's, GNU parallel's, CMake's, ctest's, docker's, retired ones of a page's history.
foreign=' --partition --time --jobs --sshloginfile --wait --preset '
for page in "${pages[@]}"; do
  for option in $(grep -oE '`[^`]*`' "$top/$page" | grep -oE -- '(^|[` ])--[a-z][a-z-]+' | tr -d '` ' | sort -u); do
    [[ $foreign == *" $option "* ]] && continue
    grep -qE -- "(^|[ ,])$option( |$|:|,)" help/* || bad "$page" "mentions $option, which no command has"
  done
done
good "options that the pages mention"

# anchors PAGE: the anchors of its headings, as GitHub makes them.
anchors() { grep -E '^#+ ' "$1" | sed -E 's/^#+ //' | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'; }
for page in "${pages[@]}"; do
  # shellcheck disable=SC2016
  sed 's/`[^`]*`//g' "$top/$page" | grep -oE '\]\([^)]+\)' | sed 's/^](//; s/)$//' | sort -u >links
  while read -r link; do
    case $link in http*) continue ;; esac
    file=${link%%#*}
    target=$top/$(dirname "$page")/$file
    [ -n "$file" ] || target=$top/$page
    if [ ! -e "$target" ]; then bad "$page" "a link to $link, which is not there"
    elif [[ $link == *#* ]] && ! anchors "$target" | grep -qxF -- "${link#*#}"; then bad "$page" "no heading for $link"; fi
  done <links
done
good "links between the pages"
for page in "${pages[@]}"; do
  [ "$page" = README.md ] || [ "$page" = docs/README.md ] || grep -q "($(basename "$page"))" "$top/docs/README.md" || bad "docs/README.md" "does not list $page"
done
good "docs/README.md lists every page"
# Files of the source tree that pages name.
for page in "${pages[@]}"; do
  # shellcheck disable=SC2016
  for file in $(grep -oE '`(core|materials|scenes|renderer|classifier|analysis|cli|tests|bench|scripts|fuzz|docs)/[A-Za-z0-9_./-]+\.[a-z]+`' "$top/$page" | tr -d '`' | sort -u); do
    [[ $file =~ (NAME|TYPE|SUBJECT) ]] || [ -e "$top/$file" ] || bad "$page" "names $file, which is not there"
  done
done
good "files that the pages name"

# ---------------------------------------------------------------------------------------------------- the commands
# commands PAGE: one a line, of its indented or fenced blocks; README's table apart. Continued lines are joined.
commands() {
  awk '
    FILENAME ~ /README.md$/ && /^## / { table = /^## What it does/ }
    /^ *```/ { fenced = !fenced; next }
    !(fenced || /^    /) || table { next }
    { line = joined $0; joined = "" }
    line ~ /\\$/ { sub(/ *\\$/, " ", line); joined = line; next }
    {
      sub(/^ +/, "", line)
      if (line ~ /^(retrolux|cp|mkdir|sed|export|node|cmake|cpack|ctest|docker|man) / || line ~ /^(scripts|bench|build\/release|\/[a-z]+)\/[^ ]/ || line ~ /^[0-9*]+ [0-9*]+ \* \* \* /) print line
    }' "$1" | grep -v '^retrolux:'
}

# The table: `PAGE: DOCUMENTED` and below it, indented, what is run instead; `~` for PAGE's folder is where it runs.
declare -A instead=() used=()
key=
while IFS= read -r line; do
  case $line in
    '#'* | '') ;;
    ' '*) instead[$key]+="${line#"${line%%[! ]*}"}"$'\n' ;;
    *) key=$line; instead[$key]= ;;
  esac
done <"$tests/docs_commands.txt"

# What a command of ours is about: subcommand words and options, sorted, to compare both forms.
essence() {
  local words=() word
  for word in $1; do
    case $word in
      retrolux | */retrolux) ;;
      --*) words+=("$word") ;;
    esac
  done
  printf '%s\n' "${words[@]}" | sort -u
}
subcommand() {
  local name= word
  for word in ${1#*retrolux }; do
    [ -e "help/$(echo "$name $word" | sed 's/^ //' | tr ' ' '_')" ] || break
    name="${name:+$name }$word"
  done
  echo "$name"
}

# One page's commands, in order, in its folder; a case each in PAGE.log.
run_page() {
  local page=$1 folder=$2 documented command text comment option name started code lacking
  mkdir -p "$folder/build/release/cli" "$folder/out"
  for name in docs scenes materials bench scripts tests; do [ -e "$folder/$name" ] || ln -s "$top/$name" "$folder/$name"; done
  [ -e "$folder/build/release/cli/retrolux" ] || ln -s "$retrolux" "$folder/build/release/cli/retrolux"
  while IFS= read -r documented; do
    text=$(echo "$documented" | sed -E 's/ +#.*$//')
    comment=${documented#"$text"}
    name=$(subcommand "$text")
    for option in $(echo "$comment" | grep -oE -- '--[a-z][a-z-]+'); do
      [ -z "$name" ] || has "$option" "$name" || bad "$page: $text" "its comment mentions $option, which 'retrolux $name' does not have"
    done
    command=$text
    if [ -n "${instead["$page: $text"]+there}" ]; then
      command=${instead["$page: $text"]}
      echo "$page: $text" >>"$work/used"
      if [ -n "$name" ] && [[ $command == *retrolux* ]]; then
        lacking=$(comm -23 <(essence "$text") <(essence "$command") | tr '\n' ' ')
        [ -z "${lacking// /}" ] || bad "$page: $text" "what is run instead lacks $lacking"
        grep -qF "retrolux $name" <<<"$command" || bad "$page: $text" "what is run instead is another command"
      fi
    elif [ -z "$name" ] && [[ ! $text =~ ^(cp|mkdir|sed|export|node)\  ]]; then
      bad "$page: $text" "neither can this be run nor is it in tests/docs_commands.txt"
      continue
    fi
    started=$EPOCHREALTIME
    (cd "$folder" && timeout "$limit_s" bash -euc "$command") >"$folder/stdout.txt" 2>"$folder/stderr.txt" </dev/null
    code=$?
    if [ $code -eq 0 ]; then good "$page: $text ($(((${EPOCHREALTIME/./} - ${started/./}) / 1000)) ms)"
    else bad "$page: $text" "exit code $code of '$(echo "$command" | head -1)': $(tail -n 2 "$folder/stderr.txt" | tr '\n' ' ' | head -c 400)"; fi
  done < <(commands "$top/$page")
  echo "$cases $failed" >"$work/$(basename "$page" .md).count"
}

# Pages that go on where another one ended share its folder; the others run beside each other.
wanted() { [ ${#only[@]} -eq 0 ] || [[ " ${only[*]} " == *" $1 "* ]]; }
chain() {
  local folder=$1 page
  shift
  cases=0 failed=0
  for page in "$@"; do run_page "$page" "$work/$folder"; done
  echo "$cases $failed" >"$work/$folder.count"
}
: >used
chains=()
if wanted quick-start || wanted guide; then chains+=("rig docs/quick-start.md docs/guide.md"); fi
for page in "${pages[@]}"; do
  name=$(basename "$page" .md)
  [ "$page" = docs/README.md ] && name=index
  case $name in quick-start | guide) continue ;; esac
  wanted "$name" && [ -n "$(commands "$top/$page")" ] && chains+=("$name $page")
done
running=0
for entry in "${chains[@]}"; do
  # shellcheck disable=SC2086
  chain $entry >"${entry%% *}.log" &
  running=$((running + 1))
  if [ $running -ge 2 ]; then wait -n; running=$((running - 1)); fi
done
wait
for entry in "${chains[@]}"; do
  cat "${entry%% *}.log"
  read -r c f <"${entry%% *}.count" || { c=0 f=1; }
  cases=$((cases + c)) failed=$((failed + f))
done
if [ ${#only[@]} -eq 0 ]; then
  for key in "${!instead[@]}"; do
    grep -qxF -- "$key" used || bad "tests/docs_commands.txt" "no page has: $key"
  done
fi
no_parts "no temporary file is left"
finish
