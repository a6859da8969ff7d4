// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_text_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <type_traits>

#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

constexpr std::uint64_t window = 256 << 10;
constexpr std::size_t longest_number = 1024;

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// The type that a stream parses for 8-bit numbers. The result is truncated to 8 bits.
template <class T>
using Read = std::conditional_t<sizeof(T) == 1, std::int16_t, T>;

/// Streams accept a minus sign for unsigned numbers and wrap the result.
template <class T>
const char* read_unsigned(const char* at, const char* end, T& number) {
  const bool negative = at < end && *at == '-';
  const auto [behind, error] = std::from_chars(at + (negative ? 1 : 0), end, number);
  if (error != std::errc()) return nullptr;
  if (negative) number = static_cast<T>(T{0} - number);
  return behind;
}

/// A number too small for its floating-point type becomes 0 or the nearest subnormal; a number too large is refused.
template <class T>
const char* read_float(const char* at, const char* end, T& number) {
  const auto [behind, error] = std::from_chars(at, end, number);
  if (error == std::errc()) return behind;
  if (error != std::errc::result_out_of_range) return nullptr;
  const std::string word(at, behind);
  if constexpr (std::is_same_v<T, float>)
    number = std::strtof(word.c_str(), nullptr);
  else
    number = std::strtod(word.c_str(), nullptr);
  return std::isfinite(number) ? behind : nullptr;
}

/// Returns the end of the number; null if there is none.
template <class T>
const char* read_word(const char* at, const char* end, T& number) {
  if (at + 1 < end && *at == '+' && at[1] != '-') ++at;
  if constexpr (std::is_floating_point_v<T>) {
    return read_float(at, end, number);
  } else if constexpr (std::is_unsigned_v<T>) {
    return read_unsigned(at, end, number);
  } else {
    const auto [behind, error] = std::from_chars(at, end, number);
    return error == std::errc() ? behind : nullptr;
  }
}

}  // namespace

VtkTextNumbers::VtkTextNumbers(const system::PositionalFile& file, std::uint64_t first, std::uint64_t end)
    : file_(&file), at_(std::min(first, end)), end_(end) {}

bool VtkTextNumbers::fetch() {
  text_.erase(0, used_);
  used_ = 0;
  const std::size_t kept = text_.size(), more = std::min<std::uint64_t>(window, end_ - at_);
  text_.resize(kept + more);
  file_->read(at_, reinterpret_cast<std::byte*>(text_.data() + kept), more);
  at_ += more;
  return more > 0;
}

template <class T>
bool VtkTextNumbers::read_number(T& number) {
  for (;;) {
    while (used_ < text_.size() && is_blank(text_[used_])) ++used_;
    if (at_ == end_ || text_.size() - used_ > longest_number) break;
    if (!fetch()) break;
  }
  const char* const end = text_.data() + text_.size();
  Read<T> value{};
  const char* const behind = read_word(text_.data() + used_, end, value);
  if (behind == nullptr || (behind == end && at_ < end_)) return false;
  used_ = static_cast<std::size_t>(behind - text_.data());
  number = static_cast<T>(value);
  return true;
}

std::string VtkTextNumbers::next_word() const {
  constexpr std::size_t most = 24;
  std::size_t first = used_;  // if 1.5 was read as an integer, its 1 has been consumed
  while (first > 0 && !is_blank(text_[first - 1])) --first;
  const std::string word = text_.substr(first, most);
  return word.substr(0, static_cast<std::size_t>(std::ranges::find_if(word, is_blank) - word.begin()));
}

bool VtkTextNumbers::read(NumberType type, std::byte* to, std::uint64_t count) {
  return with_number_type(type, [&](auto zero) {
    using T = decltype(zero);
    for (; count > 0; --count, to += sizeof(T)) {
      T number{};
      if (!read_number(number)) return false;
      std::memcpy(to, &number, sizeof number);
    }
    return true;
  });
}

}  // namespace tessera::io
