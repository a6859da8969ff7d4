// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/message.hpp"
#include "scene/error.hpp"

/// Errors of a run in the form in which MpiTransport passes them between ranks.
namespace tessera::exchange {

/// error_message() makes a message of kind `fault` or `verdict` from an error; take_error() reads the error from such a
/// message.
Bytes error_message(MessageKind kind, const scene::Error& error);
scene::Error take_error(MessageReader& reader);

/// Returns a text that identifies this process to users: machine and process number.
std::string process_name();

}  // namespace tessera::exchange
