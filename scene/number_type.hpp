// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "scene/grid.hpp"
#include "tessera/array.hpp"

/// Functions that depend on the type in which a number is stored.
namespace tessera::scene {

using tessera::NumberType;

/// Calls `use` with a zero of the corresponding C++ type.
template <class Use>
auto with_number_type(NumberType type, const Use& use) {
  switch (type) {
    case NumberType::int8:
      return use(std::int8_t{});
    case NumberType::uint8:
      return use(std::uint8_t{});
    case NumberType::int16:
      return use(std::int16_t{});
    case NumberType::uint16:
      return use(std::uint16_t{});
    case NumberType::int32:
      return use(std::int32_t{});
    case NumberType::uint32:
      return use(std::uint32_t{});
    case NumberType::int64:
      return use(std::int64_t{});
    case NumberType::uint64:
      return use(std::uint64_t{});
    case NumberType::float32:
      return use(float{});
    case NumberType::float64:
      break;
  }
  return use(double{});
}

inline std::size_t size_of(NumberType type) {
  return with_number_type(type, [](auto zero) { return sizeof zero; });
}

/// int8, uint8, ..., float32, float64.
const char* name_of(NumberType type);
/// The name as in lists of fields and in NRRD: int8, uint8, ..., float, double.
const char* listed_name(NumberType type);

/// Returns the SampleType for this type; none for 64-bit integers.
std::optional<SampleType> sample_type_of(NumberType type);
NumberType number_type_of(SampleType type);

/// A type and a format's names for it, separated by commas.
struct NumberTypeNames {
  NumberType type;
  std::string_view names;
};
std::optional<NumberType> number_type_named(std::string_view word, std::span<const NumberTypeNames> names);

}  // namespace tessera::scene
