#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Adds the programs that read formats with third-party libraries (VTK, Gmsh, GDCM, ...) to the build of scripts/demo.sh,
# or to another build: scripts/readers.sh [BUILD_FOLDER]. Installs their dependencies; `tessera` itself does not change.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build/demo}
if [ ! -f "$build/CMakeCache.txt" ]; then
  echo "readers.sh: $build is not built yet; run scripts/demo.sh first, or name a folder that is" >&2
  exit 2
fi
scripts/install_packages.sh readers
cmake -B "$build" -DTESSERA_READERS=ON
cmake --build "$build" -j"$(nproc)" --target tessera_readers
echo "They are in $build/libexec/tessera, where $build/apps/tessera finds them."
