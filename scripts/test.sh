#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# test.sh        installs missing packages, checks the format, builds and runs all tests of the release build
# test.sh --all  also under ASan, UBSan and TSan, without optional parts, fuzzes, and runs clang-tidy
# With CI=true, as called by .ci/run, everything except TSan and most of the configurations; the sanitizer build and the
# configuration are quick ones (TESSERA_QUICK), the former without tests that wait for stalls; clang-tidy checks changed
# files for at most some minutes. Stages that have not begun after 65 minutes are left out. Continues after a failed
# stage; the summary lists failed and omitted stages.
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  '') extent=${CI:+ci} ;;
  --all) extent=all ;;
  *)
    echo "test.sh: $1 is not --all" >&2
    exit 2
    ;;
esac

scripts/install_packages.sh build mpi readers test
# mpirun's hwloc searches for X servers at localhost:1 to :9; if that name does not resolve, each start may wait 5 s for
# it.
export HWLOC_COMPONENTS=-gl

failed=() left_out=()
stage() {  # stage NAME COMMAND...: runs it, records a failure
  local name=$1 start=$SECONDS
  shift
  if [ "$extent" = ci ] && [ "$start" -gt $((65 * 60)) ]; then
    left_out+=("$name")
    return
  fi
  echo "== $name"
  "$@" || failed+=("$name")
  echo "== $name: $((SECONDS - start)) s"
}

# --all compiles each source separately, which detects a missing #include.
options=()
if [ "$extent" = all ]; then options=(-DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON); fi

# More than the number of cores: many tests wait for processes.
tests_at_once=$((2 * $(nproc)))

build_and_test() {  # build_and_test PRESET [CTEST_ARGUMENT...]
  local preset=$1
  shift
  cmake --preset "$preset" "${options[@]}" &&
    cmake --build --preset "$preset" -j"$(nproc)" &&
    ctest --preset "$preset" -j"$tests_at_once" --no-tests=error "$@" 2>&1 | tee "build/$preset/ctest.log"
}

stage format scripts/lint.sh format
stage release build_and_test release
presets=(release)
if [ -n "$extent" ]; then
  sanitized=()
  if [ "$extent" = ci ]; then
    sanitized=(-E '^Rank(Faults|Limits|Stalls)\.')
    options+=(-DTESSERA_QUICK=ON)
  fi
  stage sanitize build_and_test sanitize "${sanitized[@]}"
  presets=(sanitize release)
  if [ "$extent" = all ]; then configurations=(); else configurations=(least); fi
  stage configurations scripts/configurations.sh "${configurations[@]}"
  stage fuzz scripts/fuzz.sh 20000x
fi
if [ "$extent" = ci ]; then stage tidy scripts/lint.sh changed; fi
if [ "$extent" = all ]; then
  options=() # those of the preset
  stage threads build_and_test threads
  presets=(threads "${presets[@]}")
  stage tidy scripts/lint.sh tidy
fi

# Output of failed tests, and ctest's own summary, printed again at the end, where they are easy to find.
for preset in "${presets[@]}"; do
  echo "$preset:"
  log=build/$preset/ctest.log
  if [ -f "$log" ]; then
    awk '/^ +Start +[0-9]+:/ { next }
         /tests passed/ { print; shown = 0; next }
         /Test +#[0-9]+:/ { shown = /\*\*\*(Failed|Timeout|Exception)/ ? 60 : 0 }
         shown-- > 0' "$log"
  else
    echo "no tests ran"
  fi
done
if [ ${#left_out[@]} -gt 0 ]; then echo "test.sh: left out for want of time: ${left_out[*]}"; fi
if [ ${#failed[@]} -gt 0 ]; then
  echo "test.sh: failed: ${failed[*]}" >&2
  exit 1
fi
