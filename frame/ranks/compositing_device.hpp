// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "compositor/gl/gl_compositor.hpp"
#include "exchange/transport.hpp"

namespace tessera::frame {

struct DistributedSettings;

/// This rank's device, if it has one, and a description of the devices of all compositors: "cpu", "gl-compute (EGL,
/// ...)", "cpu (EGL: no hardware device answers)"; if there are several kinds, they are joined by " + ".
struct CompositingDevice {
  std::unique_ptr<compositor::GlCompositor> device;
  bool everywhere = false;                   ///< whether every compositor has a device
  bool may_fail = false;                     ///< whether the CPU replaces a device that fails (Backend::automatic)
  mutable std::atomic<bool> failed = false;  ///< whether the device has failed
  std::string name;
};

/// Opens this rank's device and stores it in `made`. Collective. Throws Error(bad_input) unless the settings have one
/// backend, or one per compositor. Throws Error(system_failure) if a device that was requested by name cannot be
/// opened.
void open_compositing_device(const DistributedSettings& settings, exchange::Transport& transport,
                             CompositingDevice& made);

}  // namespace tessera::frame
