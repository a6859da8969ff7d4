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

/// Whether these bytes are the beginning of a gzip file.
inline bool looks_like_gzip(std::string_view beginning) { return beginning.starts_with("\x1f\x8b"); }

/// Returns the first `count` bytes of the content of a gzip or zlib stream, or fewer if the content ends earlier.
std::vector<std::byte> inflate_beginning(std::span<const std::byte> stream, std::size_t count);

/// A range of the content of a stream that begins at byte `begin` of a file.
struct InflatedRange {
  std::uint64_t begin = 0, first = 0, count = 0;
};

/// Passes the bytes of the range to `use` in parts, with at most a few hundred KiB in memory. Throws Error(bad_input),
/// whose message begins with `source`, if the stream is damaged or ends before the end of the range. Throws it before
/// reading if the compressed bytes are too few to contain the range (deflate's best ratio is 1032 to 1). Also throws
/// the exceptions of `use`.
void inflate_parts(const std::filesystem::path& file, const InflatedRange& range, const std::string& source,
                   const std::function<void(std::span<const std::byte>)>& use);

/// Inflates `packed`, a single zlib stream, so that its content fills `out` exactly. Returns false if the stream is
/// damaged or its content has another size.
bool inflate_block(std::span<const std::byte> packed, std::span<std::byte> out);

/// Largest number of bytes to inflate from a stream.
struct InflateLimit {
  std::uint64_t bytes;
  bool stops;  ///< true: bytes after the limit are ignored; false: they are an error
};

/// Inflates a gzip or zlib file into an open file. Returns the number of bytes. Throws Error(bad_input), whose message
/// begins with `source`, if the stream is damaged, ends early or exceeds the limit, and Error(system_failure) if the
/// content exceeds `memory` bytes or writing fails.
std::uint64_t inflate_to(int file, const PositionalFile& packed, const InflateLimit& limit, std::uint64_t memory,
                         const std::string& source);

}  // namespace tessera::system
