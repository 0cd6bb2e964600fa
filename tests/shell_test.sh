#!/usr/bin/env bash
# What the program prints for shells and man: TAB is pressed in bash, zsh and fish, and the manual is formatted.
#   shell_test.sh RETROLUX_BINARY
. "$(dirname "$(realpath "$0")")/cli_checks.sh"

# The subcommands of a command, one a line, as --help tells them.
subcommands() { "$retrolux" "$@" --help | sed '1,/^Subcommands:/d' | grep -oE '^  [a-z-]+' | tr -d ' '; }
# The long options of a command, likewise.
options() { "$retrolux" "$@" --help | grep -oE '^ +(-.,)?--[a-z0-9-]+' | grep -oE -- '--.*' | sort; }

expect() { if [ "$2" = "$3" ]; then good "$1"; else bad "$1" "found '$2', expected '$3'"; fi; }

for shell in bash zsh fish; do
  succeed "completion $shell" completion $shell && cp stdout.txt retrolux.$shell
done
refuse "completion of an unknown shell" 'SHELL.*csh.*bash' bad completion csh
touch a-file

# ------------------------------------------------------------------------------------------------------------- bash
# tab WORDS...: bash's replies, on one line, when TAB is pressed in the last word.
tab() {
  bash -uc '. ./retrolux.bash
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _retrolux
    [ ${#COMPREPLY[@]} -eq 0 ] || printf "%s\n" "${COMPREPLY[@]}"' bash "$@" 2>&1 | paste -sd ' '
}
expect "bash: subcommands" "$(tab retrolux '')" "$(subcommands | paste -sd ' ')"
expect "bash: subcommands of study" "$(tab retrolux study '')" "$(subcommands study | paste -sd ' ')"
expect "bash: a subcommand after an option and its value" "$(tab retrolux --progress json study mar)" markers
expect "bash: an option" "$(tab retrolux --prog)" --progress
expect "bash: an option of the program after a subcommand" "$(tab retrolux study markers --noi)" --noise-seed
expect "bash: choices" "$(tab retrolux study markers --method '')" "edges robust"
expect "bash: choices of an option of the program" "$(tab retrolux study markers --progress j)" json
expect "bash: choices that the program refuses itself" "$(tab retrolux classify --method rob)" robust
expect "bash: a choice after =" "$(tab retrolux study markers --method = r)" robust
expect "bash: all choices after =" "$(tab retrolux study markers --method =)" "edges robust"
expect "bash: choices without an option" "$(tab retrolux completion '')" "bash zsh fish"
expect "bash: files are left to bash" "$(tab retrolux render --out '')$(tab retrolux render '')" ""
for command in "study vault" render "dataset run"; do
  # shellcheck disable=SC2086
  missed=$(comm -23 <(options $command) <(tab retrolux $command -- | tr ' ' '\n' | sort))
  expect "bash: every option of $command" "$missed" ""
done
expect "bash: files where nothing else is known" "$(bash -c '. ./retrolux.bash; complete -p retrolux')" \
  "complete -o default -F _retrolux retrolux"

# -------------------------------------------------------------------------------------------------------------- zsh
if command -v zsh >/dev/null; then
  cp retrolux.zsh _retrolux
  zsh_tab() { timeout 30 zsh -f "$tests/zsh_tab.zsh" "$1" 2>&1 | paste -sd ' '; }
  expect "zsh: subcommands of study" "$(zsh_tab 'retrolux study ')" "$(subcommands study | sort | paste -sd ' ')"
  expect "zsh: an option of the program" "$(zsh_tab 'retrolux study markers --prog')" --progress
  expect "zsh: choices" "$(zsh_tab 'retrolux study markers --method ')" "edges robust"
  expect "zsh: choices without an option" "$(zsh_tab 'retrolux completion ')" "bash fish zsh"
  expect "zsh: a file of an option" "$(zsh_tab 'retrolux study markers --out a-')" a-file
  expect "zsh: a file" "$(zsh_tab 'retrolux render a-')" a-file
else
  echo "skip  zsh is not installed"
fi

# ------------------------------------------------------------------------------------------------------------- fish
if command -v fish >/dev/null; then
  fish_tab() {
    HOME=$work fish --no-config -c "source retrolux.fish; complete -C '$1'" 2>&1 | cut -f1 | sort | paste -sd ' '
  }
  expect "fish: subcommands of study" "$(fish_tab 'retrolux study ')" "$(subcommands study | sort | paste -sd ' ')"
  expect "fish: an option of the program" "$(fish_tab 'retrolux study markers --prog')" --progress
  expect "fish: choices" "$(fish_tab 'retrolux study markers --method ')" "edges robust"
  expect "fish: choices without an option" "$(fish_tab 'retrolux completion ')" "bash fish zsh"
  expect "fish: a file of an option" "$(fish_tab 'retrolux study markers --out a-')" a-file
  expect "fish: a file" "$(fish_tab 'retrolux render a-')" a-file
  expect "fish: no file where there is none" "$(fish_tab 'retrolux study a-')" ""
else
  echo "skip  fish is not installed"
fi

# ----------------------------------------------------------------------------------------------------------- manual
succeed "manual" manual && cp stdout.txt retrolux.1
if command -v groff >/dev/null && command -v man >/dev/null; then
  expect "manual: roff finds nothing wrong" "$(groff -man -ww -z retrolux.1 2>&1)" ""
  expect "manual: man finds nothing wrong" "$(LC_ALL=C.UTF-8 man -l --warnings retrolux.1 2>&1 >manual.txt)" ""
  LC_ALL=C.UTF-8 MANWIDTH=300 man -l retrolux.1 >manual.txt
  sections() { grep -c "^\.SS .*fBretrolux $1.fR" retrolux.1; }
  for command in $(subcommands); do
    expect "manual: $command" "$(sections "$command")" 1
    for sub in $(subcommands "$command"); do
      expect "manual: $command $sub" "$(sections "$command $sub")" 1
    done
  done
  expect "manual: an option, its choices and default" \
    "$(grep -A1 -- '--visibility ids|rays|triangles' manual.txt | grep -c 'default: ids')" 2
else
  echo "skip  groff and man are not installed"
fi

finish
