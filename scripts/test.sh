#!/usr/bin/env bash
# test.sh        installs what is missing, checks the format, builds and runs all tests as released
# test.sh --all  also under ASan and UBSan and TSan, without the parts that are options, fuzzes, and runs clang-tidy
# With CI=true, as .ci/run calls it, all but TSan and most of the configurations; clang-tidy sees what changed, for some
# minutes at most. Goes on after a failed stage; the end says which.
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

scripts/install_packages.sh build test

failed=()
stage() {  # stage NAME COMMAND...: runs it, remembers a failure
  local name=$1 start=$SECONDS
  shift
  echo "== $name"
  "$@" || failed+=("$name")
  echo "== $name: $((SECONDS - start)) s"
}

# Several sources compiled at once take half the time; --all compiles each by itself, which finds what one lacks.
unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=6)
if [ "$extent" = all ]; then unity=(-DCMAKE_UNITY_BUILD=OFF); fi

build_and_test() {  # build_and_test PRESET
  cmake --preset "$1" "${unity[@]}" &&
    cmake --build --preset "$1" -j"$(nproc)" &&
    ctest --preset "$1" -j"$(nproc)" --no-tests=error 2>&1 | tee "build/$1/ctest.log"
}

stage format scripts/lint.sh format
stage release build_and_test release
presets=(release)
if [ -n "$extent" ]; then
  stage sanitize build_and_test sanitize
  presets=(sanitize release)
  if [ "$extent" = all ]; then configurations=(); else configurations=(least); fi
  stage configurations scripts/configurations.sh "${configurations[@]}"
  stage fuzz scripts/fuzz.sh 20
fi
if [ "$extent" = ci ]; then stage tidy scripts/lint.sh changed; fi
if [ "$extent" = all ]; then
  unity=() # as the preset has it
  stage threads build_and_test threads
  presets=(threads "${presets[@]}")
  stage tidy scripts/lint.sh tidy
fi

# What failed tests printed, and ctest's own closing lines, once more and last, where they are found.
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
if [ ${#failed[@]} -gt 0 ]; then
  echo "test.sh: failed: ${failed[*]}" >&2
  exit 1
fi
