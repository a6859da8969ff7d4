// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "compositor/gl/gl_compositor.hpp"
#include "exchange/transport.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/roles.hpp"

namespace tessera::frame {

using tessera::Backend;

/// How all compositors of a job work.
struct CompositingSettings {
  std::vector<Backend> backends;  ///< one a compositor, or one for all; none: the CPU
  compositor::GlSettings gl;      ///< of those on a device
  bool software_will_do = false;  ///< tests: automatic takes a software device
};

/// This rank's device, if it has one, and what all compositors work on, in words: "cpu", "gl-compute (EGL, ...)",
/// "cpu (EGL: no hardware device answers)"; several kinds are joined by " + ".
struct CompositingDevice {
  std::unique_ptr<compositor::GlCompositor> device;
  bool everywhere = false;                   ///< every compositor has one
  bool may_fail = false;                     ///< the CPU takes over then (Backend::automatic)
  mutable std::atomic<bool> failed = false;  ///< it did
  std::string name;
};

/// Throws Error(bad_input) if devices are to rasterize and it is known that some compositor has none that can.
void check_device_rasterizer(const RenderSettings& render, const CompositingSettings& settings);

/// Opens this rank's device into `made`. Collective. Throws Error(bad_input) if there is neither one backend nor one
/// for each compositor, Error(system_failure) if a device that was asked for by name cannot be opened.
void open_compositing_device(const CompositingSettings& settings, const Roles& roles, exchange::Transport& transport,
                             scene::Trace* trace, CompositingDevice& made);

}  // namespace tessera::frame
