// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tessera/optical_model.hpp"
#include "tessera/settings.hpp"

/// Methods and exchanges as the command line and reports name them.
namespace tessera {
inline namespace v0_1 {

/// `auto`, `exact`, ...: as --integrator has it, less what stands behind a colon. `runs`: as --exchange.
const char* method_word(IntegratorKind kind);
const char* exchange_word(Exchange exchange);
/// `sampled:8`, `auto to 0.0001`, ...: of meshes.
std::string method_line(const Integrator& integrator);

/// Of grids: by steps of a length of their own.
bool takes_steps(const Integrator& integrator);

}  // namespace v0_1
}  // namespace tessera
