// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace tessera::system {

/// Room for `count` elements. Much of it comes in large pages, which are filled, and later read, in less time.
template <class T>
void reserve_large(std::vector<T>& numbers, std::size_t count) {
  numbers.reserve(count);
  constexpr std::size_t page = 1 << 21;
  std::size_t room = numbers.capacity() * sizeof(T);
  void* first = numbers.data();
  // Where it fails, pages are small.
  if (std::align(page, page, first, room) != nullptr)
    static_cast<void>(::madvise(first, room / page * page, MADV_HUGEPAGE));
}

}  // namespace tessera::system
