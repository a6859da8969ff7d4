#!/usr/bin/env bash
# From a fresh Debian 12 machine to a picture: installs what is missing, builds the program, makes a mesh and renders
# it to build/demo.png. Needs the network only for packages.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh build
cmake --preset release -DTESSERA_TESTS=OFF -B build/demo
cmake --build build/demo -j"$(nproc)" --target tessera

tessera=build/demo/apps/tessera
"$tessera" generate flow build/demo.vtu
"$tessera" render build/demo.vtu -o build/demo.png --background white
echo "The picture is $PWD/build/demo.png"
