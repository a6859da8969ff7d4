#pragma once

#include <chrono>
#include <string>

#include "exchange/message.hpp"
#include "scene/error.hpp"

/// Errors of a run as MpiTransport passes them on.
namespace tessera::exchange {

/// A message of kind `fault` or `verdict`, and what it says.
Bytes error_message(MessageKind kind, const scene::Error& error);
scene::Error take_error(MessageReader& reader);

/// A rank has not come to MPI's start or end, whichever `what` is, in this time.
scene::Error missing_rank(const char* what, std::chrono::milliseconds time, const char* remedy);

/// This process for people: machine and number.
std::string process_name();

}  // namespace tessera::exchange
