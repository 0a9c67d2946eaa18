#!/usr/bin/env bash
# Runs an example of docs/examples in a folder of its own, and compares what it prints.
#
#   run.sh PROGRAM EXPECTED
#
# EXPECTED is a file with what PROGRAM prints.
set -euo pipefail
program=$(realpath "$1")
expected=$(realpath "$2")

work=$(mktemp -d "${TMPDIR:-/tmp}/spillway-example-XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" >printed
diff "$expected" printed
