// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/stored_samples.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "io/text/text_file.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "scene/sample_source.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::string_view sample_blanks = " \t\r\n,";

scene::Error too_few(const std::string& source, std::uint64_t found, std::uint64_t count, const char* what) {
  return scene::bad_input(
      fmt::format("{}: its samples end after {} of {} {}; the file is truncated or damaged, write "
                  "it again",
                  source, found, count, what));
}

template <class T>
void parse_samples(std::string_view text, std::uint64_t count, std::span<std::byte> out, const std::string& source) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::uint64_t n = 0; n < count; ++n) {
    while (at != end && sample_blanks.find(*at) != std::string_view::npos) ++at;
    if (at == end) throw too_few(source, n, count, "numbers");
    if (*at == '+') ++at;
    // Parsed as double, because integers may be written as 12.0. A double represents integers of 32 bits exactly.
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    bool good = error == std::errc() && (stop == end || sample_blanks.find(*stop) != std::string_view::npos);
    if constexpr (std::is_same_v<T, float>)  // numbers beyond a float's range become infinite, and therefore blank
      if (std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max())
        value = std::copysign(std::numeric_limits<double>::infinity(), value);
    if constexpr (std::is_integral_v<T>)
      good = good && value == std::trunc(value) && value >= static_cast<double>(std::numeric_limits<T>::min()) &&
             value <= static_cast<double>(std::numeric_limits<T>::max());
    if (!good)
      throw scene::bad_input(fmt::format(
          "{}: sample {} is {}, not a number of its type; the file is damaged or of another type, write it again",
          source, n, quote({at, std::min<std::size_t>(static_cast<std::size_t>(end - at), 20)})));
    const T sample = static_cast<T>(value);
    std::memcpy(out.data() + n * sizeof(T), &sample, sizeof(T));
    at = stop;
  }
}

}  // namespace

std::vector<std::byte> samples_of_text(std::string_view text, std::uint64_t count, scene::SampleType type,
                                       const std::string& source) {
  // Each number takes at least a digit and a blank.
  if (count > text.size() / 2 + 1) throw too_few(source, text.size() / 2, count, "numbers");
  std::vector<std::byte> out(count * scene::size_of(type));
  scene::with_sample_type(type, [&](auto sample) { parse_samples<decltype(sample)>(text, count, out, source); });
  return out;
}

std::vector<std::byte> bytes_of_hex(std::string_view text, std::uint64_t count, const std::string& source) {
  if (count > text.size() / 2) throw too_few(source, text.size() / 2, count, "bytes");
  std::vector<std::byte> out(count);
  std::size_t at = 0;
  for (std::uint64_t n = 0; n < 2 * count; ++n) {
    at = text.find_first_not_of(" \t\r\n", at);
    if (at == std::string_view::npos) throw too_few(source, n / 2, count, "bytes");
    const int digit = hex_digit(text[at++]);
    if (digit < 0)
      throw scene::bad_input(
          fmt::format("{}: its samples contain {}, which is not a hexadecimal digit; write the file again", source,
                      quote(text.substr(at - 1, 10))));
    std::byte& byte = out[static_cast<std::size_t>(n / 2)];
    byte = static_cast<std::byte>((std::to_integer<int>(byte) << 4) | digit);
  }
  return out;
}

std::vector<double> doubles_of_int64(std::span<const std::byte> bytes, bool is_signed, bool swapped) {
  std::vector<double> values(bytes.size() / 8);
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] = is_signed ? static_cast<double>(scene::load<std::int64_t>(bytes.data() + 8 * n, swapped))
                          : static_cast<double>(scene::load<std::uint64_t>(bytes.data() + 8 * n, swapped));
  return values;
}

}  // namespace tessera::io
