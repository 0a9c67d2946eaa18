#!/usr/bin/env bash
# Runs what takes hours: everything that tools/test.sh leaves out.
#
#   tools/test_long.sh                 asan tsan tidy fuzz faults whole kills
#   tools/test_long.sh fuzz whole      these alone
#   tools/test_long.sh soak            a billion points, and 20,000 jobs: 80 GB of disk
#   MINUTES=60 tools/test_long.sh fuzz how long each target is fuzzed, and random runs go on
#
# Prints a line for each part, and ends with 1 if one of them failed. docs/testing.md has the results.
set -uo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
minutes=${MINUTES:-10}
jobs=$(nproc)
logs=build/long
bin=build/release/bin
mkdir -p "$logs"

build_release() {
  tools/install_packages.sh test &&
    cmake --preset release -DSPILLWAY_TESTS=ON --log-level=WARNING &&
    cmake --build --preset release -j "$jobs"
}

asan() { tools/test.sh asan; }
tsan() { tools/test.sh tsan; }

# The headers of include/ are read by sources that use them, and checked where they are.
tidy() {
  tools/install_packages.sh long &&
    cmake --preset release -B build/tidy -DSPILLWAY_TESTS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
      --log-level=WARNING &&
    run-clang-tidy -quiet -j "$jobs" -p build/tidy "$PWD/(src|formats|stream|tools|python)/"
}

fuzz() {
  tools/install_packages.sh long &&
    cmake --preset fuzz --log-level=WARNING && cmake --build --preset fuzz -j "$jobs" &&
    tests/fuzz/run.py build/fuzz/bin/fuzz "$logs/fuzz" --minutes "$minutes" --jobs "$jobs"
}

faults() {
  build_release && tests/faults/fault_driver.py "$bin/spillway" "$bin/fault_injector.so" --jobs "$jobs"
}

whole() {
  build_release && tests/whole/property_driver.py "$bin" --minutes "$minutes" --seed random
}

kills() {
  local driver="tests/stream/checkpoint/kill_driver.py $bin/spillway --seed $RANDOM"
  echo "$driver"
  build_release && $driver --kills 1000 && $driver --damages 500 && $driver --full-disks 50
}

soak() {
  local folder
  build_release && folder=$(mktemp -d "${TMPDIR:-/tmp}/soak.XXXXXX") &&
    tests/soak/soak.py "$bin/spillway" --points 1e9 --folder "$folder/points" \
      --picture "$logs/soak.png" &&
    tests/soak/soak.py "$bin/spillway" --jobs 20000 --folder "$folder/jobs" \
      --picture "$logs/jobs.png"
  local code=$?
  [[ -z ${folder:-} ]] || rm -rf "$folder"
  return $code
}

parts=("$@")
((${#parts[@]} > 0)) || parts=(asan tsan tidy fuzz faults whole kills)
failed=0
for part in "${parts[@]}"; do
  case $part in
    asan | tsan | tidy | fuzz | faults | whole | kills | soak) ;;
    *)
      echo "test_long.sh: '$part' is none of asan, tsan, tidy, fuzz, faults, whole, kills, soak" >&2
      exit 2
      ;;
  esac
  begin=$SECONDS
  if "$part" >"$logs/$part.log" 2>&1; then
    echo "$part: passed after $((SECONDS - begin)) s"
  else
    echo "$part: FAILED after $((SECONDS - begin)) s; see $logs/$part.log"
    failed=1
  fi
done
exit "$failed"
