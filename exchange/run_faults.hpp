// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/message.hpp"
#include "scene/error.hpp"

/// Errors of a run as MpiTransport passes them on.
namespace tessera::exchange {

/// A message of kind `fault` or `verdict`, and the error in one.
Bytes error_message(MessageKind kind, const scene::Error& error);
scene::Error take_error(MessageReader& reader);

/// Identifies this process to users: machine and process number.
std::string process_name();

}  // namespace tessera::exchange
