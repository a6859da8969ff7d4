#!/usr/bin/env bash
# Installs what scripts/packages.txt lists for the scopes given, e.g. `install_packages.sh build test`.
# Does nothing, and needs no rights, when all of it is there already.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=()
for scope in "$@"; do
  while read -r package; do
    # Node.js often comes from elsewhere, npm with it; Debian's would not go beside it.
    case $package in nodejs) command -v node >/dev/null && continue ;; npm) command -v npm >/dev/null && continue ;; esac
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=none
    [ "$status" = installed ] || missing+=("$package")
  done < <(awk -v scope="$scope" '$1 == scope { print $2 }' scripts/packages.txt)
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: neither root nor sudo; ask an administrator to run: apt-get install ${missing[*]}" >&2
    exit 3
  fi
  as_root=(sudo)
fi

echo "Installing ${#missing[@]} packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q </dev/null
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null
