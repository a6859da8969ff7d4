// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "io/foreign/messages/foreign_data.hpp"
#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// A contiguous array of numbers of one type.
struct GridNumbers {
  NumberType type = NumberType::float64;
  std::vector<std::byte> bytes{};

  [[nodiscard]] std::size_t count() const { return bytes.size() / io::size_of(type); }
  [[nodiscard]] std::vector<double> as_doubles() const;
};

/// Copies doubles, rounded to float32 if `type` is float32.
GridNumbers numbers_of(std::span<const double> values, NumberType type = NumberType::float64);

/// Maps the axes x, y and z of a grid to those of a stored array: axis a is the array's axis `along[a]`. All other axes
/// of the array have length 1.
using GridAxes = std::array<std::size_t, 3>;

/// Reorders items of `width` bytes to grid order, x fastest. `lengths` are the lengths of the stored axes, the slowest
/// first.
std::vector<std::byte> in_grid_order(std::vector<std::byte> items, std::size_t width,
                                     std::span<const std::size_t> lengths, const GridAxes& along);

/// Adds a field with its range; `components` numbers per tuple.
io::ForeignArray hold_field_numbers(Holdings& holdings, std::string name, GridNumbers numbers, int components = 1);

/// Adds coordinates, points or other numbers, without a range.
io::ForeignArray hold_numbers(Holdings& holdings, GridNumbers numbers, int components = 1);

}  // namespace tessera::readers
