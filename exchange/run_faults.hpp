// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/message.hpp"
#include "scene/error.hpp"

/// Errors of a run as MpiTransport passes them on.
namespace tessera::exchange {

/// A message of kind `fault` or `verdict`, and what it says.
Bytes error_message(MessageKind kind, const scene::Error& error);
scene::Error take_error(MessageReader& reader);

/// This process for people: machine and number.
std::string process_name();

}  // namespace tessera::exchange
