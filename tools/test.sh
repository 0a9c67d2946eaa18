#!/usr/bin/env bash
# Installs what is missing, builds a preset and runs its tests.
#
#   tools/test.sh                      release, all tests
#   tools/test.sh asan                 another preset: debug, asan, tsan
#   tools/test.sh asan -L 'unit|fault' what follows the preset goes to ctest
#
# With CI set in the environment, warnings are errors.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
shift || true

tools/install_packages.sh test
[[ $preset != fuzz ]] || tools/install_packages.sh long

jobs=$(nproc)
options=(-DSPILLWAY_TESTS=ON)
[[ -z ${CI:-} ]] || options+=(-DSPILLWAY_WERROR=ON)

echo "== configure $preset"
cmake --preset "$preset" "${options[@]}" --log-level=WARNING
echo "== build $preset"
cmake --build --preset "$preset" -j "$jobs"
echo "== test $preset"
ctest --preset "$preset" -j "$jobs" "$@"
