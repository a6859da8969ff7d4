// SPDX-License-Identifier: BSD-3-Clause
#include "system/gzip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

#include "scene/error.hpp"
#include "system/descriptor.hpp"
#include "system/positional_file.hpp"

namespace tessera::system {
namespace {

constexpr int either_header = 15 + 32;  // makes zlib detect whether the header is that of gzip or of zlib

struct InflateState {
  z_stream z{};
  InflateState() {
    if (inflateInit2(&z, either_header) != Z_OK) throw std::bad_alloc();
  }
  ~InflateState() { inflateEnd(&z); }
  InflateState(const InflateState&) = delete;
  InflateState& operator=(const InflateState&) = delete;
};

void require_possible(std::uint64_t packed, std::uint64_t count, const std::string& source) {
  constexpr std::uint64_t best = 1040;  // deflate's best ratio of 1032, with a margin for headers
  if (count / best > packed)
    throw scene::bad_input(
        fmt::format("{}: its header states {} bytes, which {} compressed bytes cannot contain; the file is truncated "
                    "or damaged, write it again",
                    source, count, packed));
}

scene::Error ends_early(std::uint64_t made, std::uint64_t count, const std::string& source) {
  return scene::bad_input(
      fmt::format("{}: its compressed samples end or break after {} of {} bytes; the file is truncated or damaged, "
                  "write it again",
                  source, made, count));
}

/// Inflates the stream into `out` until either ends. Returns the number of bytes written. Supports consecutive gzip
/// members.
std::size_t inflate_into(std::span<const std::byte> stream, std::span<std::byte> out) {
  constexpr std::size_t most = std::numeric_limits<uInt>::max();
  InflateState state;
  z_stream& z = state.z;
  std::size_t in_at = 0, out_at = 0;
  while (out_at < out.size() && in_at < stream.size()) {
    const auto in_now = static_cast<uInt>(std::min(most, stream.size() - in_at));
    const auto out_now = static_cast<uInt>(std::min(most, out.size() - out_at));
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data() + in_at));
    z.avail_in = in_now;
    z.next_out = reinterpret_cast<Bytef*>(out.data() + out_at);
    z.avail_out = out_now;
    const int result = ::inflate(&z, Z_NO_FLUSH);
    in_at += in_now - z.avail_in;
    out_at += out_now - z.avail_out;
    if (result == Z_STREAM_END) {
      if (inflateReset(&z) != Z_OK) break;
      continue;
    }
    if (result != Z_OK) break;
  }
  return out_at;
}

}  // namespace

std::vector<std::byte> inflate_beginning(std::span<const std::byte> stream, std::size_t count) {
  std::vector<std::byte> out(count);
  out.resize(inflate_into(stream, out));
  return out;
}

void inflate_parts(const std::filesystem::path& file, const InflatedRange& range, const std::string& source,
                   const std::function<void(std::span<const std::byte>)>& use) {
  const PositionalFile in(file, source);
  const std::uint64_t size = in.size(), end = range.first + range.count;
  std::uint64_t at = std::min(range.begin, size), made = 0;
  require_possible(size - at, end, source);
  InflateState state;
  z_stream& z = state.z;
  std::vector<std::byte> packed(128 << 10), out(256 << 10);
  while (made < end) {
    if (z.avail_in == 0 && at < size) {
      const std::uint64_t now = std::min<std::uint64_t>(packed.size(), size - at);
      in.read(at, packed.data(), now);
      at += now;
      z.next_in = reinterpret_cast<Bytef*>(packed.data());
      z.avail_in = static_cast<uInt>(now);
    }
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(std::min<std::uint64_t>(out.size(), end - made));
    const uInt room = z.avail_out;
    const int result = ::inflate(&z, Z_NO_FLUSH);
    const std::uint64_t before = made;
    made += room - z.avail_out;
    if (made > range.first) {
      const std::uint64_t skipped = range.first > before ? range.first - before : 0;
      use(std::span<const std::byte>(out).subspan(skipped, made - before - skipped));
    }
    const bool ended = result == Z_STREAM_END;
    if (ended && inflateReset(&z) != Z_OK) break;
    // Inflating ends after the last member or after an error. Z_BUF_ERROR means that no progress was possible.
    if ((!ended && result != Z_OK) || (ended && z.avail_in == 0 && at == size)) break;
  }
  if (made < end) throw ends_early(made, end, source);
}

bool inflate_block(std::span<const std::byte> packed, std::span<std::byte> out) {
  uLongf size = out.size();
  return ::uncompress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                      packed.size()) == Z_OK &&
         size == out.size();
}

std::uint64_t inflate_to(int file, const PositionalFile& packed, const InflateLimit& limit, std::uint64_t memory,
                         const std::string& source) {
  const std::uint64_t size = packed.size();
  const auto fail = [&](scene::ErrorCode code, const std::string& what, const char* remedy) {
    return scene::Error(code, source, what, remedy);
  };
  InflateState state;
  z_stream& z = state.z;
  std::vector<std::byte> in(256 << 10), out(1 << 20);
  std::uint64_t written = 0, at = 0;
  for (bool ended = false;;) {
    if (z.avail_in == 0) {
      const std::uint64_t now = std::min<std::uint64_t>(in.size(), size - at);
      packed.read(at, in.data(), now);
      at += now;
      z.next_in = reinterpret_cast<Bytef*>(in.data());
      z.avail_in = static_cast<uInt>(now);
    }
    // Several members may follow each other. Bytes after the last member are padding, as in the program gzip.
    if (ended && (z.avail_in == 0 || *z.next_in != 0x1f)) return written;
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    const int result = ::inflate(&z, Z_NO_FLUSH);
    const std::size_t made = out.size() - z.avail_out;
    const bool is_over = made > limit.bytes - written;
    if (is_over && !limit.stops)
      throw fail(scene::ErrorCode::bad_input,
                 fmt::format("its {} bytes contain more than {} MiB, which is implausible", size, limit.bytes >> 20),
                 "if that is correct, unpack it with gunzip");
    const auto kept = static_cast<std::size_t>(std::min<std::uint64_t>(made, limit.bytes - written));
    written += kept;
    if (written > memory)
      throw fail(scene::ErrorCode::system_failure, fmt::format("it contains more than {} bytes when unpacked", memory),
                 "unpack it to a disk, use a larger machine or a part of the data");
    if (!write_all(file, out.data(), kept))
      throw fail(scene::ErrorCode::system_failure, "memory ran out", "use a larger machine or a part of the data");
    if (is_over) return written;
    ended = result == Z_STREAM_END;
    if (!ended && result != Z_OK)  // Z_BUF_ERROR if the stream ends
      throw fail(scene::ErrorCode::bad_input,
                 fmt::format("its compressed bytes end or break after {} unpacked ones", written),
                 "the file is truncated or damaged, write it again");
    if (ended && inflateReset(&z) != Z_OK) return written;
  }
}

}  // namespace tessera::system
