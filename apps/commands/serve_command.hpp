// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/options/cli_fwd.hpp"
#include "apps/options/render_options.hpp"
#include "tessera/job.hpp"

namespace tessera::apps {

/// The words of `tessera serve` beside those it shares with `render`.
struct ServeWords {
  std::string bind = "127.0.0.1", port, latency = "100", certificate, key;
  std::vector<std::string> allowed_hosts;
};

void add_serve_options(CLI::App& command, RenderWords& words, ServeWords& serve);

/// `tessera serve INPUT`: pictures in a browser, exact and as they change, until SIGINT, SIGTERM or SIGHUP comes.
/// Prints the address to open. Collective. Throws Error.
void serve(const RenderWords& words, const ServeWords& serve_words, const CLI::App& command, Job& job);

}  // namespace tessera::apps
