// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/scene_reader.hpp"

namespace tessera::server {

/// The beginning of a binary message, without the image's bytes that follow: the length of the header, as 32 bits in
/// little endian, and the header.
std::string frame_head(const Json& header);

/// JSON as text; invalid UTF-8, which file names may contain, is replaced.
std::string text_of(const Json& json);

/// `bytes` as a string.
std::string string_of(const std::vector<std::byte>& bytes);

}  // namespace tessera::server
