// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "gl/context.hpp"
#include "scene/error.hpp"

namespace tessera::tests {

/// A context of Mesa in software, or null if the library is not installed.
inline std::unique_ptr<gl::Context> osmesa_or_none() {
  try {
    return gl::open_context(gl::Platform::osmesa);
  } catch (const scene::Error&) {
    return nullptr;
  }
}

}  // namespace tessera::tests

/// Defines `context`, or skips the test.
#define TESSERA_OSMESA_OR_SKIP(context)                                      \
  const auto context##_owner = tessera::tests::osmesa_or_none();             \
  if (context##_owner == nullptr) GTEST_SKIP() << "OSMesa cannot be opened"; \
  tessera::gl::Context& context = *context##_owner
