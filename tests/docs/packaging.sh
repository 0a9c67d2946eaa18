#!/usr/bin/env bash
# What debian/ says agrees with what the build says:
#
# - the packages that debian/control names for a build are those of tools/packages.txt that tools/package.sh installs,
#   but for what every Debian build has (build-essential), what only helps (ccache), and what checks or packs the result;
# - the version in debian/changelog is that of CMakeLists.txt, and the library's package has its first two numbers;
# - lines of descriptions are as short as lintian wants them.
#
#   packaging.sh CHECKOUT
set -euo pipefail
cd "$1"

listed=$(awk '/^\[/ { wanted = ($0 == "[build]" || $0 == "[package]"); next } wanted && /^[^#]/' tools/packages.txt |
  grep -vxE 'g\+\+|build-essential|ccache|lintian|patchelf')
named=$(sed -n '/^Build-Depends:/,/^[^ ]/{s/^ \([a-z0-9.+-]*\).*/\1/p}' debian/control |
  sed 's/^debhelper-compat$/debhelper/; s/^dh-sequence-python3$/dh-python/')
diff <(sort <<<"$listed") <(sort <<<"$named") || {
  echo "debian/control (right) and tools/packages.txt (left) name other packages" >&2
  exit 1
}

version=$(sed -n 's/^project(spillway VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
packaged=$(sed -n '1s/^spillway (\(.*\)).*/\1/p' debian/changelog)
if [[ $packaged != "$version" ]]; then
  echo "debian/changelog begins with version $packaged, and CMakeLists.txt has $version" >&2
  exit 1
fi
grep -qx "Package: libspillway${version%.*}" debian/control || {
  echo "debian/control has no package libspillway${version%.*}" >&2
  exit 1
}

if grep -nE '^ .{80}' debian/control; then
  echo "debian/control has descriptions with lines of more than 80 characters, which lintian does not like" >&2
  exit 1
fi
