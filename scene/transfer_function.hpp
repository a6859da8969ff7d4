// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/transfer_function.hpp"

namespace tessera::scene {

using tessera::Knot;
using tessera::TransferFunction;

}  // namespace tessera::scene
