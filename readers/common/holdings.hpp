// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "cells/cell_block.hpp"
#include "io/foreign/messages/foreign_data.hpp"

namespace tessera::readers {

/// The arrays of the opened files, until they are taken or dropped.
class Holdings {
 public:
  /// Copies tuples [first, first + count) of an array to `out`.
  using Read = std::function<void(std::uint64_t first, std::uint64_t count, std::byte* out)>;
  struct Held {
    io::ForeignArray array;
    Read read;
  };

  /// Adds an array: assigns its number and stores the function that reads it.
  io::ForeignArray hold(io::ForeignArray array, Read read);

  /// Adds an array whose numbers stay in memory during the lifetime of `owner`.
  io::ForeignArray hold(io::ForeignArray array, const void* numbers, std::shared_ptr<const void> owner);

  /// Returns the array with this number; null if there is none.
  [[nodiscard]] const Held* find(std::uint64_t number) const;
  void drop(std::uint64_t number) { held_.erase(number); }

 private:
  std::map<std::uint64_t, Held> held_;
  std::uint64_t next_ = 0;
};

/// Adds an array that takes ownership of a vector's numbers; their count determines the number of tuples.
template <class T>
io::ForeignArray hold_vector(Holdings& holdings, io::ForeignArray array, std::vector<T> numbers) {
  array.tuples = numbers.size() * sizeof(T) / (static_cast<std::size_t>(array.components) * io::size_of(array.type));
  auto kept = std::make_shared<const std::vector<T>>(std::move(numbers));
  const void* const start = kept->data();
  return holdings.hold(std::move(array), start, std::move(kept));
}

/// Adds the arrays of a block that a reader created. Fields are read on demand, and twice: the first time for their
/// ranges.
io::ForeignPart hold_block(Holdings& holdings, cells::CellBlock block);

}  // namespace tessera::readers
