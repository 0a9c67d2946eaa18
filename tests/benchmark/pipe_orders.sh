#!/usr/bin/env bash
# Triangulates the same points of terrain from a pipe in several orders, and prints a Markdown table: what each order
# took, and whether all gave the same triangulation. The first row is a run of three points, which shows what a process
# takes besides its data. Before each order comes a run of fewer points in that order from a file, whose header tells
# their number and extent. A second table has the time of threads in each stage, in ns a point, and how many times that
# of the file it is. Each run begins when its points are ready, so that the time is that of spillway. Where other
# programs use the machine, processor time is the better measure.
#
#   tests/benchmark/pipe_orders.sh [OPTIONS] SPILLWAY
#
#   -n N             points [1e6]
#   --file N         points of a file [1e7]
#   --memory SIZE    as spillway triangulate takes it [32M]
#   --orders LIST    of scan random curve outwards strips [all]
#   --told           the stream's header tells the number of points and their extent
#   --check          prove the first mesh of each set of equal hashes with spillway check, its points and the same memory
#   --threads N      of spillway; 0: all there are [0]
#   --limit SECONDS  a run that takes longer is ended, with exit code 124 [3600]
#   --scratch-folder DIR     where a folder for files is made, and removed at the end [$TMPDIR, else /tmp]
#   --driver FILE    the ordered_points to run [beside SPILLWAY]
#
# The exit code is 1 if a run failed, hashes differ, or a mesh is not proved.
set -u -o pipefail
export LC_ALL=C

usage() {
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0" >&2
  exit 2
}

points=1e6
file_points=1e7
memory=32M
orders="scan random curve outwards strips"
told=()
check=
threads=0
limit=3600
tmpdir=${TMPDIR:-/tmp}
driver=
while [ $# -gt 1 ]; do
  case "$1" in
    -n) points=$2 ;;
    --file) file_points=$2 ;;
    --memory) memory=$2 ;;
    --orders) orders=${2//,/ } ;;
    --threads) threads=$2 ;;
    --limit) limit=$2 ;;
    --scratch-folder) tmpdir=$2 ;;
    --driver) driver=$2 ;;
    --told) told=(--told); shift; continue ;;
    --check) check=yes; shift; continue ;;
    *) usage ;;
  esac
  shift 2
done
if [ $# -ne 1 ] || [[ $1 == -* ]]; then usage; fi
spillway=$1
driver=${driver:-$(dirname "$spillway")/ordered_points}
for program in "$spillway" "$driver" /usr/bin/time; do
  [ -x "$program" ] || { echo "pipe_orders.sh: no program $program" >&2; exit 2; }
done

folder=$(mktemp -d "$(realpath -- "$tmpdir")/pipe-orders-XXXXXX") || exit 2
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT TERM
mkfifo "$folder/pipe"

# The number of that name among the figures of the last run, so deep in it; nothing if there is none.
figure() {
  sed -n -E "s/^ {$((2 * ${2:-1}))}\"$1\": \"?([^\",]*)\"?,?\$/\\1/p" "$folder/stats.json" 2> /dev/null
}

# Triangulates an input: "-" is what comes through the pipe.
triangulate() {
  rm -f "$folder/stats.json" "$folder/out.spm"
  /usr/bin/time -q -f '%e %U %S %M' -o "$folder/time" timeout "$limit" "$spillway" triangulate -q "$1" \
    -o "$folder/out.spm" --memory "$memory" --threads "$threads" --scratch-folder "$folder" --stats "$folder/stats.json" \
    < "${2:-/dev/null}"
}

# Adds a column to the second table: of each stage of the last run, ns a point.
keep_stages() {
  sed -n '/^  "stages": {/,/^  }/s/^    "\(.*\)": \([^,]*\),\{0,1\}$/\1 \2/p' "$folder/stats.json" 2> /dev/null |
    awk -v run="$1" -v n="$(figure points)" 'n > 0 { printf "%s %s %.1f\n", run, $1, 1e9 * $2 / n }' >> "$folder/stages"
}

# The second table: each order beside its file.
print_stages() {
  awk '
    !($1 in seen) { seen[$1] = 1; if ($1 !~ /-file$/) run[++runs] = $1 }
    !($2 in known) { known[$2] = 1; stage[++stages] = $2 }
    { ns[$1, $2] = $3; sum[$1] += $3 }
    function cell(base, of) {
      return base > 0 ? sprintf("%.1f, %.1f (%.2f)", base, of, of / base) : sprintf("-, %.1f", of)
    }
    END {
      printf "\n| ns a point: file, pipe |"
      for (r = 1; r <= runs; r++) printf " %s |", run[r]
      printf "\n|---|"
      for (r = 1; r <= runs; r++) printf "---|"
      for (s = 1; s <= stages; s++) {
        printf "\n| %s |", stage[s]
        for (r = 1; r <= runs; r++) printf " %s |", cell(ns[run[r] "-file", stage[s]], ns[run[r], stage[s]])
      }
      printf "\n| all |"
      for (r = 1; r <= runs; r++) printf " %s |", cell(sum[run[r] "-file"], sum[run[r]])
      print ""
    }' "$folder/stages"
}

# The row of a run that ended with that exit code.
print_row() {
  local name=$1 code=$2 seconds user system kilobytes
  read -r seconds user system kilobytes < "$folder/time"
  awk -v name="$name" -v code="$code" -v seconds="$seconds" \
    -v user="$user" -v kernel="$system" -v kilobytes="$kilobytes" -v n="$(figure points)" \
    -v peak="$(figure peak_rss_bytes)" -v tiles="$(figure tiles)" -v spilled="$(figure spilled_points)" \
    -v long="$(figure longer 2)" -v divided="$(figure divided_points)" -v bytes="$(figure spilled_bytes)" -v hash="$(figure canonical_hash)" '
    function finished(value) { return n > 0 ? value : "-" }
    function share(format, value) { return n > 3 ? sprintf(format, value / n) : "-" }
    BEGIN {
      mebibytes = peak > 0 ? peak / 1048576 : kilobytes / 1024
      printf "| %s | %d | %.1f | %s | %.0f | %s | %s | %s | %s | %s | %s |\n", name, code, seconds,
        share("%.3f", 1e6 * (user + kernel)), mebibytes, share("%.2f", spilled), finished(tiles),
        finished(long), share("%.2f", divided), share("%.1f", bytes), finished(hash)
    }'
}

failed=0
hashes=()
proofs=()
declare -A seen

# With --check: proves the mesh of the last run with the points it was made of, if it is the first one of its hash.
prove() {
  local hash code seconds kilobytes
  hash=$(figure canonical_hash)
  if [ -z "$check" ] || [ -z "$hash" ] || [ -n "${seen[$hash]-}" ]; then return; fi
  seen[$hash]=yes
  /usr/bin/time -q -f '%e %M' -o "$folder/time" timeout "$limit" "$spillway" check -q "$folder/out.spm" \
    --points "$folder/points.spp" --memory "$memory" --threads "$threads" --scratch-folder "$folder" > "$folder/proof" 2>&1
  code=$?
  read -r seconds kilobytes < "$folder/time"
  if [ "$code" -eq 0 ]; then
    proofs+=("Proved: $hash, of $1, in $seconds s and $((kilobytes / 1024)) MiB.")
  else
    proofs+=("NOT proved: $hash, of $1, exit code $code." "$(cat "$folder/proof")")
    failed=1
  fi
}

echo "| order | exit code | wall s | CPU us/pt | peak MiB | spilled/pt | tiles | above 4:1 | divided/pt | disk B/pt | hash |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
printf '0 0 0\n1 0 0\n0 1 0\n' > "$folder/pipe" &
triangulate - "$folder/pipe"
print_row "3 points" $?
wait
for order in $orders; do
  if "$driver" -n "$file_points" --order "$order" --told -o "$folder/points.spp"; then
    triangulate "$folder/points.spp"
    print_row "$order, file" $?
    keep_stages "$order-file"
    prove "$order, file"
  fi
  rm -f "$folder/points.spp"
  # Who writes to the pipe must not be what its reader waits for.
  "$driver" -n "$points" --order "$order" "${told[@]}" -o "$folder/points.spp" || exit 1
  cat "$folder/points.spp" > "$folder/pipe" &
  triangulate - "$folder/pipe"
  code=$?
  wait
  print_row "$order" "$code"
  keep_stages "$order"
  prove "$order"
  rm -f "$folder/points.spp"
  if [ "$code" -eq 0 ]; then hashes+=("$(figure canonical_hash)"); else failed=1; fi
done
if [ -s "$folder/stages" ]; then print_stages; fi
if [ ${#proofs[@]} -gt 0 ]; then printf '\n'; printf '%s\n' "${proofs[@]}"; fi
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
