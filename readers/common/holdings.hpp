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

/// The arrays of the files that were opened, until they are taken or dropped.
class Holdings {
 public:
  /// Copies tuples [first, first + count) to `out`.
  using Read = std::function<void(std::uint64_t first, std::uint64_t count, std::byte* out)>;
  struct Held {
    io::ForeignArray array;
    Read read;
  };

  /// Numbers the array and keeps what reads it.
  io::ForeignArray hold(io::ForeignArray array, Read read);

  /// Of numbers that stay where they are for as long as `owner` lives.
  io::ForeignArray hold(io::ForeignArray array, const void* numbers, std::shared_ptr<const void> owner);

  /// Null if there is none of this number.
  [[nodiscard]] const Held* find(std::uint64_t number) const;
  void drop(std::uint64_t number) { held_.erase(number); }

 private:
  std::map<std::uint64_t, Held> held_;
  std::uint64_t next_ = 0;
};

/// A vector's numbers, which the holdings then own. They say how many tuples there are.
template <class T>
io::ForeignArray hold_vector(Holdings& holdings, io::ForeignArray array, std::vector<T> numbers) {
  array.tuples = numbers.size() * sizeof(T) / (static_cast<std::size_t>(array.components) * io::size_of(array.type));
  auto kept = std::make_shared<const std::vector<T>>(std::move(numbers));
  const void* const start = kept->data();
  return holdings.hold(std::move(array), start, std::move(kept));
}

/// A block as its reader made it. Its fields are read when they are asked for, twice: once for their ranges.
io::ForeignPart hold_block(Holdings& holdings, cells::CellBlock block);

}  // namespace tessera::readers
