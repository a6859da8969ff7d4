// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/serve_command.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {

void serve(const OptionWords& /*words*/, Job& /*job*/) {
  throw bad_input("serve: this build has no server; configure with -DTESSERA_SERVER=ON");
}

}  // namespace tessera::apps
