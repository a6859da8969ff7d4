// SPDX-License-Identifier: BSD-3-Clause
#include "scene/number_type.hpp"

#include <algorithm>
#include <array>

#include "tessera/program/text.hpp"

namespace tessera::scene {
namespace {

/// The NumberType of each SampleType.
constexpr std::array sample_numbers = {NumberType::int8,  NumberType::uint8,  NumberType::int16,   NumberType::uint16,
                                       NumberType::int32, NumberType::uint32, NumberType::float32, NumberType::float64};

}  // namespace

const char* name_of(NumberType type) {
  static constexpr std::array names = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                       "uint32", "int64", "uint64", "float32", "float64"};
  return names[static_cast<std::size_t>(type)];
}

const char* listed_name(NumberType type) {
  return type == NumberType::float32 ? "float" : type == NumberType::float64 ? "double" : name_of(type);
}

std::optional<SampleType> sample_type_of(NumberType type) {
  const auto* const found = std::ranges::find(sample_numbers, type);
  if (found == sample_numbers.end()) return std::nullopt;
  return static_cast<SampleType>(found - sample_numbers.begin());
}

NumberType number_type_of(SampleType type) { return sample_numbers[static_cast<std::size_t>(type)]; }

std::optional<NumberType> number_type_named(std::string_view word, std::span<const NumberTypeNames> names) {
  for (const NumberTypeNames& each : names)
    if (std::ranges::count(split_words(each.names, ","), word) > 0) return each.type;
  return std::nullopt;
}

}  // namespace tessera::scene
