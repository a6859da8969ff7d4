// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/optical_model.hpp"

namespace tessera::scene {

using tessera::Emission;
using tessera::Integrator;
using tessera::IntegratorKind;

}  // namespace tessera::scene
