#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Workers that are stopped and replaced, and clocks that differ or jump: a worker that lives keeps its object, one that is
# gone loses it, and two never publish the same object. A beat is 0.4 s here.
source "$(dirname "$0")/lib.sh"

prepare() { # NAME SECONDS: a catalog of one object that takes so long
  stubs 1 "$2" >"$out/m.jsonl"
  batch run "$out/m.jsonl" -o "$out/$1" --beat 0.4 --dry-run --quiet
}
work() { "$program" batch work "$out/m.jsonl" -o "$out/$1" --index 0 --quiet; } # as a process of its own: work NAME &
has_begun() { # NAME
  for ((k = 0; k < 600; ++k)); do [[ -s $(compgen -G "$out/$1/items/*/o0/attempt-0001") ]] && return; sleep 0.05; done
  fail "$1: no worker has begun"
}

echo "a worker that is stopped, replaced, and goes on"
prepare brain 4
code=0
"$program" batch work "$out/m.jsonl" -o "$out/brain" --index 0 --quiet 2>/dev/null & first=$!
has_begun brain
kill -STOP "$first"
sleep 4 # more than six beats
"$program" batch work "$out/m.jsonl" -o "$out/brain" --index 0 --quiet & second=$!
for ((k = 0; k < 600; ++k)); do compgen -G "$out/brain/items/*/o0/attempt-0002" >/dev/null && break; sleep 0.1; done
kill -CONT "$first"
wait "$first" || code=$?
expect "exit code of the first" "$code" 75
wait "$second"
expect finished "$(count "$out/brain" "done")" 1
expect attempt "$(attempts "$out/brain")" 2
expect leftovers "$(leftovers "$out/brain")" 0

for when in '1 hour ago' '1 hour'; do
  echo "a file server whose clock is off ($when) while a worker lives"
  prepare "server-${when// /-}" 6
  work "server-${when// /-}" & first=$!
  has_begun "server-${when// /-}"
  touch -d "$when" "$out/server-${when// /-}"/items/*/o0/attempt-0001
  expect "exit code of the second" "$(code_of work "server-${when// /-}")" 75
  wait "$first"
  expect attempts "$(attempts "$out/server-${when// /-}")" 1
done

echo "a worker of another machine, an hour ahead, that is gone"
prepare gone 0.1
"$program" batch work "$out/m.jsonl" -o "$out/gone" --index 0 --quiet
file=$(compgen -G "$out/gone/items/*/o0")/attempt-0002
stubs 1 0.2 >"$out/m.jsonl" # another key, so that there is something to do
printf '{"host":"far","space":"far","pid":7,"started":7,"job":"","restart":0}\n' >"$file"
touch -d '1 hour' "$file"
work gone
expect attempt "$(attempts "$out/gone")" 3

faketime=$(compgen -G '/usr/lib/*/faketime/libfaketimeMT.so.1' || true)
if [[ -z $faketime ]]; then
  echo "SKIP: clocks of workers: no faketime"
else
  # The times of files stay true, as a file server gives them.
  fake() { # CLOCK-FILE COMMAND...
    FAKETIME_TIMESTAMP_FILE=$1 FAKETIME_NO_CACHE=1 FAKETIME_DONT_FAKE_MONOTONIC=1 NO_FAKE_STAT=1 LD_PRELOAD=$faketime "${@:2}"
  }

  echo "workers whose clocks differ by an hour"
  prepare differ 10
  echo '-1h' >"$out/clock-late"
  echo '+1h' >"$out/clock-early"
  work differ & first=$!
  has_begun differ
  for clock in late early; do
    expect "exit code of a worker whose clock is $clock" "$(code_of fake "$out/clock-$clock" "$program" batch work "$out/m.jsonl" -o "$out/differ" --index 0 --quiet)" 75
  done
  wait "$first"
  expect attempts "$(attempts "$out/differ")" 1

  echo "a clock that jumps forth and back while its worker lives"
  prepare jump 10
  echo '+0' >"$out/clock"
  fake "$out/clock" "$program" batch work "$out/m.jsonl" -o "$out/jump" --index 0 --quiet & first=$!
  has_begun jump
  for jump in '+1h' '-2h' '+1d'; do
    echo "$jump" >"$out/clock"
    expect "exit code of another worker" "$(code_of work jump)" 75
  done
  wait "$first"
  expect attempts "$(attempts "$out/jump")" 1
  noted() { grep -o "\"$1\":[0-9]*" "$out"/jump/items/*/o0/state.json | head -1 | cut -d: -f2; }
  (($(noted ended) > $(date +%s) + 80000)) || fail "the clock of the worker did not jump"
  seconds=$(noted seconds)
  ((seconds < 60)) || fail "the object took $seconds s by a clock that jumped"
fi
echo "all fine"
