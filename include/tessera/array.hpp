// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <ranges>
#include <span>
#include <type_traits>

#include "tessera/cell_type.hpp"

namespace tessera {
inline namespace v0_1 {

/// Type in which a number is stored.
enum class NumberType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// The NumberType of a C++ number type.
template <class T>
requires std::is_arithmetic_v<T>
constexpr NumberType number_type_of() {
  if constexpr (std::is_floating_point_v<T>) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8, "float and double only");
    return sizeof(T) == 4 ? NumberType::float32 : NumberType::float64;
  } else {
    constexpr int size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 2 : sizeof(T) == 4 ? 4 : 6;
    return static_cast<NumberType>(size + (std::is_signed_v<T> ? 0 : 1));
  }
}

/// A view of contiguous numbers in the caller's memory. It can be made from any vector, array or span of numbers, of
/// glm::dvec3 (each counts as three numbers), or of CellType (stored as uint8). The view does not own the memory, which
/// must stay valid while the view is used.
class ArrayView {
 public:
  ArrayView() = default;

  template <std::ranges::contiguous_range Range>
  requires std::ranges::sized_range<Range> && std::is_arithmetic_v<std::ranges::range_value_t<Range>> ArrayView(
      const Range& numbers)  // NOLINT(google-explicit-constructor): conversion is intended
      : data_(std::ranges::data(numbers)),
        size_(std::ranges::size(numbers)),
        type_(number_type_of<std::ranges::range_value_t<Range>>()) {}

  template <std::ranges::contiguous_range Range>
  requires std::ranges::sized_range<Range> && std::same_as<std::ranges::range_value_t<Range>, glm::dvec3> ArrayView(
      const Range& vectors)  // NOLINT(google-explicit-constructor): conversion is intended
      : data_(std::ranges::data(vectors)), size_(3 * std::ranges::size(vectors)), type_(NumberType::float64) {}

  template <std::ranges::contiguous_range Range>
  requires std::ranges::sized_range<Range> && std::same_as<std::ranges::range_value_t<Range>, CellType> ArrayView(
      const Range& types)  // NOLINT(google-explicit-constructor): conversion is intended
      : data_(std::ranges::data(types)), size_(std::ranges::size(types)), type_(NumberType::uint8) {}

  ArrayView(const void* data, std::size_t size, NumberType type) : data_(data), size_(size), type_(type) {}

  [[nodiscard]] const void* data() const { return data_; }
  /// Number of elements.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] NumberType type() const { return type_; }

  /// Returns the numbers if they are stored as T; otherwise an empty span.
  template <class T>
  [[nodiscard]] std::span<const T> as() const {
    return type_ == number_type_of<T>() ? std::span(static_cast<const T*>(data_), size_) : std::span<const T>();
  }

 private:
  const void* data_ = nullptr;
  std::size_t size_ = 0;
  NumberType type_ = NumberType::float64;
};

}  // namespace v0_1
}  // namespace tessera
