#!/usr/bin/env bash
# Uses the library as a program of somebody else does: installs it into a prefix, moves the prefix, and checks it there.
#
#   run.sh BUILD CASE [CXX]
#
# BUILD is a build folder of Spillway that has the library; CASE one of
#   shared, static   builds tests/consumer with find_package and runs it
#   pkg-config       the same with what pkg-config says, without CMake
#   fast-math        the same where the program is built with -ffast-math
#   headers          every header compiles alone, without warnings, and includes nothing but the standard's and its own
#   symbols          the shared library exports the public names alone
#   docs             the code in docs/library.md and README.md is that of the program
#   everything       what is installed without a choice: command, manual, completions, library, licence, docs
#   refusal          Spillway itself is not built with -ffast-math, nor without anything to build
#   subdirectory     as a subdirectory it gives the library alone, and changes nothing of its parent project; no build
#   library-only     the library needs neither CLI11 nor MPI nor GTest; no build
set -euo pipefail
build=$(realpath "$1")
what=$2
CXX=${3:-c++}
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
strict=(-std=c++20 -Wall -Wextra -Wpedantic -Werror)

work=$(mktemp -d "${TMPDIR:-/tmp}/spillway-consumer-XXXXXX")
trap 'rm -rf "$work"' EXIT

fail() {
  echo "$*" >&2
  exit 1
}

# Where it was installed nothing is left.
install_and_move() {
  cmake --install "$build" --component library --prefix "$work/first" >/dev/null
  mkdir -p "$work/elsewhere"
  mv "$work/first" "$work/elsewhere/prefix"
  prefix=$work/elsewhere/prefix
  # Only the shared library knows where it lies itself.
  SPILLWAY_MODULES=$(dirname "$(find "$prefix" -name spillway_gdal.so)")
}

# build_and_run OPTION...
build_and_run() {
  cmake -S "$here" -B "$work/consumer" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$CXX" \
    -DCMAKE_PREFIX_PATH="$prefix" "$@" >"$work/log" || { cat "$work/log"; fail "does not configure"; }
  cmake --build "$work/consumer" >"$work/log" || { cat "$work/log"; fail "does not build"; }
  grep -q "$prefix" "$work/consumer/CMakeCache.txt" || fail "another Spillway was found"
  "$work/consumer/consumer"
}

# configure_without_packages_of_the_command SOURCES BUILD OPTION...
configure_without_packages_of_the_command() {
  cmake -S "$1" -B "$2" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON "${@:3}" >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "does not configure"; }
}

uses_shared() {
  [[ $(ldd "$1") == *libspillway* ]]  # no pipe: one that is left early would count as a failure
}

case $what in
  everything)
    cmake --install "$build" --prefix "$work/prefix" >/dev/null
    cd "$work/prefix"
    for file in share/man/man1/spillway.1 share/bash-completion/completions/spillway \
      share/zsh/vendor-completions/_spillway share/fish/vendor_completions.d/spillway.fish \
      include/spillway/triangulate.h share/doc/*/LICENSE share/doc/*/README.md share/doc/*/docs/cli.md; do
      [[ -s $file ]] || fail "$file is not installed"
    done
    [[ -n $(find . -name 'libspillway.so.*') && -n $(find . -name libspillway.a) ]] || fail "no library"
    cd "$work"
    "$work/prefix/bin/spillway" generate -q terrain -n 1000 -o a.las
    "$work/prefix/bin/spillway" triangulate -q a.las -o a.ply
    "$work/prefix/bin/spillway" check -q a.ply --points a.las
    ;;
  shared)
    install_and_move
    build_and_run
    uses_shared "$work/consumer/consumer" || fail "the shared library is not used"
    ;;
  static)
    install_and_move
    export SPILLWAY_MODULES
    build_and_run -DSpillway_USE_STATIC_LIBS=ON
    if uses_shared "$work/consumer/consumer"; then fail "the shared library is used"; fi
    ;;
  fast-math)
    install_and_move
    export SPILLWAY_MODULES
    build_and_run -DCMAKE_CXX_FLAGS=-ffast-math -DSpillway_USE_STATIC_LIBS=ON
    ;;
  pkg-config)
    install_and_move
    pc=$(find "$prefix" -name spillway.pc)
    export PKG_CONFIG_PATH=${pc%/*}
    read -ra flags <<<"$(pkg-config --cflags spillway)"
    read -ra libraries <<<"$(pkg-config --libs spillway)"
    "$CXX" "${strict[@]}" "${flags[@]}" "$here"/*.cpp -o "$work/main" "${libraries[@]}"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir spillway) "$work/main"
    read -ra libraries <<<"$(pkg-config --static --libs spillway)"
    find "$prefix" -name 'libspillway.so*' -delete
    "$CXX" "${strict[@]}" "${flags[@]}" "$here"/*.cpp -o "$work/main" "${libraries[@]}"
    SPILLWAY_MODULES=$SPILLWAY_MODULES "$work/main"
    ;;
  headers)
    install_and_move
    cd "$prefix/include"
    mapfile -t headers < <(find spillway -name '*.h' | sort)
    ((${#headers[@]} >= 6)) || fail "headers are missing"
    for header in "${headers[@]}"; do
      echo "#include <$header>" >"$work/alone.cpp"
      "$CXX" "${strict[@]}" -I. -fsyntax-only "$work/alone.cpp" || fail "$header does not compile alone"
      while read -r included; do
        if [[ $included == spillway/* ]]; then
          [[ -f $included ]] || fail "$header includes $included, which is not installed"
        elif [[ ! $included =~ ^[a-z_]+$ ]]; then
          fail "$header includes $included, which is not the standard's"
        fi
      done < <(sed -n 's/^ *# *include *[<"]\(.*\)[>"].*/\1/p' "$header")
    done
    ;;
  symbols)
    install_and_move
    nm -DC --defined-only "$(find "$prefix" -name libspillway.so)" | cut -d' ' -f3- >"$work/symbols"
    grep -q '^spillway::Delaunay<3, int>::locate' "$work/symbols" || fail "locate is not exported"
    if grep -vE '^((typeinfo|typeinfo name|vtable) for )?spillway::(Delaunay<[2-6], (int|long)>|Error|Context|PointSource|PointSink|MeshSource|MeshSink|MeshInMemory|DemSink|ContourSink|PictureSink|VolumeBetween|LevelVolumeSink|DensitySink|ProductShare|AttributeColumns)(::|$)|^spillway::(to_string|version|describe|kind_of_input|stands_for_several|expand_inputs|open_points|points_in_memory|names_in_condition|create_points|generate_points|generate_grid|point_families|open_mesh|create_mesh|mesh_to|triangulate|convert|check|describe_points|describe_header|describe_mesh|dem_product_names|dem_band_of|name_of|traits_of|ramp_names|create_dem|create_contours|create_picture|create_density|create_product|measure_heights|open_above_ground|measure_between|measure_above)[[(]' \
      "$work/symbols"; then
      fail "is exported, too"
    fi
    ;;
  docs)
    cat "$here"/*.cpp | tr -d ' \n' >"$work/program"
    sed -s -n '/^```cpp/,/^```$/{/^```/d;s# *//.*##;s/ //g;/./p}' "$here"/../../{docs/library,README}.md >"$work/lines"
    (($(wc -l <"$work/lines") > 30)) || fail "there is no code"
    while read -r line; do
      grep -qF -- "$line" "$work/program" || fail "in neither source: $line"
    done <"$work/lines"
    ;;
  refusal)
    if cmake -S "$here/../.." -B "$work/refused" -DCMAKE_CXX_FLAGS=-ffast-math 2>"$work/log" >&2; then
      fail "is configured"
    fi
    grep -q "exact only without -ffast-math" "$work/log" || { cat "$work/log"; fail "is not refused"; }
    if cmake -S "$here/../.." -B "$work/refused" -DCMAKE_CXX_FLAGS= -DSPILLWAY_LIBRARY=OFF -DSPILLWAY_COMMAND=OFF \
      2>"$work/log" >&2; then
      fail "is configured"
    fi
    grep -q "there is nothing to build" "$work/log" || { cat "$work/log"; fail "is not refused"; }
    echo '#include "src/geometry/predicates.h"' >"$work/fast.cpp"
    if "$CXX" -std=c++20 -ffast-math -I"$here/../.." -I"$here/../../include" -fsyntax-only "$work/fast.cpp" 2>"$work/log"; then
      fail "is compiled"
    fi
    grep -q "exact only without -ffast-math" "$work/log" || { cat "$work/log"; fail "is not refused"; }
    ;;
  subdirectory)
    for library in shared static; do
      configure_without_packages_of_the_command "$here/subdirectory" "$work/$library" \
        -DSPILLWAY_SOURCES="$here/../.." -DEXPECTED_LIBRARY="spillway_$library" \
        -DSpillway_USE_STATIC_LIBS="$([[ $library == static ]] && echo ON || echo OFF)"
      cmake --install "$work/$library" --prefix "$work/prefix" >"$work/log" 2>&1 || fail "there are rules of install"
      [[ ! -e $work/prefix ]] || fail "something is installed"
      [[ $(ctest --test-dir "$work/$library" -N) == *"Total Tests: 0"* ]] || fail "there are tests"
    done
    ;;
  library-only)
    configure_without_packages_of_the_command "$here/../.." "$work/library" -DSPILLWAY_COMMAND=OFF
    [[ $(ctest --test-dir "$work/library" -N) == *"Total Tests: 0"* ]] || fail "there are tests"
    ;;
  *)
    fail "there is no case $what"
    ;;
esac
