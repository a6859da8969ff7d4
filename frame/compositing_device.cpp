#include "frame/compositing_device.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "scene/error.hpp"

namespace tessera::frame {
namespace {

exchange::Bytes bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

std::string text_of(const exchange::Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// How many ranks of lower number are on this machine. Collective.
int local_rank(exchange::Transport& transport) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string mine = host.data();
  const auto hosts = exchange::gather_all(transport, bytes_of(mine));
  return static_cast<int>(std::count_if(hosts.begin(), hosts.begin() + transport.rank(),
                                        [&](const auto& h) { return text_of(h) == mine; }));
}

/// What went wrong, without the advice: that was taken.
std::string reason(const scene::Error& error) {
  const std::string words = error.what();
  return words.substr(0, words.find(';'));
}

}  // namespace

void open_compositing_device(const CompositingSettings& settings, const Roles& roles, exchange::Transport& transport,
                             scene::Trace* trace, CompositingDevice& made) {
  const std::vector<Backend>& backends = settings.backends;
  if (std::all_of(backends.begin(), backends.end(), [](Backend b) { return b == Backend::cpu; })) {
    made.name = "cpu";
    return;
  }
  if (backends.size() != 1 && backends.size() != roles.compositors.size())
    throw scene::bad_input(fmt::format("`backend`: {} words for {} compositors; give one, or one for each",
                                       backends.size(), roles.compositors.size()));
  compositor::GlSettings gl = settings.gl;
  if (gl.by_local_rank) gl.egl_device.local_rank = local_rank(transport);
  std::string name;
  const auto self = std::find(roles.compositors.begin(), roles.compositors.end(), transport.rank());
  if (self != roles.compositors.end()) {
    const auto place = static_cast<std::size_t>(self - roles.compositors.begin());
    const Backend backend = backends[backends.size() == 1 ? 0 : place];
    name = "cpu";
    made.may_fail = backend == Backend::automatic;
    gl.egl_device.hardware_only = backend == Backend::automatic && !settings.software_will_do;
    if (backend != Backend::cpu) try {
        made.device = std::make_unique<compositor::GlCompositor>(
            backend == Backend::osmesa ? gl::Platform::osmesa : gl::Platform::egl, gl, trace);
        name = made.device->name();
      } catch (const scene::Error& error) {
        if (backend != Backend::automatic || error.code() != scene::ErrorCode::system_failure) throw;
        name = fmt::format("cpu ({})", reason(error));
      }
  }
  std::vector<std::string> names;
  for (const exchange::Bytes& other : exchange::gather_all(transport, bytes_of(name)))
    if (std::string text = text_of(other); !text.empty() && std::find(names.begin(), names.end(), text) == names.end())
      names.push_back(std::move(text));
  made.name = fmt::format("{}", fmt::join(names, " + "));
}

}  // namespace tessera::frame
