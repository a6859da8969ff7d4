#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace tessera::projection {

/// An array of millions of numbers that are written before they are read: not set to zero, kept over frames, and on
/// huge pages where the system lends them on advice (faults of 4 KiB cost as much as filling the array does).
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Room for `size` elements of no value; what was in it is lost. Room more than twice too large is given back.
  void reset(std::size_t size) {
    size_ = size;
    if (size <= capacity_ && size >= capacity_ / 2) return;
    elements_.reset();
    capacity_ = 0;
    const std::size_t bytes = size * sizeof(T);
    elements_.reset(static_cast<T*>(::operator new(bytes, std::align_val_t(alignment))));
    capacity_ = size;
#ifdef __linux__
    if (bytes >= alignment) madvise(elements_.get(), bytes / alignment * alignment, MADV_HUGEPAGE);
#endif
  }

  /// No elements; their room stays.
  void clear() { size_ = 0; }

  [[nodiscard]] T* data() { return elements_.get(); }
  [[nodiscard]] const T* data() const { return elements_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return size_ * sizeof(T); }
  T& operator[](std::size_t i) { return elements_.get()[i]; }
  const T& operator[](std::size_t i) const { return elements_.get()[i]; }

 private:
  static constexpr std::size_t alignment = std::size_t{1} << 21;
  struct Free {
    void operator()(T* p) const { ::operator delete(p, std::align_val_t(alignment)); }
  };
  std::unique_ptr<T, Free> elements_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace tessera::projection
