#!/usr/bin/env bash
# Runs the commands of tests/digests.txt with a build of spillway and prints a line for each: its name, its exit code,
# and digests of the files it made, of its standard output and of its standard error. Two builds that do the same print
# the same, so a change is seen with diff:
#
#   tests/digests.sh build/release/bin/spillway > before.txt
#   tests/digests.sh --keep /tmp/after build/release/bin/spillway > after.txt     # what the digests are of
#   tests/digests.sh --twice build/release/bin/spillway [NAMES]                   # are two runs of one build the same?
#
# Real LiDAR is looked for in ../shared/data beside the project, or in the folder that SPILLWAY_SHARED_DATA names.
# NAMES is a regular expression for the names of the commands that are to run. The exit code is 1 if something was left
# in a temporary folder, or if two runs differ. docs/testing.md tells more.
set -u -o pipefail
export LC_ALL=C

usage() {
  sed -n '2,13s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

# What one command has printed, without what is another each time: times, rates, memory, lines of progress that come
# with the clock, names of temporary folders.
normalise() {
  sed -E \
    -e '/"finished":false/d' \
    -e '/ ([0-9]+:)?[0-9]+:[0-9][0-9]( left)?$/d' \
    -e "s#$root#ROOT#g" \
    -e 's#spillway-(batch-|test-)?[A-Za-z0-9]{6,}#spillway-TEMPORARY#g' \
    -e 's#"(rate|seconds|seconds_left|peak_rss_bytes|memory_limit)":[^,}]*#"\1":0#g' \
    -e 's#, [0-9.]+[kMGT]?/s,#,#g' \
    -e 's#[0-9]+\.[0-9]+ s\b#0 s#g' \
    -e 's#[0-9.]+ [KMGT]?i?B of border resident#0 B of border resident#' \
    -e 's#peak memory [0-9]+ bytes#peak memory 0 bytes#'
}

# A file's content, likewise: a record of a batch without times, figures of --stats without those that depend on the
# machine or on the pace of threads, a Shapefile's table without its date.
content() {
  case "$1" in
    *.dbf) tail -c +5 "$1" ;;
    *.status.json) sed -E -e 's#"(changed|seconds)": [0-9.e+-]+#"\1": 0#' "$1" | normalise ;;
    *.stats.json) sed -E -e 's#(: *)[0-9]+(\.|e-)[0-9e.+-]+#\10#' \
      -e 's#"(peak_rss_bytes|memory_limit|border_(simplices|bytes))": [0-9]+#"\1": 0#' "$1" ;;
    *.log) normalise < "$1" ;;
    *) cat "$1" ;;
  esac
}

digest() { sha256sum | cut -c1-12; }

# Runs the command of one line of the list, and writes its line to results/NAME.
run_one() {
  local name=$1 command=$2 code left files
  local folder=$root/run/$name
  mkdir -p "$folder" "$root/tmp/$name" "$root/kept/$name"
  cd "$folder" || exit 1
  ln -s "$root/in" in
  ln -s "$shared" shared
  TMPDIR=$root/tmp/$name bash -o pipefail -c "$functions"$'\n'"$command" \
    > "$root/kept/$name/out" 2> "$root/kept/$name/err" < /dev/null
  code=$?
  rm in shared
  files=$(find . -type f | sort | while read -r file; do
    printf '%s %s\n' "$(content "$file" | digest)" "$file"
  done)
  left=$(find "$root/tmp/$name" -mindepth 1 ! -path '*/ompi.*' | wc -l)
  cd "$root" && rm -rf "$folder" "$root/tmp/$name"
  printf '%s' "$files" > "$root/kept/$name/files"
  for stream in out err; do
    normalise < "$root/kept/$name/$stream" > "$root/kept/$name/$stream.plain"
    mv "$root/kept/$name/$stream.plain" "$root/kept/$name/$stream"
  done
  {
    printf '%s exit=%d files=%s stdout=%s stderr=%s' "$name" "$code" \
      "$(digest < "$root/kept/$name/files")" "$(digest < "$root/kept/$name/out")" \
      "$(digest < "$root/kept/$name/err")"
    [ "$left" -eq 0 ] || printf ' LEFT=%d' "$left"
    printf '\n'
  } > "$root/results/$name"
}

# One run of the list; prints all lines in its order.
run_list() {
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
  mkdir "$root/in" "$root/run" "$root/tmp" "$root/results"
  export root shared functions
  export -f run_one normalise content digest
  (cd "$root/in" && TMPDIR=$root/tmp bash $strict -o pipefail -c "$functions"$'\n'"$inputs") || [ -z "$strict" ] || exit 1
  printf '%s\n' "$commands" | while IFS= read -r line; do
    printf '%s\0%s\0' "${line%% *}" "${line#* }"
  done | xargs -0 -n 2 -P "$(nproc)" bash -c 'run_one "$1" "$2"' one
  printf '%s\n' "$commands" | while IFS= read -r line; do cat "$root/results/${line%% *}"; done
  if [ -n "$keep" ]; then
    mkdir -p "$keep" && cp -r "$root/kept/." "$keep"
  fi
  rm -rf "$root"
}

keep=""
twice=""
while [ $# -gt 0 ]; do
  case "$1" in
    --keep) [ $# -gt 1 ] || usage; keep=$2; shift 2 ;;
    --twice) twice=yes; shift ;;
    -*) usage ;;
    *) break ;;
  esac
done
[ $# -eq 1 ] || [ $# -eq 2 ] || usage
spillway=$(realpath "$1")
names=${2:-.}
[ -x "$spillway" ] || { echo "$1: no program" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
shared=$(realpath -m "${SPILLWAY_SHARED_DATA:-$here/../../shared/data}")

# What makes an input must go well, but for a build without MPI or GDAL.
strict=-e
if "$spillway" --version | grep -q '^without'; then strict=; fi

# What the list's commands find: `spillway`, and `ranks N ...` for a run over ranks. What mpirun says itself names
# processes and machines, so only spillway's own lines are kept of it.
functions="
spillway() { '$spillway' \"\$@\"; }
ranks() {
  local count=\$1 code; shift
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 TMPDIR=/tmp \
    mpirun --oversubscribe --bind-to none -n \$count -x TMPDIR=\$TMPDIR '$spillway' \"\$@\" 2> ranks.err
  code=\$?
  grep -E '^(spillway: |\\{)' ranks.err >&2
  rm ranks.err
  return \$code
}
export OGR_CURRENT_DATE=2000-01-01T00:00:00.000Z
"
# The list: lines `NAME COMMAND`; those of NAME `input` make the inputs.
list=$(grep -v -E '^(#|$)' "$here/digests.txt")
inputs=$(printf '%s\n' "$list" | sed -n 's/^input //p')
commands=$(printf '%s\n' "$list" | grep -v '^input ' |
  while IFS= read -r line; do [[ ${line%% *} =~ $names ]] && printf '%s\n' "$line"; done)
[ -n "$commands" ] || { echo "no command has such a name: $names" >&2; exit 2; }
command -v mpirun > /dev/null || commands=$(printf '%s\n' "$commands" | grep -v ' ranks ')
[ -d "$shared" ] || commands=$(printf '%s\n' "$commands" | grep -v 'shared/')

lines=$(run_list) || exit 1
printf '%s\n' "$lines"
code=0
if printf '%s\n' "$lines" | grep -q ' LEFT='; then
  echo "something was left in a temporary folder" >&2
  code=1
fi
if [ -n "$twice" ]; then
  again=$(run_list) || exit 1
  diff <(printf '%s\n' "$lines") <(printf '%s\n' "$again") >&2 || { echo "two runs differ" >&2; code=1; }
fi
exit $code
