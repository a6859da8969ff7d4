// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/listener.hpp"
#include "server/renderer.hpp"
#include "server/scene_reader.hpp"
#include "tessera/job.hpp"

namespace tessera::server {

struct ServeOptions {
  NetworkOptions network;
  std::vector<std::string> allowed_hosts;
  RendererSettings renderer;
};

/// Callbacks of the server.
struct ServeEvents {
  /// Called on the first rank with the address for a browser, which contains the token.
  std::function<void(const std::string& url)> listening;
  /// Called, from any thread, when the server ended during work that cannot be stopped, for example reading a file. The
  /// callback may exit the process, or return to wait for the work.
  std::function<void()> ended_at_work;
  /// Called for a second signal, on any rank, from any thread. The callback must exit the process at once.
  std::function<void(int signal)> hurried;
  /// Called when one of several ranks has been lost, on any rank, from any thread. The callback must report this and
  /// exit the process.
  std::function<void()> rank_lost;
};

/// Serves images until SIGINT, SIGTERM or SIGHUP, on all ranks of the job; the first rank communicates with clients.
/// Throws Error for invalid options, and errors that end the run of all ranks.
void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events);

}  // namespace tessera::server
