#!/usr/bin/env bash
# Builds Debian packages and an archive that needs no installation, into build/packages. Installs what is missing.
#
#   tools/package.sh           all
#   tools/package.sh debian    spillway, libspillway0.1, libspillway-dev, python3-spillway, spillway-doc; lintian checks them
#   tools/package.sh archive   spillway-VERSION-debian12-MACHINE.tar.gz: the command, and what it needs but the C library
#
# The sources are those of this folder as they are now, committed or not.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
what=${1:-all}
if [[ ! $what =~ ^(all|debian|archive)$ ]]; then
  echo "package.sh: '$what' is none of all, debian, archive" >&2
  exit 2
fi

tools/install_packages.sh package
jobs=$(nproc)
packages=$PWD/build/packages
mkdir -p "$packages"

if [[ $what != archive ]]; then
  echo "== Debian packages"
  sources=$packages/spillway
  rm -rf "$sources" "$packages"/*.{deb,dsc,changes,buildinfo,tar.xz}
  mkdir "$sources"
  tar --create --exclude-vcs --exclude=./build . | tar --extract --directory "$sources"
  # debhelper gives compilers a home folder of its own; the compiler's cache stays where it is.
  (
    cd "$sources"
    export CCACHE_DIR=${CCACHE_DIR:-$HOME/.cache/ccache} DEB_BUILD_OPTIONS="noautodbgsym ${DEB_BUILD_OPTIONS:-}"
    dpkg-buildpackage --no-sign -j"$jobs"
  ) >"$packages/build.log" 2>&1 || {
    tail -n 40 "$packages/build.log"
    echo "package.sh: the packages do not build; all messages are in $packages/build.log" >&2
    exit 1
  }
  rm -rf "$sources"
  lintian --fail-on error,warning "$packages"/*.changes
fi

if [[ $what != debian ]]; then
  echo "== archive"
  cmake -S . -B build/archive -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_LIBDIR=lib -DSPILLWAY_BUNDLE=ON \
    -DSPILLWAY_LIBRARY=OFF -DSPILLWAY_TESTS=OFF --log-level=WARNING
  cmake --build build/archive -j "$jobs" --target product
  cpack --config build/archive/CPackConfig.cmake -B "$packages" >"$packages/cpack.log" || {
    cat "$packages/cpack.log"
    exit 1
  }
  rm -rf "$packages/_CPack_Packages"
fi

echo "== build/packages"
(cd "$packages" && ls -sh -- *.deb *.tar.gz 2>/dev/null) || true
