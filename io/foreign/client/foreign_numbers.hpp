// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "io/foreign/client/foreign_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

/// Reads all numbers of an array, whose type the caller has checked.
template <class T>
std::vector<T> numbers_of(const ForeignFile& file, const ForeignArray& array) {
  std::vector<T> numbers;
  numbers.reserve(array.bytes() / sizeof(T));
  file.arrays->stream(array, file.source, [&](std::span<const std::byte> tuples) {
    const auto* const first = reinterpret_cast<const T*>(tuples.data());
    numbers.insert(numbers.end(), first, first + tuples.size() / sizeof(T));
  });
  return numbers;
}

[[noreturn]] inline void refuse_surface(const std::string& source) {
  throw scene::bad_input(fmt::format("{}: it holds no surface; give another file", source));
}

}  // namespace tessera::io
