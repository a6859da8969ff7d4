// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tessera/optical_model.hpp"
#include "tessera/settings.hpp"

/// Methods and exchanges as the command line and reports name them.
namespace tessera {
inline namespace v0_1 {

/// `auto`, `exact`, ...: as in --integrator, without the part after a colon. `runs`: as in --exchange.
const char* method_word(IntegratorKind kind);
const char* exchange_word(Exchange exchange);
/// `sampled:8`, `auto to 0.0001`, ...: for meshes.
std::string method_line(const Integrator& integrator);

/// For grids: whether the method samples rays at its own step length.
bool takes_steps(const Integrator& integrator);

}  // namespace v0_1
}  // namespace tessera
