#!/usr/bin/env bash
# Compares the packages that debian/control names for a build with those of tools/packages.txt, but for the compiler and
# its cache, which Debian has anyway or does without, and for what the packaging itself adds.
#
#   build_dependencies.sh CHECKOUT
set -euo pipefail
cd "$1"

listed=$(awk '/^\[/ { build = ($0 == "[build]"); next } build && /^[^#]/' tools/packages.txt | grep -vxE 'g\+\+|ccache')
named=$(sed -n '/^Build-Depends:/,/^[^ ]/{s/^ \([a-z0-9.+-]*\).*/\1/p}' debian/control |
  grep -vxE 'debhelper-compat|dh-sequence-python3|python3-numpy')
diff <(sort <<<"$listed") <(sort <<<"$named") || {
  echo "debian/control (right) and tools/packages.txt (left) name other packages" >&2
  exit 1
}
