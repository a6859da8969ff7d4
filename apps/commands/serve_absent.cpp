// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>

#include "apps/commands/serve_command.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {

void add_serve_options(CLI::App& command, RenderWords& words, ServeWords& /*serve*/) {
  command.add_option("INPUT", words.input, "mesh or volume");
  command.allow_extras();
}

void serve(const RenderWords& /*words*/, const ServeWords& /*serve_words*/, const CLI::App& /*command*/, Job& /*job*/) {
  throw bad_input("serve: this build has no server; configure with -DTESSERA_SERVER=ON");
}

}  // namespace tessera::apps
