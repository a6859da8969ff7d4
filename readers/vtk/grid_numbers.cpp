// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/grid_numbers.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "cells/cell_block.hpp"

namespace tessera::readers {

std::vector<double> GridNumbers::as_doubles() const {
  std::vector<double> values(count());
  io::read_tuples(bytes, type, 1, 0, 0, values);
  return values;
}

GridNumbers numbers_of(std::span<const double> values, NumberType type) {
  GridNumbers numbers{type, std::vector<std::byte>(values.size() * io::size_of(type))};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto rounded = static_cast<float>(values[k]);
    if (type == NumberType::float32)
      std::memcpy(&numbers.bytes[k * sizeof rounded], &rounded, sizeof rounded);
    else
      std::memcpy(&numbers.bytes[k * sizeof(double)], &values[k], sizeof(double));
  }
  return numbers;
}

std::vector<std::byte> in_grid_order(std::vector<std::byte> items, std::size_t width,
                                     std::span<const std::size_t> lengths, const GridAxes& along) {
  if (along[2] < along[1] && along[1] < along[0]) return items;
  std::vector<std::size_t> strides(lengths.size(), width);
  for (std::size_t d = lengths.size(); d-- > 1;) strides[d - 1] = strides[d] * lengths[d];
  std::vector<std::byte> ordered(items.size());
  std::byte* out = ordered.data();
  for (std::size_t k = 0; k < lengths[along[2]]; ++k)
    for (std::size_t j = 0; j < lengths[along[1]]; ++j) {
      const std::byte* const row = items.data() + k * strides[along[2]] + j * strides[along[1]];
      for (std::size_t i = 0; i < lengths[along[0]]; ++i, out += width)
        std::memcpy(out, row + i * strides[along[0]], width);
    }
  return ordered;
}

io::ForeignArray hold_numbers(Holdings& holdings, GridNumbers numbers, int components) {
  const NumberType type = numbers.type;
  return hold_vector(holdings, {.type = type, .components = components}, std::move(numbers.bytes));
}

io::ForeignArray hold_field_numbers(Holdings& holdings, std::string name, GridNumbers numbers, int components) {
  io::ForeignArray field;
  field.name = std::move(name);
  field.type = numbers.type;
  field.components = components;
  const std::size_t tuples = numbers.count() / static_cast<std::size_t>(components);
  std::array<double, 4096> some;
  for (std::size_t first = 0; first < tuples; first += some.size()) {
    const std::span chunk(some.data(), std::min(some.size(), tuples - first));
    io::read_tuples(numbers.bytes, field.type, components, components == 1 ? 0 : cells::magnitude, first, chunk);
    field.tally.add(chunk);
  }
  return hold_vector(holdings, std::move(field), std::move(numbers.bytes));
}

}  // namespace tessera::readers
