#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the packages of scripts/packages.txt for the given scopes, e.g. `install_packages.sh build test`, and with
# build unpacks headers missing on the machine into build/headers.
# Does nothing, and needs no privileges, if everything is there already.
set -euo pipefail
cd "$(dirname "$0")/.."

packages_of() { awk -v scope="$1" '$1 == scope { print $2, $3 }' scripts/packages.txt; }

missing=() headers=()
for scope in "$@"; do
  while read -r package _; do
    # Node.js and npm often come from another source; Debian's packages conflict with it.
    case $package in nodejs) command -v node >/dev/null && continue ;; npm) command -v npm >/dev/null && continue ;; esac
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=none
    [ "$status" = installed ] || missing+=("$package")
  done < <(packages_of "$scope")
  if [ "$scope" = build ]; then
    while read -r package header; do
      [ -e "/usr/include/$header" ] || [ -e "build/headers/usr/include/$header" ] || headers+=("$package")
    done < <(packages_of headers)
  fi
done
[ ${#missing[@]} -eq 0 ] && [ ${#headers[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: neither root nor sudo; ask an administrator to run: apt-get install ${missing[*]} ${headers[*]}" >&2
    exit 3
  fi
  as_root=(sudo)
fi

export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q </dev/null
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  "${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null
fi
if [ ${#headers[@]} -gt 0 ]; then
  echo "Unpacking the headers of ${headers[*]} into build/headers"
  downloads=$(mktemp -d)
  (cd "$downloads" && apt-get -o APT::Sandbox::User=root download -q "${headers[@]}" </dev/null)
  for package in "$downloads"/*.deb; do dpkg-deb -x "$package" "$downloads/unpacked"; done
  mkdir -p build/headers/usr
  cp -r "$downloads/unpacked/usr/include" build/headers/usr/
  rm -r "$downloads"
fi
