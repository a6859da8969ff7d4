// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

/// The selection of a device by a caller; does not need OpenGL headers.
namespace tessera::gl {

/// How a context is created. The library of either platform is opened at run time; neither platform needs a display
/// server.
enum class Platform {
  osmesa,  ///< Mesa in software, in this process
  egl      ///< a device without a surface: a GPU, or Mesa's software device
};

/// Selects one of EGL's devices. Devices are numbered in EGL's own order.
struct EglDevice {
  std::optional<int> number;      ///< this device
  std::optional<int> local_rank;  ///< used if `number` is not set: round-robin over hardware devices (over software
                                  ///< devices if there are none)
  bool hardware_only = false;     ///< refuse software devices
  // If no member is set, the first hardware device is used, or, without hardware devices, the first device.
};

}  // namespace tessera::gl
