// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_array.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <optional>

#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t largest_streamed_block = 16 << 20;

}  // namespace

VtkArrayBytes::VtkArrayBytes(const system::PositionalFile& file, const VtkArrayPlace& place)
    : place_(place), packed_(file, place.base64, place.first_byte, place.end) {}

std::optional<VtkArrayBytes> VtkArrayBytes::open(const system::PositionalFile& file, const VtkArrayPlace& place) {
  VtkArrayBytes array(file, place);
  if (place.codec != VtkCodec::none)
    return array.read_table(file.size()) ? std::optional(std::move(array)) : std::nullopt;
  if (!array.read_number(array.size_) || array.size_ > array.packed_.left()) return std::nullopt;
  array.packed_size_ = array.size_;
  return array;
}

bool VtkArrayBytes::read_number(std::uint64_t& number) {
  std::array<std::byte, 8> raw{};
  if (!packed_.read(raw.data(), place_.number_bytes)) return false;
  number = place_.number_bytes == 4 ? scene::load<std::uint32_t>(raw.data(), place_.swapped)
                                    : scene::load<std::uint64_t>(raw.data(), place_.swapped);
  return true;
}

std::uint64_t VtkArrayBytes::size_of_block(std::size_t block) const {
  return block + 1 < packed_blocks_.size() ? block_size_ : last_size_;
}

/// Reads the table of blocks of a compressed array. Returns false unless the table fits the file.
bool VtkArrayBytes::read_table(std::uint64_t file_bytes) {
  std::uint64_t blocks = 0;
  if (!read_number(blocks)) return false;
  if (blocks == 0) return true;
  if (!read_number(block_size_) || !read_number(last_size_) || blocks > file_bytes / place_.number_bytes) return false;
  if (last_size_ == 0) last_size_ = block_size_;
  if (block_size_ == 0 || last_size_ > block_size_ || __builtin_mul_overflow(blocks - 1, block_size_, &size_) ||
      __builtin_add_overflow(size_, last_size_, &size_))
    return false;
  packed_blocks_.resize(blocks);
  for (std::size_t k = 0; k < blocks; ++k) {
    std::uint64_t& packed = packed_blocks_[k];
    if (!read_number(packed) || packed > file_bytes || !can_unpack_to(place_.codec, packed, size_of_block(k)))
      return false;
    packed_size_ += packed;
  }
  return packed_size_ <= packed_.left();
}

/// Unpacks the next blocks in parallel into memory of exactly their size.
bool VtkArrayBytes::unpack(std::size_t blocks, std::byte* to) {
  std::vector<std::uint64_t> from(blocks + 1, 0);
  for (std::size_t k = 0; k < blocks; ++k) from[k + 1] = from[k] + packed_blocks_[next_ + k];
  const auto packed = std::make_unique_for_overwrite<std::byte[]>(from[blocks]);
  if (!packed_.read(packed.get(), from[blocks])) return false;
  std::atomic<bool> whole = true;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t k) {
    if (!unpack_block(place_.codec, {packed.get() + from[k], packed_blocks_[next_ + k]},
                      {to + k * block_size_, size_of_block(next_ + k)}))
      whole = false;
  });
  next_ += blocks;
  return whole;
}

bool VtkArrayBytes::read(std::byte* to, std::uint64_t count) {
  if (place_.codec == VtkCodec::none) return packed_.read(to, count);
  while (count > 0) {
    if (block_at_ < block_.size()) {
      const std::size_t part = std::min<std::uint64_t>(block_.size() - block_at_, count);
      std::memcpy(to, block_.data() + block_at_, part);
      block_at_ += part, to += part, count -= part;
      continue;
    }
    const std::size_t left = packed_blocks_.size() - next_;
    if (left == 0) return false;
    if (const std::size_t whole = std::min<std::uint64_t>(left, count / block_size_); whole > 0) {
      const std::uint64_t bytes = (whole - 1) * block_size_ + size_of_block(next_ + whole - 1);
      if (!unpack(whole, to)) return false;
      to += bytes, count -= bytes;
      continue;
    }
    block_.resize(size_of_block(next_));
    block_at_ = 0;
    if (!unpack(1, block_.data())) return false;
  }
  return true;
}

namespace {

/// Passes `count` bytes to a sink, counting them in `made`. Returns false if the bytes end early or are damaged.
bool pass_on(const system::PositionalFile& file, const VtkArrayPlace& place, std::uint64_t count, std::uint64_t& made,
             const system::ByteSink& use) {
  auto array = VtkArrayBytes::open(file, place);
  if (!array || array->size() != count || array->block_size() > largest_streamed_block) return false;
  std::vector<std::byte> part(std::min<std::uint64_t>(std::max<std::uint64_t>(array->block_size(), 1 << 20), count));
  for (; made < count; made += part.size()) {
    part.resize(std::min<std::uint64_t>(part.size(), count - made));
    if (!array->read(part.data(), part.size())) return false;
    use(part);
  }
  return true;
}

}  // namespace

std::optional<std::uint64_t> end_of_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                              std::uint64_t count) {
  const auto array = VtkArrayBytes::open(file, place);
  if (!array || array->size() != count || array->block_size() > largest_streamed_block) return std::nullopt;
  const std::uint64_t text = place.base64 ? array->packed_size() / 3 * 4 : array->packed_size();
  if (text > file.size() - array->position()) return std::nullopt;
  return array->position() + text;
}

std::optional<std::vector<std::byte>> small_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                                      std::uint64_t count) {
  std::vector<std::byte> all;
  std::uint64_t made = 0;
  const auto keep = [&](std::span<const std::byte> part) { all.insert(all.end(), part.begin(), part.end()); };
  if (!pass_on(file, place, count, made, keep)) return std::nullopt;
  return all;
}

void read_vtk_array(const std::filesystem::path& path, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const system::ByteSink& use) {
  std::uint64_t made = 0;
  if (!pass_on(system::PositionalFile(path, source), place, count, made, use))
    throw scene::bad_input(
        fmt::format("{}: its samples end or break after {} of {} bytes; the file is truncated or damaged, write it "
                    "again",
                    source, made, count));
}

}  // namespace tessera::io
