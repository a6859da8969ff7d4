// tessera-read-gmsh: reads what Gmsh's library reads, as tessera-read does other formats. A program of its own, since
// that library takes a while to load and is under the GPL.
#include "io/helper/gmsh_file.hpp"
#include "io/helper/serve.hpp"

int main() {
  using namespace tessera::io::helper;
  constexpr Reader readers[] = {{"gmsh", read_gmsh}, {"by_gmsh", read_by_gmsh}};
  serve(readers);
}
