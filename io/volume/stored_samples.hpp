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

/// Samples that cannot be used where they lie in the file: as text, in hexadecimal, of 64-bit integers. All throw
/// Error(bad_input, "SOURCE: ...") for damaged ones, before memory is asked for that the text could not fill.

/// `count` numbers between white space or commas, stored as `type`. "nan" and "inf" are numbers of floats. More numbers
/// than `count` are left; one that the type does not hold is an error.
std::vector<std::byte> samples_of_text(std::string_view text, std::uint64_t count, scene::SampleType type,
                                       const std::string& source);

/// `count` bytes, two digits each, white space anywhere between digits.
std::vector<std::byte> bytes_of_hex(std::string_view text, std::uint64_t count, const std::string& source);

/// 64-bit integers as doubles; `swapped` if they are of the other byte order. Rounded beyond 2^53.
std::vector<double> doubles_of_int64(std::span<const std::byte> bytes, bool is_signed, bool swapped);

}  // namespace tessera::io
