#!/usr/bin/env bash
# lint.sh format   says which sources clang-format would change (lint.sh fix changes them)
# lint.sh tidy     runs clang-tidy (.clang-tidy) over the folders of our own algorithms; needs build/release configured.
#                  Files that include VTK are left out: its headers take minutes and the warnings are not ours.
# lint.sh          both checks
set -euo pipefail
cd "$(dirname "$0")/.."

# With what -inl.h files hold: kernels, compiled once per instruction set.
sources() { git ls-files --cached --others --exclude-standard -- '*.cpp' '*.hpp' '*.h'; }

format() { sources | xargs -r clang-format-14 --style=file "$@"; }

tidy() {
  [ -f build/release/compile_commands.json ] || cmake --preset release
  sources | grep -E '^(scene|colormaps|integrals|exchange|projection|sorting|compositor|frame|reference|volume|analysis|apps)/.*\.cpp$' |
    xargs -r -P "$(nproc)" -n 2 clang-tidy-14 -p build/release --quiet 2> >(grep -v 'warnings\? generated' >&2)
}

case "${1:-all}" in
  format) format --dry-run -Werror ;;
  fix) format -i ;;
  tidy) tidy ;;
  all) format --dry-run -Werror && tidy ;;
  *)
    echo "lint.sh: $1 is not one of format, fix, tidy" >&2
    exit 2
    ;;
esac
