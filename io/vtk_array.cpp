#include "io/vtk_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "io/gzip.hpp"
#include "io/positional_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t largest_block = 16 << 20;

/// Bytes of an array one after the other, out of its text if it is one.
class ArrayBytes {
 public:
  ArrayBytes(const PositionalFile& file, const VtkArrayPlace& place)
      : file_(file), base64_(place.base64), at_(place.first_byte), end_(file.size()) {}

  /// false: the file ends before, or what stands there is not base64.
  [[nodiscard]] bool read(std::byte* to, std::uint64_t count) {
    if (base64_) {
      for (; count > 0; --count, ++to) {
        if (next_ == three_.size() && !decode()) return false;
        *to = three_[next_++];
      }
      return true;
    }
    if (at_ > end_ || count > end_ - at_) return false;
    file_.read(at_, to, count);
    at_ += count;
    return true;
  }

  /// Of the file, behind what has been read.
  [[nodiscard]] std::uint64_t position() const { return base64_ ? at_ - (text_.size() - used_) : at_; }

 private:
  /// The next four characters to the last places of three_. A text within the text may end with padding.
  [[nodiscard]] bool decode() {
    std::uint32_t bits = 0;
    std::size_t padding = 0;
    for (int k = 0; k < 4;) {
      if (used_ == text_.size() && !fetch()) return false;
      const char c = text_[used_++];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      const int value = value_of(c);
      if (c == '=' ? k < 2 : value < 0 || padding > 0) return false;
      if (c == '=') ++padding;
      bits = bits << 6 | static_cast<std::uint32_t>(c == '=' ? 0 : value);
      ++k;
    }
    const std::array<std::byte, 3> bytes{std::byte(bits >> 16), std::byte(bits >> 8 & 255), std::byte(bits & 255)};
    next_ = padding;
    std::copy_n(bytes.begin(), bytes.size() - padding, three_.begin() + static_cast<std::ptrdiff_t>(padding));
    return true;
  }

  [[nodiscard]] bool fetch() {
    text_.resize(std::min<std::uint64_t>(64 << 10, end_ - std::min(at_, end_)));
    used_ = 0;
    if (text_.empty()) return false;
    file_.read(at_, reinterpret_cast<std::byte*>(text_.data()), text_.size());
    at_ += text_.size();
    return true;
  }

  static int value_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  }

  const PositionalFile& file_;
  bool base64_;
  std::uint64_t at_, end_;
  std::string text_;
  std::size_t used_ = 0;
  std::array<std::byte, 3> three_{};
  std::size_t next_ = 3;
};

bool read_number(ArrayBytes& bytes, const VtkArrayPlace& place, std::uint64_t& number) {
  std::array<std::byte, 8> raw{};
  const std::span<std::byte> own = std::span(raw).first(place.number_bytes);
  if (!bytes.read(own.data(), own.size())) return false;
  if (place.swapped) std::ranges::reverse(own);
  static_assert(std::endian::native == std::endian::little);
  number = std::bit_cast<std::uint64_t>(raw);
  return true;
}

/// What stands before a compressed array's blocks.
struct BlockTable {
  std::uint64_t block = 0, last = 0;  ///< bytes of each, unpacked
  std::vector<std::uint64_t> packed;
};

/// None unless it fits an array of so many bytes in this file.
std::optional<BlockTable> block_table(ArrayBytes& bytes, const VtkArrayPlace& place, std::uint64_t count,
                                      std::uint64_t file_bytes) {
  BlockTable table;
  std::uint64_t blocks = 0;
  if (!read_number(bytes, place, blocks) || !read_number(bytes, place, table.block) ||
      !read_number(bytes, place, table.last))
    return std::nullopt;
  if (table.block == 0 || table.block > largest_block || table.last > table.block || blocks == 0 ||
      blocks > file_bytes / place.number_bytes)
    return std::nullopt;
  if (table.last == 0) table.last = table.block;
  if ((blocks - 1) * table.block + table.last != count) return std::nullopt;
  table.packed.resize(blocks);
  std::uint64_t all = 0;
  for (std::uint64_t& packed : table.packed) {
    if (!read_number(bytes, place, packed) || packed > largest_block + (largest_block >> 8)) return std::nullopt;
    all += packed;
  }
  if (all > file_bytes) return std::nullopt;
  return table;
}

/// Hands on `count` bytes, counting them in `made`; false: they end or break before.
bool pass_on(const PositionalFile& file, const VtkArrayPlace& place, std::uint64_t count, std::uint64_t& made,
             const ByteSink& use) {
  ArrayBytes bytes(file, place);
  if (!place.compressed) {
    std::uint64_t said = 0;
    if (!read_number(bytes, place, said) || said != count) return false;
    std::vector<std::byte> part(std::min<std::uint64_t>(256 << 10, count));
    for (; made < count; made += part.size()) {
      part.resize(std::min<std::uint64_t>(part.size(), count - made));
      if (!bytes.read(part.data(), part.size())) return false;
      use(part);
    }
    return true;
  }
  const auto table = block_table(bytes, place, count, file.size());
  if (!table) return false;
  std::vector<std::byte> packed, part;
  for (std::size_t k = 0; k < table->packed.size(); ++k, made += part.size()) {
    packed.resize(table->packed[k]);
    part.resize(k + 1 < table->packed.size() ? table->block : table->last);
    if (!bytes.read(packed.data(), packed.size()) || !inflate_block(packed, part)) return false;
    use(part);
  }
  return true;
}

}  // namespace

std::optional<std::uint64_t> end_of_vtk_array(const PositionalFile& file, const VtkArrayPlace& place,
                                              std::uint64_t count) {
  ArrayBytes bytes(file, place);
  std::uint64_t packed = count;
  if (place.compressed) {
    const auto table = block_table(bytes, place, count, file.size());
    if (!table) return std::nullopt;
    packed = 0;
    for (const std::uint64_t block : table->packed) packed += block;
  } else {
    std::uint64_t said = 0;
    if (!read_number(bytes, place, said) || said != count) return std::nullopt;
  }
  const std::uint64_t text = place.base64 ? packed / 3 * 4 : packed;
  if (text > file.size() - bytes.position()) return std::nullopt;
  return bytes.position() + text;
}

std::optional<std::vector<std::byte>> small_vtk_array(const PositionalFile& file, const VtkArrayPlace& place,
                                                      std::uint64_t count) {
  std::vector<std::byte> all;
  std::uint64_t made = 0;
  const auto keep = [&](std::span<const std::byte> part) { all.insert(all.end(), part.begin(), part.end()); };
  if (!pass_on(file, place, count, made, keep)) return std::nullopt;
  return all;
}

void read_vtk_array(const std::filesystem::path& path, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const ByteSink& use) {
  std::uint64_t made = 0;
  if (!pass_on(PositionalFile(path, source), place, count, made, use))
    throw scene::bad_input(
        fmt::format("{}: its samples end or break after {} of {} bytes; the file is truncated or damaged, write it "
                    "anew",
                    source, made, count));
}

}  // namespace tessera::io
