// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace tessera::projection {

/// An array for large data that are written before they are read. It is not set to zero, and is kept from frame to
/// frame. An array of at least half a huge page is on huge pages if the system follows the advice to use them. (Page
/// faults of 4 KiB cost as much as filling the array, and a processor's TLB has about a hundred entries, sixteen for
/// stores.)
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Provides `size` uninitialized elements; the old elements are lost. If the array has memory for more than twice
  /// `size`, that memory is freed.
  void reset(std::size_t size) {
    size_ = size;
    if (size <= capacity_ && size >= capacity_ / 2) return;
    elements_.reset();
    capacity_ = 0;
    elements_ = room_for(size);
    capacity_ = size;
  }

  /// Like reset(), but keeps the old elements.
  void grow(std::size_t size) {
    if (size > capacity_) {
      auto grown = room_for(size);
      std::copy_n(elements_.get(), size_, grown.get());
      elements_ = std::move(grown);
      capacity_ = size;
    }
    size_ = size;
  }

  /// Refers to `size` elements owned elsewhere, until the next reset().
  void refer(T* data, std::size_t size) {
    elements_ = Room(data, Free{0});
    size_ = size;
    capacity_ = 0;
  }

  /// Removes all elements; their memory stays.
  void clear() { size_ = 0; }

  [[nodiscard]] T* data() { return elements_.get(); }
  [[nodiscard]] const T* data() const { return elements_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return size_ * sizeof(T); }
  T& operator[](std::size_t i) { return elements_.get()[i]; }
  const T& operator[](std::size_t i) const { return elements_.get()[i]; }

 private:
  static constexpr std::size_t page = std::size_t{1} << 21, line = 64;
  struct Free {
    std::size_t alignment = line;  ///< 0: owned elsewhere
    void operator()(T* p) const {
      if (alignment > 0) ::operator delete(p, std::align_val_t(alignment));
    }
  };
  using Room = std::unique_ptr<T, Free>;

  static Room room_for(std::size_t size) {
    std::size_t bytes = size * sizeof(T), alignment = line;
    if (bytes >= page / 2) bytes = (bytes + page - 1) / page * page, alignment = page;
    Room room(static_cast<T*>(::operator new(bytes, std::align_val_t(alignment))), Free{alignment});
#ifdef __linux__
    if (alignment == page) madvise(room.get(), bytes, MADV_HUGEPAGE);
#endif
    return room;
  }

  Room elements_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace tessera::projection
