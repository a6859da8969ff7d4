#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a new Debian 12 machine to an image: installs missing packages, builds the program, generates a mesh and renders
# it to build/demo.png. Needs the network only for packages. scripts/readers.sh builds the programs that read formats
# with third-party libraries; MPI is used if the machine has it.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh build
# Kernels for only this machine compile in half the time.
options=(-DTESSERA_TESTS=OFF -DTESSERA_INSTRUCTION_SETS=native)
mpi=OFF
if command -v mpicc >/dev/null; then mpi=ON; fi
if [ ! -f build/demo/CMakeCache.txt ]; then options+=(-DTESSERA_READERS=OFF); fi # otherwise as scripts/readers.sh set it
# `cmake --install build/demo` installs everything.
cmake --preset release "${options[@]}" -DTESSERA_MPI=$mpi -B build/demo
cmake --build build/demo -j"$(nproc)"

tessera=build/demo/apps/tessera
"$tessera" generate demo build/demo.vtu
"$tessera" render build/demo.vtu --camera datasets/small/wake_camera.txt \
  --transfer-function datasets/small/wake_transfer_function.txt --background black -o build/demo.png
echo "The picture is $PWD/build/demo.png; the mesh beside it, demo.vtu, opens in ParaView too."
echo "To turn it in a browser: $tessera serve build/demo.vtu"
echo "To read Exodus, OpenFOAM, Gmsh, DICOM and others (tessera formats lists them): scripts/readers.sh"
if [ $mpi = OFF ]; then
  echo "To render with several processes: scripts/install_packages.sh mpi, then scripts/demo.sh again"
fi
