// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::readers {

/// The remedy for a file whose bytes are not as its format has them.
inline constexpr const char* write_anew = "the file is truncated or damaged, write it again";

/// What VTK says of an error or warning, in one line for users: without the place in its sources, the addresses of its
/// objects and what it prints of their state. Empty if nothing is left.
std::string words_for_users(std::string_view said);

/// The error that a reader's words are for a file. A file that they name and that is not there is called missing; only
/// words that tell of bytes which are not as the format has them, or end early, are followed by `remedy`, which may
/// call the file damaged.
scene::Error error_of_vtk(const std::string& source, const std::string& words, const std::string& remedy);

}  // namespace tessera::readers
