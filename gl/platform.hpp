// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

/// What a caller says of a device; needs no OpenGL headers.
namespace tessera::gl {

/// Where a context comes from. Both libraries are opened at run time; neither needs a display server.
enum class Platform {
  osmesa,  ///< Mesa in software, in this process
  egl      ///< a device without a surface: a GPU, or Mesa's software device
};

/// Which of EGL's devices. Numbers are EGL's own order.
struct EglDevice {
  std::optional<int> number;      ///< this one
  std::optional<int> local_rank;  ///< else: hardware devices in turn by this (software ones if there are none)
  bool hardware_only = false;     ///< a software device is no answer
  // None of it: the first hardware device, else the first.
};

}  // namespace tessera::gl
