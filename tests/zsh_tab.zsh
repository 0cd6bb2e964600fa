# TAB at the prompt of a zsh: prints what is offered, a line each. Works in a folder that has _retrolux.
#   zsh -f zsh_tab.zsh LINE
zmodload zsh/zpty
cat >setup.zsh <<'SETUP'
fpath=($PWD $fpath)
autoload -Uz compinit
compinit -u -d ./zcompdump
# What completion offers goes through compadd; with -O, -A or -D it only asks.
compadd() {
  if [[ ${@[1,(i)(-|--)]} != *-(O|A|D)\ * ]]; then
    local -a offered
    builtin compadd -A offered "$@"
    print -lr -- $offered >>offered.txt
  fi
  builtin compadd "$@"
}
zle-line-init() { : >prompt }
zle -N zle-line-init
SETUP

wait_for() { repeat 100; do [[ ! -e $1 ]] || return 0; sleep 0.1; done; print "no $1 after 10 s"; exit 1 }
rm -f prompt ready
: >offered.txt
zpty shell zsh -f -i
zpty -w shell '. ./setup.zsh'
wait_for prompt
zpty -wn shell "$1"$'\t\025: >ready\n' # TAB, away with the line, and tell
wait_for ready
sort -u offered.txt
