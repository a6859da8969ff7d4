// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

/// How a caller selects a device; needs no OpenGL headers.
namespace tessera::gl {

/// The source of a context. Both libraries are opened at run time; neither needs a display server.
enum class Platform {
  osmesa,  ///< Mesa in software, in this process
  egl      ///< a device without a surface: a GPU, or Mesa's software device
};

/// Selects one of EGL's devices. Numbers are EGL's own order.
struct EglDevice {
  std::optional<int> number;      ///< this device
  std::optional<int> local_rank;  ///< else: hardware devices round-robin by this rank (software ones if there are none)
  bool hardware_only = false;     ///< refuse software devices
  // If none is set: the first hardware device, else the first device.
};

}  // namespace tessera::gl
