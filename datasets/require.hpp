// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/error.hpp"

namespace tessera::datasets {

/// Throws Error(bad_input, "GENERATOR: RULE") unless the generator's argument satisfies the rule.
inline void require(bool holds, const char* generator, const char* rule) {
  if (!holds) throw scene::bad_input(std::string(generator) + ": " + rule);
}

}  // namespace tessera::datasets
