#!/usr/bin/env bash
# Builds Debian packages, and an archive that needs no installation, into build/packages. Installs what is missing.
# Packages take some ten minutes on two cores, the archive half of that; where ccache serves them, two minutes.
#
#   tools/package.sh           both
#   tools/package.sh debian    spillway, libspillway0.1, libspillway-dev, python3-spillway, spillway-doc; lintian
#                              checks them
#   tools/package.sh archive   spillway-VERSION-SYSTEM-MACHINE.tar.gz: the command, and what it needs but the C library
#
# The sources are those of this folder as they are now, committed or not.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
what=${1:-both}
if [[ $what == -h || $what == --help ]]; then
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  exit 0
fi
if (($# > 1)) || [[ ! $what =~ ^(both|debian|archive)$ ]]; then
  echo "package.sh: '$*' is none of debian, archive, both" >&2
  exit 2
fi

tools/install_packages.sh package
jobs=$(nproc)
packages=$PWD/build/packages
mkdir -p "$packages"
# All is made here, and moved when it is complete.
work=$packages/work
trap 'rm -rf "$work"' EXIT
rm -rf "$work"

build_debian_packages() {
  echo "== Debian packages"
  local sources=$work/debian/spillway log=$packages/debian.log
  mkdir -p "$sources"
  tar --create --exclude-vcs --exclude=./build --exclude='*.part' --exclude=__pycache__ . |
    tar --extract --directory "$sources"
  # debhelper gives compilers a home folder of its own; the compiler's cache stays where it is.
  if command -v ccache >/dev/null; then
    CCACHE_DIR=$(ccache --get-config cache_dir)
    export CCACHE_DIR
  fi
  (
    cd "$sources"
    DEB_BUILD_OPTIONS="noautodbgsym ${DEB_BUILD_OPTIONS:-}" dpkg-buildpackage --no-sign -j"$jobs"
  ) >"$log" 2>&1 || {
    tail -n 40 "$log"
    echo "package.sh: the packages do not build; all messages are in $log" >&2
    exit 1
  }
  lintian --fail-on error,warning "$work"/debian/*.changes || {
    echo "package.sh: lintian finds faults in the packages" >&2
    exit 1
  }
  rm -f "$packages"/*.{deb,dsc,changes,buildinfo,tar.xz}
  mv "$work"/debian/*.{deb,dsc,changes,buildinfo,tar.xz} "$packages"
}

build_archive() {
  echo "== archive"
  cmake -S . -B build/archive -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_LIBDIR=lib -DSPILLWAY_BUNDLE=ON \
    -DSPILLWAY_LIBRARY=OFF -DSPILLWAY_TESTS=OFF --log-level=WARNING
  cmake --build build/archive -j "$jobs" --target product
  mkdir -p "$work/archive"
  cpack --config build/archive/CPackConfig.cmake -B "$work/archive" >"$packages/archive.log" 2>&1 || {
    cat "$packages/archive.log"
    echo "package.sh: the archive cannot be made" >&2
    exit 1
  }
  rm -f "$packages"/*.tar.gz
  mv "$work"/archive/*.tar.gz "$packages"
}

[[ $what == archive ]] || build_debian_packages
[[ $what == debian ]] || build_archive
echo "== build/packages"
cd "$packages"
find . -maxdepth 1 -name '*.deb' -printf '%f\n' -o -name '*.tar.gz' -printf '%f\n' | sort
