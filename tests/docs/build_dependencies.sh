#!/usr/bin/env bash
# Compares the packages that debian/control names for a build with those of tools/packages.txt that tools/package.sh
# installs, but for what every Debian build has (build-essential), what only helps (ccache), and what checks or packs
# the result.
#
#   build_dependencies.sh CHECKOUT
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
