// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/grid.hpp"

namespace tessera::io {

/// Samples that must be converted before use: text, hexadecimal, 64-bit integers. All functions throw Error(bad_input,
/// "SOURCE: ...") for damaged input, before they allocate memory that the text could not fill.

/// Parses `count` numbers separated by white space or commas, and stores them as `type`. "nan" and "inf" are valid for
/// floating-point types. Ignores any numbers after the first `count`; a number outside the type's range is an error.
std::vector<std::byte> samples_of_text(std::string_view text, std::uint64_t count, scene::SampleType type,
                                       const std::string& source);

/// Parses `count` bytes in hexadecimal, two digits each. White space is allowed between any digits.
std::vector<std::byte> bytes_of_hex(std::string_view text, std::uint64_t count, const std::string& source);

/// Converts 64-bit integers to doubles, which rounds integers beyond 2^53. `swapped`: the byte order is not native.
std::vector<double> doubles_of_int64(std::span<const std::byte> bytes, bool is_signed, bool swapped);

}  // namespace tessera::io
