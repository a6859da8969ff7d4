// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/scene_reader.hpp"

namespace tessera::server {

/// A binary message but for the image's bytes, which follow: the header's length, 32 bits, little endian, and the
/// header.
std::string frame_head(const Json& header);

/// JSON as text; what is not UTF-8, as file names may hold, is replaced.
std::string text_of(const Json& json);

/// `bytes` as they stand.
std::string string_of(const std::vector<std::byte>& bytes);

}  // namespace tessera::server
