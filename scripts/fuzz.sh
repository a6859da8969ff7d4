#!/bin/sh
# Fuzzes each parser of our own for SECONDS (default 60), from a small corpus of good files. Fails on any crash, leak,
# undefined behaviour, hang or more than 2 GiB of memory; the input that did it stays in build/fuzz/crashes.
# Usage: scripts/fuzz.sh [SECONDS] [TARGET...]
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-60}
[ $# -gt 0 ] && shift
build=build/fuzz
cmake -S . -B $build -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DTESSERA_FUZZ=ON >/dev/null
cmake --build $build --target fuzz
mkdir -p $build/crashes

for program in $build/tests/io/fuzz_*; do
  [ -x "$program" ] && [ -f "$program" ] || continue
  name=$(basename "$program")
  if [ $# -gt 0 ]; then
    case " $* " in *" $name "*) ;; *) continue ;; esac
  fi
  echo "$name: $seconds s"
  mkdir -p $build/corpus/$name
  # New finds go to the build's corpus; the seeds in the repository are only read.
  seeds=tests/io/fuzz_seeds/$name
  [ -d $seeds ] || seeds=
  "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 \
    -artifact_prefix=$build/crashes/$name- $build/corpus/$name $seeds 2>$build/$name.log ||
    { tail -n 40 $build/$name.log; echo "$name: failed; see $build/$name.log and $build/crashes"; exit 1; }
  grep -E 'number_of_executed_units|peak_rss' $build/$name.log
done
