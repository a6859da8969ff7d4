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
  /// It ended while a file was read, which nobody can stop: to leave the process, or return and wait for it.
  std::function<void()> ended_while_reading;
  /// Of several ranks one is gone: to say so, and to leave the process. On any rank, from any thread.
  std::function<void()> rank_lost;
};

/// Serves pictures until SIGINT or SIGTERM comes, on all ranks of the job; the first one speaks with clients. Throws
/// Error for options that cannot be, and what ends the run of all ranks.
void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events);

}  // namespace tessera::server
