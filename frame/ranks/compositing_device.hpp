// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "compositor/gl/gl_compositor.hpp"
#include "exchange/transport.hpp"

namespace tessera::frame {

struct DistributedSettings;

/// This rank's device, if it has one, and a description of what all compositors use: "cpu", "gl-compute (EGL, ...)",
/// "cpu (EGL: no hardware device answers)"; several kinds are joined by " + ".
struct CompositingDevice {
  std::unique_ptr<compositor::GlCompositor> device;
  bool everywhere = false;                   ///< every compositor has one
  bool may_fail = false;                     ///< if so, the CPU replaces it (Backend::automatic)
  mutable std::atomic<bool> failed = false;  ///< the device has failed
  std::string name;
};

/// Opens this rank's device into `made`. Collective. Throws Error(bad_input) if there is neither one backend nor one
/// per compositor, Error(system_failure) if a device that was requested by name cannot be opened.
void open_compositing_device(const DistributedSettings& settings, exchange::Transport& transport,
                             CompositingDevice& made);

}  // namespace tessera::frame
