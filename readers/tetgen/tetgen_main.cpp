// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-tetgen: fills surfaces by TetGen. A separate program, because TetGen is under the AGPL-3.0.
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"

int main() {
  using namespace tessera::readers;
  constexpr Reader readers[] = {{"fill", fill_surface}};
  serve(readers);
}
