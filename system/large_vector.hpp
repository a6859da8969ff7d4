// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace tessera::system {

/// Allocates `count` elements. Large allocations use large pages, which are faster to fill and to read.
template <class T>
void reserve_large(std::vector<T>& numbers, std::size_t count) {
  numbers.reserve(count);
  constexpr std::size_t page = 1 << 21;
  std::size_t room = numbers.capacity() * sizeof(T);
  void* first = numbers.data();
  // If this fails, small pages are used.
  if (std::align(page, page, first, room) != nullptr)
    static_cast<void>(::madvise(first, room / page * page, MADV_HUGEPAGE));
}

}  // namespace tessera::system
