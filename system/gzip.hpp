// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::system {

class PositionalFile;

/// Whether bytes begin as a gzip file does.
inline bool looks_like_gzip(std::string_view beginning) { return beginning.starts_with("\x1f\x8b"); }

/// The first `count` bytes that a gzip or zlib stream holds, fewer if it ends before.
std::vector<std::byte> inflate_beginning(std::span<const std::byte> stream, std::size_t count);

/// Bytes of what a stream that begins at byte `begin` of a file holds.
struct InflatedRange {
  std::uint64_t begin = 0, first = 0, count = 0;
};

/// Gives `use` those bytes in parts, with no more than a few hundred KiB in memory. Throws Error(bad_input, "SOURCE:
/// ...") if the stream is damaged or ends before the range does, and before any of it is read if so few bytes could not
/// hold it (deflate's best is 1032 to 1); and what `use` throws.
void inflate_parts(const std::filesystem::path& file, const InflatedRange& range, const std::string& source,
                   const std::function<void(std::span<const std::byte>)>& use);

/// The one zlib stream that `packed` is, into all of `out`. false: it is damaged or holds more or fewer bytes.
bool inflate_block(std::span<const std::byte> packed, std::span<std::byte> out);

/// How many bytes to take out of a stream.
struct InflateLimit {
  std::uint64_t bytes;
  bool stops;  ///< what follows them is left aside; else it is refused
};

/// Writes what a file that is a gzip or zlib stream holds into an open file; the number of bytes. Throws
/// Error(bad_input, "SOURCE: ...") if the stream is damaged, ends early or holds more than the limit, and
/// Error(system_failure) for more than `memory` bytes, or if the file takes no more.
std::uint64_t inflate_to(int file, const PositionalFile& packed, const InflateLimit& limit, std::uint64_t memory,
                         const std::string& source);

}  // namespace tessera::system
