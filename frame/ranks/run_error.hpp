// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>

#include "exchange/transport.hpp"

namespace tessera::frame {

/// Describes an exception that ended this rank's part to the user. Returns the exception itself if it is a
/// scene::Error.
scene::Error run_error(const exchange::Transport& transport, const std::exception& fault);

}  // namespace tessera::frame
