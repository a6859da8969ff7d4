// tessera-read-tetgen: fills surfaces by TetGen. A program of its own, since TetGen is under the AGPL-3.0.
#include "io/helper/readers.hpp"
#include "io/helper/serve.hpp"

int main() {
  using namespace tessera::io::helper;
  constexpr Reader readers[] = {{"fill", fill_surface}};
  serve(readers);
}
