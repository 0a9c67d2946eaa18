#!/usr/bin/env bash
# Triangulates a survey of many files, whose sizes are uneven and whose boxes overlap, and prints a Markdown table: what
# each run took, how many points were spilled, how much was read when the first block was written, and whether all runs
# gave the same triangulation. The format spp is one stream of all points, sorted by spillway convert: it comes through
# a pipe, and so does the mesh leave, with the time until its reader has the first bytes. Two commands are run by turns,
# so that both meet the same machine. The first rows are runs of three points, which show what a process takes besides
# its data. Where other programs use the machine, processor time is the better measure.
#
#   tests/benchmark/survey.sh [OPTIONS] SPILLWAY
#   tests/benchmark/survey.sh [OPTIONS] BEFORE AFTER
#
#   -n N             points of terrain [1e6]
#   --grid CxR       columns and rows of files [20x20]
#   --overlap SHARE  of neighbouring files, as spillway generate takes it [0.05]
#   --formats LIST   of las laz copc spp [las]
#   --names LIST     orders in which files are named, of sorted reversed shuffled [sorted]
#   --whole          triangulate the same points from one LAS file, too
#   --memory SIZE    as spillway triangulate takes it [256M]
#   --threads N      of spillway; 0: all there are [0]
#   --runs N         of each command and input [1]
#   --limit SECONDS  a run that takes longer is ended, with exit code 124 [3600]
#   --scratch-folder DIR     where a folder for files is made, and removed at the end [$TMPDIR, else /tmp]
#   --encoder FILE   the encoded_points that makes LAZ and COPC [beside the last SPILLWAY, which makes the other inputs]
#
# The exit code is 1 if a run failed or hashes differ.
set -u -o pipefail
export LC_ALL=C

usage() {
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2
  exit 2
}

points=1e6
grid=20x20
overlap=0.05
formats=las
orders=sorted
whole=
memory=256M
threads=0
runs=1
limit=3600
tmpdir=${TMPDIR:-/tmp}
encoder=
while [[ ${1-} == -* ]]; do
  if [ "$1" = --whole ]; then whole=yes; shift; continue; fi
  [ $# -gt 1 ] || usage
  case "$1" in
    -n) points=$2 ;;
    --grid) grid=$2 ;;
    --overlap) overlap=$2 ;;
    --formats) formats=${2//,/ } ;;
    --names) orders=${2//,/ } ;;
    --memory) memory=$2 ;;
    --threads) threads=$2 ;;
    --runs) runs=$2 ;;
    --limit) limit=$2 ;;
    --scratch-folder) tmpdir=$2 ;;
    --encoder) encoder=$2 ;;
    *) usage ;;
  esac
  shift 2
done
if [ $# -eq 1 ]; then
  labels=(spillway)
elif [ $# -eq 2 ]; then
  labels=(before after)
else
  usage
fi
commands=("$@")
maker=${commands[-1]}
needed=("${commands[@]}" /usr/bin/time)
for format in $formats; do
  case "$format" in
    las | spp) ;;
    laz | copc) encoder=${encoder:-$(dirname "$maker")/encoded_points}; needed+=("$encoder") ;;
    *) usage ;;
  esac
done
for order in $orders; do
  case "$order" in sorted | reversed | shuffled) ;; *) usage ;; esac
done
for program in "${needed[@]}"; do
  [ -x "$program" ] || { echo "survey.sh: no program $program" >&2; exit 2; }
done

folder=$(mktemp -d "$(realpath -- "$tmpdir")/survey-XXXXXX") || exit 2
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT TERM

# The number of that name among the figures of the last run; nothing if there is none.
figure() {
  sed -n -E "s/^  \"$1\": \"?([^\",]*)\"?,?\$/\\1/p" "$folder/stats.json" 2> /dev/null
}

# Triangulates an input with the command of that number, to the file of that name.
triangulate() {
  rm -f "$folder/stats.json" "$folder/first"
  /usr/bin/time -q -f '%e %U %S %M' -o "$folder/time" timeout "$limit" "${commands[$1]}" triangulate -q "$2" \
    -o "${3:-$folder/out.spm}" --memory "$memory" --threads "$threads" --scratch-folder "$folder" --stats "$folder/stats.json"
}

# Reads a mesh from a pipe, and keeps the time at which its first bytes came.
read_mesh() {
  head -c 1 > "$folder/byte"
  [ ! -s "$folder/byte" ] || date +%s%N > "$folder/first"
  cat > /dev/null
}

# The same for a stream of points, from pipe to pipe.
triangulate_stream() {
  local begin code
  begin=$(date +%s%N)
  # shellcheck disable=SC2002  # a pipe is what is to be measured
  cat "$2" | triangulate "$1" - - | read_mesh
  code=${PIPESTATUS[1]}
  if [ -s "$folder/first" ]; then echo $(($(< "$folder/first") - begin)) > "$folder/first"; fi
  return "$code"
}

# The row of a run that ended with that exit code.
print_row() {
  local label=$1 name=$2 code=$3 seconds user system kilobytes
  read -r seconds user system kilobytes < "$folder/time"
  awk -v label="$label" -v name="$name" -v code="$code" -v seconds="$seconds" -v user="$user" -v kernel="$system" \
    -v nanoseconds="$(cat "$folder/first" 2> /dev/null)" -v kilobytes="$kilobytes" -v n="$(figure points)" -v peak="$(figure peak_rss_bytes)" \
    -v spilled="$(figure spilled_points)" -v first="$(figure first_block_read_points)" -v tiles="$(figure tiles)" \
    -v hash="$(figure canonical_hash)" '
    function finished(value) { return n > 0 ? value : "-" }
    function share(format, value) { return n > 3 ? sprintf(format, value / n) : "-" }
    BEGIN {
      mebibytes = peak > 0 ? peak / 1048576 : kilobytes / 1024
      printf "| %s | %s | %d | %.2f | %s | %s | %.0f | %s | %s | %s | %s |\n", label, name, code, seconds,
        (nanoseconds > 0) ? sprintf("%.2f", nanoseconds / 1e9) : "-",
        share("%.3f", 1e6 * (user + kernel)), mebibytes, share("%.3f", spilled),
        first ~ /^[0-9]+$/ ? share("%.1f %%", 100 * first) : "-", finished(tiles), finished(hash)
    }'
}

failed=0
hashes=()
# Runs all commands on an input by turns, and prints their rows. A third word says that the input is to be piped.
measure() {
  local name=$1 input=$2 piped=${3-} run i code
  for ((run = 0; run < runs; ++run)); do
    for i in "${!commands[@]}"; do
      if [ -n "$piped" ]; then triangulate_stream "$i" "$input"; else triangulate "$i" "$input"; fi
      code=$?
      print_row "${labels[i]}" "$name" "$code"
      if [ "$code" -eq 0 ]; then hashes+=("$(figure canonical_hash)"); else failed=1; fi
    done
  done
}

# The files of a folder in that order.
list_files() {
  case "$2" in
    sorted) printf '%s\n' "$1"/* ;;
    reversed) printf '%s\n' "$1"/* | sort -r ;;
    shuffled) printf '%s\n' "$1"/* | shuf --random-source=<(yes) ;;
  esac
}

mkdir "$folder/las"
"$maker" generate -q terrain -n "$points" --grid "$grid" --overlap "$overlap" -o "$folder/las/survey_#.las" || exit 1

echo "| command | input | exit code | wall s | first bytes s | CPU us/pt | peak MiB | spilled/pt | read at first block | tiles | hash |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
printf '0 0 0\n1 0 0\n0 1 0\n' > "$folder/three.txt"
for i in "${!commands[@]}"; do
  triangulate "$i" "$folder/three.txt"
  print_row "${labels[i]}" "3 points" $?
done
if [ -n "$whole" ]; then
  "$maker" generate -q terrain -n "$points" -o "$folder/whole.las" || exit 1
  measure "one file" "$folder/whole.las"
  rm "$folder/whole.las"
fi
for format in $formats; do
  if [ "$format" = spp ]; then
    "$maker" convert -q --sorted "$folder/las" -o "$folder/sorted.spp" --memory "$memory" --scratch-folder "$folder" || exit 1
    measure "spp, sorted, a pipe" "$folder/sorted.spp" piped
    rm "$folder/sorted.spp"
    continue
  fi
  if [ "$format" != las ]; then
    mkdir "$folder/$format"
    copc=()
    [ "$format" = copc ] && copc=(--copc)
    "$encoder" "$folder"/las/* --output-dir "$folder/$format" "${copc[@]}" || exit 1
  fi
  for order in $orders; do
    list_files "$folder/$format" "$order" > "$folder/list.txt"
    measure "$format, $order, $(wc -l < "$folder/list.txt") files" "@$folder/list.txt"
  done
  [ "$format" = las ] || rm -r "${folder:?}/$format"
done
different=$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)
echo
if [ ${#hashes[@]} -lt 2 ]; then
  echo "Fewer than two runs ended: no hashes to compare."
elif [ "$different" -eq 1 ]; then
  echo "All ${#hashes[@]} hashes are equal."
else
  echo "Hashes DIFFER: $different triangulations of the same points."
  failed=1
fi
exit $failed
