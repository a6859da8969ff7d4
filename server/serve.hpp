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
  /// The address for a browser, with the token; called on the first rank.
  std::function<void(const std::string& url)> listening;
  /// Called when the server ended during work that cannot be stopped, for example reading a file: exit the process, or
  /// return to wait for the work. Called from any thread.
  std::function<void()> ended_at_work;
  /// Called for a second signal: exit the process at once. On any rank, from any thread.
  std::function<void(int signal)> hurried;
  /// Called when one of several ranks has been lost: report it and exit the process. On any rank, from any thread.
  std::function<void()> rank_lost;
};

/// Serves images until SIGINT, SIGTERM or SIGHUP, on all ranks of the job; the first rank communicates with clients.
/// Throws Error for invalid options, and errors that end the run of all ranks.
void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events);

}  // namespace tessera::server
