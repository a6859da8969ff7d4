// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-gmsh: reads formats supported by Gmsh's library, as tessera-read-vtk does for other formats. A separate
// program, because that library takes a while to load and is under the GPL.
#include "readers/common/serve.hpp"
#include "readers/gmsh/gmsh_file.hpp"

#ifdef __SANITIZE_ADDRESS__
// Disables a check that Gmsh 4.8 fails: it frees an array of prisms' faces as a single object
// (ClosureGen::getFaceClosurePrism).
extern "C" [[gnu::visibility("default"), gnu::used]] const char*
__asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "alloc_dealloc_mismatch=0";
}
#endif

int main() {
  using namespace tessera::readers;
  constexpr Reader readers[] = {{"gmsh", read_gmsh}, {"by_gmsh", read_by_gmsh}};
  serve(readers);
}
