// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::readers {

/// The remedy for a file whose bytes are not as its format has them.
inline constexpr const char* write_again = "the file is truncated or damaged, write it again";

/// A VTK error or warning as one line for users: without its source location, object addresses and state dumps. Empty
/// if nothing remains.
std::string words_for_users(std::string_view reported);

/// The error for a file, made of a reader's message. A missing file named by the message is reported as missing;
/// `remedy`, which may call the file damaged, is added only if the message reports bytes that do not follow the format,
/// or end early.
scene::Error error_of_vtk(const std::string& source, const std::string& words, const std::string& remedy);

}  // namespace tessera::readers
