#include "server/serve.hpp"

#include <fmt/format.h>

#include "server/access.hpp"
#include "tessera/error.hpp"

namespace tessera::server {
namespace {

/// An address as it stands in one of the web: IPv6 in brackets; all of a machine's by its loopback.
std::string web_host(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") return "127.0.0.1";
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

}  // namespace

void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events) {
  if (job.rank() != 0) {
    Stage stage(
        reader, job, options.renderer.memory_bytes, [] {}, [](const Reading& /*reading*/) {});
    return stage.follow();
  }
  const Access access(options.network.address, options.allowed_hosts);
  Renderer renderer(reader, job, options.renderer);
  Listener listener(options.network, access, renderer, [&renderer] { renderer.end("The server was ended."); });
  events.listening(fmt::format("{}://{}:{}/?token={}", options.network.certificate.empty() ? "http" : "https",
                               web_host(options.network.address), listener.port(), access.token()));
  try {
    renderer.run();
  } catch (...) {
    renderer.end(reader.worded(error_of(std::current_exception()).what()));
    listener.finish();
    throw;
  }
  listener.finish();
  if (renderer.is_reading()) events.ended_while_reading();
}

}  // namespace tessera::server
