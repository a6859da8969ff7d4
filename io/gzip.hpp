#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::io {

/// Whether bytes begin as a gzip file does.
inline bool looks_like_gzip(std::string_view beginning) { return beginning.starts_with("\x1f\x8b"); }

/// The first `count` bytes that a gzip or zlib stream holds, fewer if it ends before.
std::vector<std::byte> inflate_beginning(std::span<const std::byte> stream, std::size_t count);

/// Exactly `count` bytes. Throws Error(bad_input, "SOURCE: ...") if the stream is damaged or ends before, and before
/// asking for memory if so few bytes could not hold them (deflate's best is 1032 to 1).
std::vector<std::byte> inflate(std::span<const std::byte> stream, std::uint64_t count, const std::string& source);

/// Bytes of what a stream that begins at byte `begin` of a file holds.
struct InflatedRange {
  std::uint64_t begin = 0, first = 0, count = 0;
};

/// Gives `use` those bytes in parts, with no more than a few hundred KiB in memory. Throws as inflate() does of all
/// bytes up to the range's end, and what `use` throws.
void inflate_parts(const std::filesystem::path& file, const InflatedRange& range, const std::string& source,
                   const std::function<void(std::span<const std::byte>)>& use);

/// The one zlib stream that `packed` is, into all of `out`. false: it is damaged or holds more or fewer bytes.
bool inflate_block(std::span<const std::byte> packed, std::span<std::byte> out);

/// Writes all that a gzip or zlib stream holds into an open file; the number of bytes. Throws Error(bad_input,
/// "SOURCE: ...") if the stream is damaged or ends early, and Error(system_failure) if it holds more than `most` bytes
/// or the file takes no more.
std::uint64_t inflate_to(int file, std::span<const std::byte> stream, std::uint64_t most, const std::string& source);

}  // namespace tessera::io
