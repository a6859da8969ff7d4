#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the library without optional parts and with other compilers, and runs its fast tests, so that optional parts
# stay optional. Usage: scripts/configurations.sh [NAME...], all of them by default. Each is in build/NAME.
#   no-mpi no-gl   without reader programs and that part
#   least          without any optional part, by clang 14
#   clang          without VTK, by clang 14
#   installed      what scripts/demo.sh builds on a machine without MPI, installed
# With CI=true nothing is optimized, and only tests run whose results depend on which parts are built.
set -euo pipefail
cd "$(dirname "$0")/.."

common=(-G Ninja -DTESSERA_APPS=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
tests=(fast_tests)
if [ "${CI:-}" = true ]; then
  common+=(-DCMAKE_BUILD_TYPE=None -DTESSERA_QUICK=ON)
  tests=(annotation_test callers_test cells_test io_mesh_test io_values_test io_volume_test missing_readers_test opening_trials readers_messages_test readers_test)
else
  common+=(-DCMAKE_BUILD_TYPE=Release)
fi
clang=(-DCMAKE_C_COMPILER=clang-14 -DCMAKE_CXX_COMPILER=clang++-14)
if command -v ccache >/dev/null; then
  common+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

options_of() {  # options_of NAME
  case $1 in
    no-mpi) echo -DTESSERA_READERS=OFF -DTESSERA_MPI=OFF ;;
    no-gl) echo -DTESSERA_READERS=OFF -DTESSERA_GL=OFF ;;
    least)
      echo -DTESSERA_READERS=OFF -DTESSERA_MPI=OFF -DTESSERA_JPEG=OFF -DTESSERA_TIFF=OFF -DTESSERA_GL=OFF -DTESSERA_CAIRO=OFF \
        -DTESSERA_INSTRUCTION_SETS=native "${clang[@]}" \
        -DCMAKE_DISABLE_FIND_PACKAGE_{VTK,MPI,TetGen,CLI11}=ON # as if they were not installed
      ;;
    clang) echo -DTESSERA_VTK=OFF "${clang[@]}" ;;
    *)
      echo "configurations.sh: $1 is not one of no-mpi, no-gl, least, clang, installed" >&2
      return 2
      ;;
  esac
}

build_and_install() {
  local build=build/installed prefix=build/installed/prefix
  cmake -S . -B $build "${common[@]}" -DTESSERA_APPS=ON -DTESSERA_TESTS=OFF -DTESSERA_READERS=OFF -DTESSERA_MPI=OFF \
    -DTESSERA_INSTRUCTION_SETS=native >build/installed.log || return
  cmake --build $build -j"$(nproc)" || return
  rm -rf $prefix
  cmake --install $build --prefix $prefix >>build/installed.log || return
  $prefix/bin/tessera --version | grep -q 'kernels for .* alone' && [ -s $prefix/share/man/man1/tessera.1 ] && [ -s $prefix/include/tessera/tessera.hpp ] &&
    [ ! -e $prefix/libexec ] && $prefix/bin/tessera formats | grep -q 'needs tessera-read-gmsh, which is not installed'
}

build_and_test() {  # build_and_test NAME
  local options
  if [ "$1" = installed ]; then
    build_and_install
    return
  fi
  options=$(options_of "$1") || return
  # shellcheck disable=SC2086
  cmake -S . -B "build/$1" "${common[@]}" $options >"build/$1.log" || return
  cmake --build "build/$1" -j"$(nproc)" --target tessera_shared tessera_static tessera_analysis "${tests[@]}" -- -k 0 || return
  ctest --test-dir "build/$1" -L fast -j"$(nproc)" --no-tests=error --output-on-failure
}

if [ $# -eq 0 ]; then set -- no-mpi no-gl least clang installed; fi
mkdir -p build
failed=()
for name in "$@"; do
  echo "-- $name"
  build_and_test "$name" || failed+=("$name")
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "configurations.sh: failed: ${failed[*]}" >&2
  exit 1
fi
