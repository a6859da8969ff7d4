#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes each of our own parsers for SECONDS (default 60), as many at once as there are cores, from a small corpus of
# valid files. Fails on any crash, leak, undefined behaviour, hang or more than 2 GiB of memory; the input that caused
# it is kept in build/fuzz/crashes. COUNTx instead of SECONDS tries COUNT inputs for each parser, from an empty corpus.
# They are the same in all runs of the same sources, where setarch may fix addresses.
# Usage: scripts/fuzz.sh [SECONDS | COUNTx] [TARGET...]
set -euo pipefail
cd "$(dirname "$0")/.."
export extent=${1:-60} build=build/fuzz
[ $# -gt 0 ] && shift
cmake -S . -B $build -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DTESSERA_FUZZ=ON \
  -DTESSERA_SANITIZE=fuzzer-no-link,address,undefined \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG" \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 >/dev/null
cmake --build $build -j"$(nproc)" --target fuzz
mkdir -p $build/crashes

fuzz_one() {  # fuzz_one TARGET
  local name=$1 seeds program
  seeds=$(echo tests/*/fuzz_seeds/"$1") program=$(echo $build/tests/*/"$1")
  # New inputs go to the build's corpus; the seeds in the repository are only read.
  local corpus=$build/corpus/$name limit=(-max_total_time="$extent") start=()
  if [ "${extent%x}" != "$extent" ]; then
    # Addresses and times must not guide libFuzzer: comparisons include addresses, entropic schedules times.
    if setarch -R true 2>/dev/null; then start=(setarch -R); fi
    limit=(-runs="${extent%x}" -seed=1 -entropic=0 -use_cmp=0) corpus=$build/repeated/$name
    rm -rf "$corpus"
  fi
  mkdir -p "$corpus"
  [ -d "$seeds" ] || seeds=
  if ! "${start[@]}" "$program" "${limit[@]}" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
    -print_final_stats=1 -artifact_prefix="$build/crashes/$name-" "$corpus" $seeds 2>"$build/$name.log"; then
    tail -n 40 "$build/$name.log"
    echo "$name: failed; see $build/$name.log and $build/crashes"
    return 1
  fi
  awk -v name="$name" '/number_of_executed_units/ {n = $2} /peak_rss/ {m = $2}
    END {print name ": " n " inputs, " m " MiB"}' "$build/$name.log"
}
export -f fuzz_one

if [ $# -eq 0 ]; then
  for source in tests/io/fuzz_*.cpp tests/server/fuzz_server_*.cpp; do set -- "$@" "$(basename "$source" .cpp)"; done
fi
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'fuzz_one {}'
