#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the build into a separate directory, builds examples/ and a file by pkg-config with it, moves it, and uses it
# again. CMakeLists.txt sets the environment.
set -euo pipefail

failed() {
  echo "package_test.sh: $*" >&2
  exit 1
}
quietly() { "$@" >"$SCRATCH/log" 2>&1 || { cat "$SCRATCH/log"; failed "$*"; }; }

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
unset DESTDIR CMAKE_PREFIX_PATH tessera_DIR tessera_ROOT
rm -rf "$SCRATCH"
mkdir -p "$SCRATCH"
first=$SCRATCH/first moved=$SCRATCH/elsewhere/tessera
quietly "$CMAKE" --install "$BUILD" --prefix "$first"

# No path of the build machine.
if grep -rlaF -e "$BUILD" -e "$SOURCE" "$first"; then failed "the files above name the build's folders"; fi
for header in "$SOURCE"/include/tessera/*.hpp; do
  [ -f "$first/include/tessera/$(basename "$header")" ] || failed "$header is not installed"
done

# The shared library exports exactly the public API, and links neither VTK nor TetGen.
if [ "$SHARED" = 1 ]; then
  shown=$(nm -DC --defined-only "$first/$LIBDIR/libtessera.so" | sed 's/^[0-9a-f]* . //')
  others=$(grep -vE '^(typeinfo (name )?for |vtable for |VTT for )?tessera::' <<<"$shown" || true)
  [ -z "$others" ] || failed "libtessera.so shows $others"
  inside=$(grep -E '(^| )tessera::(scene|system|colormaps|cells|io|exchange|frame|api|volume|apps)::' <<<"$shown" || true)
  [ -z "$inside" ] || failed "libtessera.so shows of its inside $inside"
  [[ $shown =~ tessera::v[0-9]+_[0-9]+::version\(\) ]] || failed "version() is not shown, with its namespace"
  foreign=$(readelf -d "$first/$LIBDIR/libtessera.so" | grep -E 'NEEDED.*(libvtk|libtet)' || true)
  [ -z "$foreign" ] || failed "libtessera.so links $foreign"
fi

build_examples() {  # build_examples FOLDER PREFIX [OPTION...]
  local folder=$SCRATCH/$1 prefix=$2
  shift 2
  # Without optimization, which compiles in half the time.
  quietly "$CMAKE" -S "$SOURCE/examples" -B "$folder" -G "$GENERATOR" -DCMAKE_BUILD_TYPE= \
    -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_C_COMPILER="$CC" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF "$@"
  grep -q "^tessera_DIR:.*=$prefix/" "$folder/CMakeCache.txt" || failed "another Tessera than $prefix was found"
  quietly "$CMAKE" --build "$folder"
  # Each renders its image.
  (cd "$folder" && quietly ./mesh_from_arrays && [ -s mesh.png ]) || failed "$folder/mesh_from_arrays"
  { # a format that does not need another library
    printf '%s\n' NRRD0004 'type: float' 'dimension: 3' 'sizes: 9 9 9' 'encoding: ascii' ''
    seq 729
  } >"$SCRATCH/grid.nrrd"
  "$folder/tiles_and_stop" "$SCRATCH/grid.nrrd" >"$SCRATCH/log" || failed "$folder/tiles_and_stop"
  [ "$(sed 's/.*: //' "$SCRATCH/log" | tr '\n' ' ')" = "stopped whole " ] || failed "$folder/tiles_and_stop: $(cat "$SCRATCH/log")"
  printf '%s' '{"size": "64x48", "view": "front", "transfer-function": "viridis:rise", "iso": [300, "500:red:0.5"]}' \
    >"$SCRATCH/state.json"
  (cd "$folder" && quietly ./picture_of_state "$SCRATCH/grid.nrrd" "$SCRATCH/state.json") || failed "$folder/picture_of_state"
  if [ "$APPS" = 1 ]; then # must be the program's image of the same state in TOML
    printf '%s\n' 'size = "64x48"' 'view = "front"' 'transfer-function = "viridis:rise"' 'iso = [300, "500:red:0.5"]' \
      >"$SCRATCH/state.toml"
    quietly "$prefix/bin/tessera" render "$SCRATCH/grid.nrrd" --config "$SCRATCH/state.toml" -o "$SCRATCH/picture.png" --quiet
    cmp "$folder/picture.png" "$SCRATCH/picture.png" || failed "$folder/picture_of_state draws another picture than the program"
  fi
  if [ "$CAIRO" = 1 ]; then
    (cd "$folder" && quietly ./annotated_picture "$SCRATCH/grid.nrrd" && [ -s annotated.png ] && [ -s layer.png ]) ||
      failed "$folder/annotated_picture"
  else # it must report the reason
    if (cd "$folder" && ./annotated_picture "$SCRATCH/grid.nrrd" >"$SCRATCH/log" 2>&1); then
      failed "$folder/annotated_picture drew without Cairo"
    fi
    [[ $(<"$SCRATCH/log") == *'needs Cairo'* ]] || failed "$folder/annotated_picture: $(cat "$SCRATCH/log")"
  fi
  if [ "$VTK" = 1 ]; then # needs a reader program, which must be found relative to the library
    { printf '%s\n' '# vtk DataFile Version 3.0' grid ASCII 'DATASET STRUCTURED_POINTS' 'DIMENSIONS 9 9 9' 'ORIGIN 0 0 0' \
      'SPACING 1 1 1' 'POINT_DATA 729' 'SCALARS s float 1' 'LOOKUP_TABLE default'; seq 729; } >"$SCRATCH/grid.vtk"
    quietly "$folder/tiles_and_stop" "$SCRATCH/grid.vtk"
  fi
  if [ -x "$folder/grid_on_ranks" ]; then
    (cd "$folder" && quietly mpirun --oversubscribe -n 3 ./grid_on_ranks && [ -s grid.png ]) || failed "$folder/grid_on_ranks"
  fi
}

if [ "$SHARED" = 1 ]; then
  build_examples shared "$first"
  [[ $(readelf -d "$SCRATCH/shared/mesh_from_arrays") == *"[libtessera.so.${VERSION%.*}]"* ]] || failed "it is not linked shared"
fi
if [ "$STATIC" = 1 ]; then
  build_examples static "$first" -DTESSERA_EXAMPLES_STATIC=ON
  [[ $(readelf -d "$SCRATCH/static/mesh_from_arrays") != *libtessera* ]] || failed "it is not linked statically"
fi

if [ "$STATIC" = 1 ]; then # the complete archive, so that all its dependencies must be found
  mkdir "$SCRATCH/whole"
  cat >"$SCRATCH/whole/CMakeLists.txt" <<TEXT
cmake_minimum_required(VERSION 3.25)
project(whole LANGUAGES C CXX)
find_package(tessera REQUIRED COMPONENTS static OPTIONAL_COMPONENTS mpi)
add_executable(version "$SOURCE/tests/package/version.cpp")
target_link_libraries(version PRIVATE "\$<LINK_LIBRARY:WHOLE_ARCHIVE,tessera::static>")
if(TARGET tessera::mpi)
  add_executable(ranks ranks.cpp)
  target_link_libraries(ranks PRIVATE tessera::mpi)
endif()
TEXT
  printf '%s\n' '#include <mpi.h>' '#include <tessera/version.hpp>' \
    'int main() { return MPI_VERSION < 3 || *tessera::version() == 0; }' >"$SCRATCH/whole/ranks.cpp"
  quietly "$CMAKE" -S "$SCRATCH/whole" -B "$SCRATCH/whole/build" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" \
    -DCMAKE_C_COMPILER="$CC" -DCMAKE_PREFIX_PATH="$first"
  quietly "$CMAKE" --build "$SCRATCH/whole/build"
fi

# pkg-config, as used by a line in a Makefile.
from_pkg_config() {  # from_pkg_config PREFIX [--static]
  local flags
  flags=$(PKG_CONFIG_PATH=$1/$LIBDIR/pkgconfig pkg-config --cflags --libs "${@:2}" tessera)
  # The complete archive, so that all dependencies must be listed.
  if [ "${2:-}" = --static ]; then
    flags=${flags/-ltessera/-Wl,--whole-archive -l:libtessera.a -Wl,--no-whole-archive}
  fi
  # shellcheck disable=SC2086
  quietly "$CXX" -std=c++20 "$SOURCE/tests/package/version.cpp" $flags -Wl,-rpath,"$1/$LIBDIR" -o "$SCRATCH/by_pkg_config"
  [ "$("$SCRATCH/by_pkg_config")" = "$VERSION" ] || failed "the program built by pkg-config prints something else"
}
from_pkg_config "$first"
if [ "$STATIC" = 1 ]; then from_pkg_config "$first" --static; fi

# The README's program, built by its command.
awk '/^```cpp/ { on = 1; next } /^```/ && on { exit } on' "$SOURCE/README.md" >"$SCRATCH/snippet"
{ grep '^#' "$SCRATCH/snippet" && echo 'int main() {' && grep -v '^#' "$SCRATCH/snippet" && echo '}'; } >"$SCRATCH/readme.cpp"
(
  export PKG_CONFIG_PATH=$first/$LIBDIR/pkgconfig
  # shellcheck disable=SC2046
  quietly "$CXX" -std=c++20 "$SCRATCH/readme.cpp" -o "$SCRATCH/readme" \
    $(pkg-config --cflags --libs tessera) -Wl,-rpath,"$first/$LIBDIR"
)
if [ "$APPS" = 1 ]; then
  quietly "$first/bin/tessera" generate cube "$SCRATCH/mesh.vtu" n=4
  (cd "$SCRATCH" && quietly ./readme && [ -s mesh.png ]) || failed "the README's program"
fi

# Other minor versions are not accepted.
mkdir "$SCRATCH/versions"
IFS=. read -r major minor _ <<<"$VERSION"
find_version() {  # find_version VERSION
  printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(versions LANGUAGES CXX)' "find_package(tessera $1 REQUIRED)" \
    >"$SCRATCH/versions/CMakeLists.txt"
  "$CMAKE" -S "$SCRATCH/versions" -B "$SCRATCH/versions/build" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" \
    -DCMAKE_PREFIX_PATH="$first" >"$SCRATCH/log" 2>&1
}
find_version "$major.$minor" || failed "version $major.$minor is not found"
for other in "$major.$((minor + 1))" "$((major + 1)).$minor"; do
  if find_version "$other"; then failed "$VERSION is taken for $other"; fi
done

# Missing components are reported.
mkdir "$SCRATCH/lacking"
cat >"$SCRATCH/lacking/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(lacking LANGUAGES CXX)
find_package(tessera 0.1 REQUIRED COMPONENTS teapot)
TEXT
if "$CMAKE" -S "$SCRATCH/lacking" -B "$SCRATCH/lacking/build" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" \
  -DCMAKE_PREFIX_PATH="$first" >"$SCRATCH/log" 2>&1; then
  failed "a component that there is not was found"
fi
[[ $(tr -s ' \n' ' ' <"$SCRATCH/log") == *'was built without: teapot'* ]] || {
  cat "$SCRATCH/log"
  failed "the message of a component that is not there"
}

# At another location.
mkdir -p "$(dirname "$moved")"
mv "$first" "$moved"
if [ "$SHARED" = 1 ]; then
  build_examples moved "$moved"
else
  build_examples moved "$moved" -DTESSERA_EXAMPLES_STATIC=ON
fi
from_pkg_config "$moved"
if [ "$APPS" = 1 ]; then [ "$("$moved/bin/tessera" --version | head -1)" = "tessera $VERSION" ] || failed "bin/tessera --version"; fi

# As a subdirectory of another project: only configured.
mkdir "$SCRATCH/parent"
cat >"$SCRATCH/parent/CMakeLists.txt" <<TEXT
cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES CXX)
add_subdirectory("$SOURCE" tessera)
foreach(target tessera_program tessera_apps scene_test)
  if(TARGET \${target})
    message(FATAL_ERROR "\${target} is part of another project's build")
  endif()
endforeach()
add_executable(program "$SOURCE/tests/package/version.cpp")
target_link_libraries(program PRIVATE tessera::tessera \$<TARGET_NAME_IF_EXISTS:tessera::mpi>)
add_executable(static_program "$SOURCE/tests/package/version.cpp")
target_link_libraries(static_program PRIVATE tessera::static)
TEXT
# The same parts as in this build: packages of others may be missing here.
mapfile -t options < <(sed -nE 's/^(TESSERA_(READERS|VTK|MPI|GL|CAIRO|TETGEN)):BOOL=(.*)$/-D\1=\3/p' "$BUILD/CMakeCache.txt")
quietly "$CMAKE" -S "$SCRATCH/parent" -B "$SCRATCH/parent/build" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" \
  -DCMAKE_C_COMPILER="$CC" "${options[@]}"
[ ! -e "$SCRATCH/parent/build/compile_commands.json" ] || failed "it sets options of the project around it"
