# SPDX-License-Identifier: Apache-2.0
# completion.sh PROGRAM: what the program writes for shells and for man is read by them without complaint, and completes
# in them. The options to expect are those of the help. Shells that are missing are skipped, loudly.
set -euo pipefail
program=$(realpath "$1")
readonly program
work=$(mktemp -d)
readonly work
trap 'rm -rf "$work"' EXIT
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
present() { command -v "$1" >/dev/null || { echo "SKIP: completion: no $1"; return 1; }; }

# Every option that the help of a command names.
options() { # COMMAND...
  "$program" "$@" -h | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr , '\n'
}

# Lines of the first list are among those of the second one.
within() { # WHAT LIST LIST
  local missing
  missing=$(comm -23 <(sort -u <<<"$2") <(sort -u <<<"$3"))
  [[ -z $missing ]] || fail "$1 does not complete: $(xargs <<<"$missing")"
}

in_bash() { # WORDS..., the last one unfinished
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _cei3d; printf "%s\n" "${COMPREPLY[@]}"' \
    - "$work/cei3d.bash" cei3d "$@"
}
is_bash() { # EXPECTED WORDS..., in any order
  local expected given
  expected=$(xargs -n 1 <<<"$1" | sort | xargs)
  shift
  given=$(in_bash "$@" | sort | xargs)
  [[ $given == "$expected" ]] || fail "bash: cei3d $* gives $given, not $expected"
}

try_bash() {
  bash -n "$work/cei3d.bash"
  local command
  for command in check reconstruct render export eval synth 'edit paint' 'edit part' 'batch run'; do
    # shellcheck disable=SC2086
    within "bash: $command" "$(options $command)" "$(in_bash $command -)"
  done
  is_bash reconstruct rec
  is_bash "paint part" edit object pa
  is_bash --preset reconstruct samples/spot --pre
  is_bash "fast balanced paper" reconstruct samples/spot --preset ''
  is_bash balanced reconstruct --preset = b
  is_bash "" reconstruct --seed ''
  is_bash --channels render object -o out --chan
  is_bash "bash zsh fish" completion ''
  touch "$work/sky.hdr"
  mkdir "$work/sky.folder"
  is_bash "$work/sky.folder $work/sky.hdr" edit object light --env "$work/sky"
  is_bash "$work/sky.folder" eval object --truth "$work/sky"
}

# A terminal in which the words are typed, and then a tab: the pattern is shown within some seconds.
is_zsh() { # PATTERN LINE
  timeout 20 zsh -f -c '
    zmodload zsh/zpty
    zpty shell "TERM=dumb zsh -f -i"
    for line in "PS1= RPS1= fpath=($1 \$fpath)" "autoload -U compinit && compinit -u -d $1/dump" "LISTMAX=0; echo re""ady"; do
      zpty -w shell "$line"
    done
    zpty -r -m shell text "*ready*" && zpty -w -n shell "$3"$'"'\t\t'"' && zpty -r -m shell text "*$2*"' \
    - "$work" "$@" || fail "zsh: no $1 for $2"
}

try_zsh() {
  cp "$work/cei3d.zsh" "$work/_cei3d"
  zsh -n "$work/_cei3d"
  is_zsh 'balanced*paper' 'cei3d reconstruct --preset '
  is_zsh 'paint*part' 'cei3d edit object pa'
  is_zsh '--scribble' 'cei3d edit object paint --scr'
  is_zsh '--list-settings' 'cei3d --quiet reconstruct --list'
}

in_fish() { HOME=$work fish --no-config -c 'source $argv[1]; complete -C $argv[2]' "$work/cei3d.fish" "$1" | cut -f 1; }
try_fish() {
  fish --no-execute "$work/cei3d.fish"
  local command
  for command in check reconstruct render export eval synth 'edit paint' 'edit part' 'batch run'; do
    # shellcheck disable=SC2086
    within "fish: $command" "$(options $command | grep '^--')" "$(in_fish "cei3d $command --")"
  done
  [[ $(in_fish 'cei3d edit object pa' | xargs) == "paint part" ]] || fail "fish: $(in_fish 'cei3d edit object pa')"
  [[ $(in_fish 'cei3d reconstruct --preset ' | sort | xargs) == "balanced fast paper" ]] || fail "fish: presets"
}

try_man() {
  local complaints
  complaints=$(MANROFFSEQ='' LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$work/cei3d.1" 2>&1 >/dev/null)
  [[ -z $complaints ]] || fail "man: $complaints"
  within "man: reconstruct" "$(options reconstruct | grep -v -e '^-h$' -e '^--help$')" \
    "$(MANWIDTH=80 man -l "$work/cei3d.1" | col -b | grep -o -- '--*[a-z][a-z-]*')"
}

cd "$work"  # no files that could be offered
for shell in bash zsh fish; do "$program" completion "$shell" >"$work/cei3d.$shell"; done
"$program" manual >"$work/cei3d.1"
try_bash
! present zsh || try_zsh
! present fish || try_fish
! present man || try_man
