#!/usr/bin/env bash
# Installs what is missing of the Debian packages in tools/packages.txt. Needs root, or sudo, only if
# something is missing.
#
#   tools/install_packages.sh build   what a build of the library and the command needs
#   tools/install_packages.sh [test]  what tests and benchmarks need, too
#   tools/install_packages.sh long    what tools/test_long.sh and the preset fuzz need besides
#   tools/install_packages.sh package what tools/package.sh needs
set -euo pipefail

list=$(dirname "${BASH_SOURCE[0]}")/packages.txt
case ${1:-test} in
  build) sections='build' ;;
  test) sections='build test' ;;
  long) sections='build test long' ;;
  package) sections='build package' ;;
  *)
    echo "install_packages.sh: '$1' is none of build, test, long, package" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null; then
  echo "install_packages.sh: this is no Debian; install what corresponds to $list yourself" >&2
  exit 1
fi

missing=()
while read -r package; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done < <(awk -v wanted=" $sections " '
  /^\[/ { section = substr($0, 2, length($0) - 2); next }
  /^[^#]/ && index(wanted, " " section " ") { print }' "$list")
((${#missing[@]} > 0)) || exit 0

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: run as root (or install sudo): apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@"
}

echo "Installing ${missing[*]}"
# Package lists may be missing or out of date; they are fetched only then.
if ! apt install -y --no-install-recommends "${missing[@]}" >/dev/null 2>&1; then
  apt update
  apt install -y --no-install-recommends "${missing[@]}" >/dev/null
fi
