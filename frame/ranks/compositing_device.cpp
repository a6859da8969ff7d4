// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/compositing_device.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "exchange/collectives.hpp"
#include "frame/ranks/distributed.hpp"
#include "scene/error.hpp"

namespace tessera::frame {
namespace {

/// Returns every rank's text, in rank order.
std::vector<std::string> gather_texts(exchange::Transport& transport, exchange::MessageKind kind,
                                      std::string_view text) {
  exchange::Bytes mine = exchange::begin_message(kind);
  exchange::append_text(mine, text);
  std::vector<std::string> texts;
  for (const exchange::Bytes& message : exchange::gather_all(transport, std::move(mine)))
    texts.push_back(exchange::MessageReader(message, static_cast<int>(texts.size()), kind).take_text());
  return texts;
}

/// Returns the number of lower ranks on this machine. Collective.
int local_rank(exchange::Transport& transport) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string mine = host.data();
  const auto hosts = gather_texts(transport, exchange::MessageKind::host, mine);
  return static_cast<int>(
      std::count_if(hosts.begin(), hosts.begin() + transport.rank(), [&](const auto& h) { return h == mine; }));
}

/// Returns the description of the problem without the advice, which has already been followed.
std::string reason(const scene::Error& error) {
  const std::string words = error.what();
  return words.substr(0, words.find(';'));
}

}  // namespace

void open_compositing_device(const DistributedSettings& settings, exchange::Transport& transport,
                             CompositingDevice& made) {
  const DeviceSettings& device = settings.render.mesh.device;
  const std::vector<Backend>& backends = device.backends;
  const Roles& roles = settings.roles;
  if (std::all_of(backends.begin(), backends.end(), [](Backend b) { return b == Backend::cpu; })) {
    made.name = "cpu";
    return;
  }
  if (backends.size() != 1 && backends.size() != roles.compositors.size())
    throw scene::bad_input(
        fmt::format("`backend`: there are {} words for {} compositors; give one word, or one for each compositor",
                    backends.size(), roles.compositors.size()));
  compositor::GlSettings gl = settings.gl;
  gl.method = device.method, gl.half = device.half;
  gl.egl_device.number = device.egl_device;
  if (device.by_local_rank) gl.egl_device.local_rank = local_rank(transport);
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
            backend == Backend::osmesa ? gl::Platform::osmesa : gl::Platform::egl, gl, settings.compositing);
        name = made.device->name();
      } catch (const scene::Error& error) {
        if (backend != Backend::automatic || error.code() != scene::ErrorCode::system_failure) throw;
        name = fmt::format("cpu ({})", reason(error));
      }
  }
  std::vector<std::string> names;
  for (std::string& other : gather_texts(transport, exchange::MessageKind::device, name))
    if (!other.empty() && std::find(names.begin(), names.end(), other) == names.end())
      names.push_back(std::move(other));
  made.everywhere = std::none_of(names.begin(), names.end(), [](const auto& n) { return n.starts_with("cpu"); });
  made.name = fmt::format("{}", fmt::join(names, " + "));
}

}  // namespace tessera::frame
