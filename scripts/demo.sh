#!/usr/bin/env bash
# From a fresh Debian 12 machine to a picture: installs what is missing, builds the program, makes a mesh and renders
# it to build/demo.png. Needs the network only for packages.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh build
cmake --preset release -DTESSERA_TESTS=OFF -B build/demo
cmake --build build/demo -j"$(nproc)" --target tessera_program

tessera=build/demo/apps/tessera
"$tessera" generate demo build/demo.vtu
"$tessera" render build/demo.vtu --camera datasets/small/wake_camera.txt \
  --transfer-function datasets/small/wake_transfer_function.txt --background black -o build/demo.png
echo "The picture is $PWD/build/demo.png; the mesh beside it, demo.vtu, opens in ParaView too."
echo "To turn it in a browser: $tessera serve build/demo.vtu"
