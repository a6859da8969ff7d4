#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tessera::io {

/// The first `count` bytes that a gzip or zlib stream holds, fewer if it ends before.
std::vector<std::byte> inflate_beginning(std::span<const std::byte> stream, std::size_t count);

/// Exactly `count` bytes. Throws Error(bad_input, "SOURCE: ...") if the stream is damaged or ends before, and before
/// asking for memory if so few bytes could not hold them (deflate's best is 1032 to 1).
std::vector<std::byte> inflate(std::span<const std::byte> stream, std::uint64_t count, const std::string& source);

}  // namespace tessera::io
