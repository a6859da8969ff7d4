#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# lint.sh format   lists the sources that clang-format would change (lint.sh fix changes them)
# lint.sh tidy     runs clang-tidy (.clang-tidy) on the sources, including headers through them, as configured in
#                  build/tidy. Excludes tests, and readers/, which include VTK: its headers take minutes and their
#                  warnings are not ours.
# lint.sh changed  tidies only what differs from the main branch at the branch point (if nothing does: what the last
#                  commit changed), for at most 6 minutes; lists what it did not reach
# lint.sh          format and tidy
set -euo pipefail
cd "$(dirname "$0")/.."

# Includes -inl.h files: kernels, compiled once per instruction set.
sources() { git ls-files --cached --others --exclude-standard -- '*.cpp' '*.hpp' '*.h'; }
ours='^(scene|system|colormaps|cells|io|integrals|exchange|projection|sorting|compositor|frame|api|reference|volume|analysis|annotation|server|apps|gl|datasets)/.*'

format() { sources | xargs -r clang-format-14 --style=file "$@"; }

# Kernels once, as AVX2, instead of once per instruction set.
one_set=(--extra-arg=-march=haswell --extra-arg=-DHWY_COMPILE_ONLY_STATIC)
# Options supported only by g++ are not errors of the sources.
one_set+=(--extra-arg=-Wno-unused-command-line-argument)

tidy_files() {  # tidy_files < LIST: one per core at a time; prints each finished file on stdout
  # Each source separately; clang cannot use the compiler's precompiled headers.
  cmake --preset release -B build/tidy -DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >&2
  cmake --build build/tidy --target tessera_commit >&2
  xargs -r -P "$(nproc)" -I{} sh -c 'clang-tidy-14 -p build/tidy --quiet "$@" {} >&2 || exit 1; echo {}' \
    tidy "${one_set[@]}" 2> >(grep -v 'warnings\? generated' >&2)
}

tidy() { sources | grep -E "$ours\.cpp\$" | tidy_files >/dev/null; }

# The source that checks a changed file: itself, or for a header a source that includes it, if possible the one with the
# same name, or else through other headers.
seen_through() {  # seen_through FILE [DEPTH]
  local file=$1 depth=${2:-0} includers own includer
  case $file in
    *.cpp) echo "$file" && return ;;
  esac
  [ "$depth" -lt 4 ] || return 0
  includers=$(sources | grep -E "$ours\$" | xargs -r grep -lF "#include \"${file#include/}\"" || true)
  own=${file%.*}.cpp
  includer=$({ grep -xF "$own" <<<"$includers" || grep '\.cpp$' <<<"$includers" || echo "$includers"; } | head -1)
  [ -z "$includer" ] || seen_through "$includer" $((depth + 1))
}

changed() {
  local base minutes=6 list done_list status=0 file left
  if ! git rev-parse -q --verify HEAD~1 >/dev/null 2>&1; then
    echo "lint.sh: no history to compare with; tidied nothing"
    return
  fi
  base=$(git merge-base HEAD origin/main 2>/dev/null || git merge-base HEAD main 2>/dev/null || git rev-parse HEAD~1)
  if [ "$base" = "$(git rev-parse HEAD)" ] && git diff --quiet HEAD; then base=$(git rev-parse HEAD~1); fi
  list=$(mktemp) done_list=$(mktemp)
  {
    git diff --name-only --diff-filter=d "$base"
    git ls-files --others --exclude-standard
  } | grep -E '\.(cpp|hpp|h)$' | while read -r file; do seen_through "$file"; done | grep -E "$ours\$" | sort -u >"$list" || true
  if [ ! -s "$list" ]; then
    echo "lint.sh: no source changed since $(git rev-parse --short "$base"); tidied nothing"
  else
    echo "lint.sh: $(wc -l <"$list") sources changed since $(git rev-parse --short "$base")"
    timeout $((60 * minutes)) scripts/lint.sh files <"$list" >"$done_list" || status=$?
    left=$(sort "$done_list" | comm -13 - "$list")
    if [ "$status" = 124 ]; then
      echo "lint.sh: $minutes minutes are over; not looked at: ${left//$'\n'/ }"
      status=0
    fi
  fi
  rm -f "$list" "$done_list"
  return "$status"
}

case "${1:-all}" in
  format) format --dry-run -Werror ;;
  fix) format -i ;;
  tidy) tidy ;;
  changed) changed ;;
  files) tidy_files ;; # the list on stdin: for `changed`, which limits its time
  all) format --dry-run -Werror && tidy ;;
  *)
    echo "lint.sh: $1 is not one of format, fix, tidy, changed" >&2
    exit 2
    ;;
esac
