// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tessera/optical_model.hpp"
#include "tessera/settings.hpp"

/// Names of methods and exchanges, as in the command line and in reports.
namespace tessera {
inline namespace v0_1 {

/// method_word() returns the word of --integrator without the part after a colon, like `auto` or `exact`.
/// exchange_word() returns the word of --exchange, like `runs`.
const char* method_word(IntegratorKind kind);
const char* exchange_word(Exchange exchange);
/// Describes an integrator for meshes: `sampled:8`, `auto to 0.0001`, ...
std::string method_line(const Integrator& integrator);

/// For grids: whether the integrator samples rays at steps of equal length.
bool takes_steps(const Integrator& integrator);

}  // namespace v0_1
}  // namespace tessera
