#!/usr/bin/env bash
# Every check of the project: installs what is missing, checks the format, builds and runs all tests, once as released
# and once under ASan and UBSan, and, with CI=true, fuzzes (clang-tidy: scripts/lint.sh). Goes on after a failed stage; the end says which.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh build test

failed=()
stage() {  # stage NAME COMMAND...: runs it, remembers a failure
  local name=$1 start=$SECONDS
  shift
  echo "== $name"
  "$@" || failed+=("$name")
  echo "== $name: $((SECONDS - start)) s"
}

# A build machine compiles all there is from nothing: several sources at once take half the time.
unity=()
if [ "${CI:-}" = true ]; then unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=6); fi

build_and_test() {  # build_and_test PRESET
  cmake --preset "$1" "${unity[@]}" &&
    cmake --build --preset "$1" -j"$(nproc)" &&
    ctest --preset "$1" -j"$(nproc)" --no-tests=error 2>&1 | tee "build/$1/ctest.log"
}

stage format scripts/lint.sh format
stage release build_and_test release
stage sanitize build_and_test sanitize
if [ "${CI:-}" = true ]; then stage fuzz scripts/fuzz.sh 20; fi

# ctest's own closing lines once more, last, where they are found.
for preset in sanitize release; do
  echo "$preset:"
  grep -h 'tests passed' "build/$preset/ctest.log" || echo "no tests ran"
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "test.sh: failed: ${failed[*]}" >&2
  exit 1
fi
