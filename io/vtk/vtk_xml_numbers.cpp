// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "system/large_vector.hpp"
#include "system/positional_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// At least bytes_at_once bytes are read at once: many of VTK's blocks (32 KiB), but within the processor's cache. If
/// blocks are larger, blocks_at_once blocks are read at once, one per thread, but at most most_at_once bytes.
constexpr std::size_t bytes_at_once = 1 << 20, most_at_once = 16 << 20, blocks_at_once = 4;

/// Reads the numbers of an ascii or binary array sequentially.
class Numbers {
 public:
  /// Opens an array. No value if it is damaged.
  static std::optional<Numbers> open(const system::PositionalFile& file, const VtkXmlArray& array) {
    if (!array.type) return std::nullopt;
    const VtkArrayPlace& place = array.place;
    if (array.ascii) return Numbers(array, VtkTextNumbers(file, place.first_byte, std::min(place.end, file.size())));
    auto bytes = VtkArrayBytes::open(file, place);
    return bytes ? std::optional(Numbers(array, *std::move(bytes))) : std::nullopt;
  }

  /// Upper bound of the number of available numbers.
  [[nodiscard]] std::uint64_t most() const {
    const auto* const text = std::get_if<VtkTextNumbers>(&from_);
    if (text != nullptr) return text->left();
    const std::uint64_t bytes = std::get<VtkArrayBytes>(from_).size();
    return are_bits_ ? 8 * bytes : bytes / size_of(type_);
  }

  [[nodiscard]] std::size_t bytes_to_read() const {
    const auto* const bytes = std::get_if<VtkArrayBytes>(&from_);
    const std::uint64_t block = bytes != nullptr ? bytes->block_size() : 0;
    return block > bytes_at_once ? std::min<std::uint64_t>(block, most_at_once / blocks_at_once) * blocks_at_once
                                 : bytes_at_once;
  }

  /// If read() failed on text, returns the word that is not a number of the array's type; otherwise empty.
  [[nodiscard]] std::string wrong_word() const {
    const auto* const text = std::get_if<VtkTextNumbers>(&from_);
    return text != nullptr ? text->next_word() : std::string();
  }

  [[nodiscard]] bool read(std::byte* to, std::uint64_t count) {
    if (auto* const text = std::get_if<VtkTextNumbers>(&from_)) return text->read(type_, to, count);
    if (are_bits_) return read_bits(to, count);
    const std::size_t each = size_of(type_);
    if (!std::get<VtkArrayBytes>(from_).read(to, count * each)) return false;
    if (swapped_) with_number_type(type_, [&](auto zero) { scene::swap_numbers<decltype(zero)>({to, count * each}); });
    return true;
  }

 private:
  using From = std::variant<VtkTextNumbers, VtkArrayBytes>;
  Numbers(const VtkXmlArray& array, From from)
      : type_(*array.type), are_bits_(array.are_bits), swapped_(array.place.swapped), from_(std::move(from)) {}

  [[nodiscard]] bool read_bits(std::byte* to, std::uint64_t count) {
    for (; count > 0; --count, --bits_left_, ++to) {
      if (bits_left_ == 0) {
        if (!std::get<VtkArrayBytes>(from_).read(&byte_, 1)) return false;
        bits_left_ = 8;
      }
      *to = (byte_ >> (bits_left_ - 1)) & std::byte{1};
    }
    return true;
  }

  NumberType type_;
  bool are_bits_, swapped_;
  From from_;
  std::byte byte_{};
  int bits_left_ = 0;  ///< left in the current byte
};

Numbers numbers_in(const system::PositionalFile& file, const VtkXmlSegment& segment, const std::string& source) {
  auto numbers = Numbers::open(file, segment.array);
  if (!numbers || numbers->most() < segment.numbers)
    throw scene::bad_input(
        fmt::format("{}: its array {} is damaged or has {}fewer numbers than the {} that it needs; the file is "
                    "truncated or damaged, export it again",
                    source, quote(segment.array.name), numbers ? "" : "perhaps ", segment.numbers));
  return *std::move(numbers);
}

}  // namespace

void require_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, const std::string& source) {
  if (segment.numbers > 0) static_cast<void>(numbers_in(file, segment, source));
}

void stream_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, std::size_t together,
                    const std::string& source, const system::ByteSink& use) {
  if (segment.numbers == 0) return;
  Numbers numbers = numbers_in(file, segment, source);
  const std::size_t each = size_of(*segment.array.type);
  const std::uint64_t at_once = std::min<std::uint64_t>(
      std::max<std::size_t>(numbers.bytes_to_read() / (each * together), 1) * together, segment.numbers);
  std::vector<std::byte> part(at_once * each);
  for (std::uint64_t done = 0; done < segment.numbers;) {
    const std::uint64_t now = std::min(at_once, segment.numbers - done);
    if (!numbers.read(part.data(), now)) {
      if (const std::string word = numbers.wrong_word(); !word.empty())
        throw scene::bad_input(fmt::format("{}: its array {} has {} where a number of type {} is required; correct it",
                                           source, quote(segment.array.name), quote(word),
                                           scene::listed_name(*segment.array.type)));
      throw scene::bad_input(
          fmt::format("{}: its array {} becomes unreadable between its numbers {} and {} of {}; the file is truncated "
                      "or damaged, export it again",
                      source, quote(segment.array.name), done, done + now, segment.numbers));
    }
    use(std::span(part).first(now * each));
    done += now;
  }
}

void stream_whole_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, std::size_t together,
                          const std::string& source, const std::function<void(std::span<const std::int64_t>)>& use) {
  std::vector<std::int64_t> wide;
  const NumberType type = segment.array.type.value_or(NumberType::float64);
  stream_numbers(file, segment, together, source, [&](std::span<const std::byte> bytes) {
    with_number_type(type, [&](auto zero) {
      using T = decltype(zero);
      if constexpr (std::is_integral_v<T>) {
        const std::span numbers(reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T));
        wide.resize(numbers.size());
        for (std::size_t k = 0; k < numbers.size(); ++k) wide[k] = static_cast<std::int64_t>(numbers[k]);
        use(wide);
      } else {
        throw scene::bad_input(fmt::format("{}: the numbers of its array {} are not integers; the file may be damaged",
                                           source, quote(segment.array.name)));
      }
    });
  });
}

std::vector<std::int64_t> whole_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment,
                                        const std::string& source) {
  require_numbers(file, segment, source);
  std::vector<std::int64_t> all;
  system::reserve_large(all, segment.numbers);
  stream_whole_numbers(file, segment, 1, source,
                       [&](std::span<const std::int64_t> part) { all.insert(all.end(), part.begin(), part.end()); });
  return all;
}

}  // namespace tessera::io
