#!/usr/bin/env bash
# From points to a proved mesh: generates a million points of terrain, or takes the file that is given,
# triangulates it to PLY, and checks the result. Installs and builds what is missing.
#
#   tools/demo.sh [FILE]
set -euo pipefail

caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_packages.sh

echo "== build"
cmake --preset release --log-level=WARNING
cmake --build --preset release -j "$(nproc)" --target spillway
spillway=build/release/bin/spillway
mkdir -p build/demo

if (($# > 0)); then
  points=$(cd "$caller" && realpath -e -- "$1")
else
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
echo "The mesh is $PWD/$mesh"
