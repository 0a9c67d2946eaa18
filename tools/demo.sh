#!/usr/bin/env bash
# From points to a proved mesh: generates a million points of terrain, or takes the file that is given,
# triangulates it to PLY, checks the result, and makes a picture of it. Installs and builds what is missing. Afterwards
# `cmake --install build/release` works.
#
#   tools/demo.sh [FILE]
set -euo pipefail

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  exit 0
fi

points=
if (($# > 0)); then
  if [[ ! -f $1 ]]; then
    echo "demo.sh: there is no file $1" >&2
    exit 1
  fi
  points=$(realpath -- "$1")
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_packages.sh build

echo "== build"
options=()
# Where tests are built already, they stay.
[[ -f build/release/CMakeCache.txt ]] || options=(-DSPILLWAY_TESTS=OFF)
cmake --preset release "${options[@]}" --log-level=WARNING
cmake --build --preset release -j "$(nproc)" --target product
spillway=build/release/bin/spillway
mkdir -p build/demo

if [[ -z $points ]]; then
  points=build/demo/terrain.las
  echo "== generate a million points of terrain"
  "$spillway" generate terrain -n 1e6 -o "$points"
fi
name=$(basename "$points")
mesh=build/demo/${name%.*}.ply

echo "== triangulate"
"$spillway" triangulate "$points" -o "$mesh"
echo "== check"
"$spillway" check "$mesh" --points "$points"
echo "== render"
"$spillway" render "$mesh" -o "${mesh%.ply}.png"
echo "The mesh is $PWD/$mesh, and a picture of it ${mesh%.ply}.png"
