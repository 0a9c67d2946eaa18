#!/usr/bin/env bash
# What it costs that a run can go on.
#
#   checkpoints.sh INPUT [RUNS]
#
# Triangulates INPUT to a file in this folder at 256M, without --resume and with it, RUNS times (3) in turn. Prints
# seconds, processor seconds, and what checkpoints took of them.
set -euo pipefail

input=$1
runs=${2:-3}
mesh=checkpoints.spm

measure() {
  local name=$1
  shift
  rm -f "$mesh"
  sync
  TIMEFORMAT="$name: %R s, processor %U + %S s"
  time spillway triangulate "$input" -o "$mesh" --memory 256M -v "$@" 2> messages.txt
  grep 'checkpoints took' messages.txt || true
}

for ((run = 0; run < runs; ++run)); do
  measure 'without --resume'
  measure 'with --resume' --resume checkpoints.run
  measure 'with --checkpoint-every 5' --resume checkpoints.run --checkpoint-every 5
done
rm -f "$mesh" messages.txt
