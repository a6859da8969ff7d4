// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::readers {

/// The remedy for a file whose bytes do not follow its format.
inline constexpr const char* write_again = "the file is truncated or damaged, write it again";

/// Returns a VTK error or warning as one line for users: without the source location, object addresses and state dumps.
/// Empty if nothing remains.
std::string words_for_users(std::string_view reported);

/// Returns the error for a file, given a reader's message. If the message names a missing file, that file is reported
/// as missing. `remedy`, which may state that the file is damaged, is added only if the message reports bytes that do
/// not follow the format, or that end early.
scene::Error error_of_vtk(const std::string& source, const std::string& words, const std::string& remedy);

}  // namespace tessera::readers
