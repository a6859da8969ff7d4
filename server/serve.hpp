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

/// What the server tells its caller.
struct ServeEvents {
  /// Where a browser finds it, with its token; on the first rank.
  std::function<void(const std::string& url)> listening;
  /// It ended while something is in work that cannot be stopped, such as the reading of a file: to leave the process,
  /// or return and wait for it. From any thread.
  std::function<void()> ended_at_work;
  /// A signal came after the one that ends it: to leave the process at once. On any rank, from any thread.
  std::function<void(int signal)> hurried;
  /// Of several ranks one is gone: to say so, and to leave the process. On any rank, from any thread.
  std::function<void()> rank_lost;
};

/// Serves pictures until SIGINT, SIGTERM or SIGHUP comes, on all ranks of the job; the first one speaks with clients.
/// Throws Error for options that cannot be, and what ends the run of all ranks.
void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events);

}  // namespace tessera::server
