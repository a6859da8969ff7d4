#include "io/helper/holdings.hpp"

#include <algorithm>
#include <utility>

#include "io/helper_messages.hpp"

namespace tessera::io::helper {
namespace {

constexpr std::size_t tuples_at_once = 1 << 16;

/// Writes a field of doubles tuple by tuple.
bool write_field(const BlockField& field, int file) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> plane(std::min(field.tuples, tuples_at_once)), tuples(plane.size() * components);
  for (std::size_t first = 0; first < field.tuples; first += plane.size()) {
    const std::size_t n = std::min(plane.size(), field.tuples - first);
    for (std::size_t c = 0; c < components; ++c) {
      field.read(static_cast<int>(c), first, std::span(plane).first(n));
      for (std::size_t k = 0; k < n; ++k) tuples[k * components + c] = plane[k];
    }
    if (!write_all(file, tuples.data(), n * components * sizeof(double))) return false;
  }
  return true;
}

ForeignArray hold_field(Holdings& holdings, const BlockField& field) {
  ForeignArray array;
  array.name = field.name;
  array.type = NumberType::float64;
  array.components = field.components;
  array.tuples = field.tuples;
  array.active = field.active;
  std::vector<double> some(std::min(field.tuples, tuples_at_once));
  for (std::size_t first = 0; first < field.tuples; first += some.size()) {
    const std::span chunk = std::span(some).first(std::min(some.size(), field.tuples - first));
    field.read(field.components == 1 ? 0 : magnitude, first, chunk);
    array.tally.add(chunk);
  }
  return holdings.hold(std::move(array), [field](int file) { return write_field(field, file); });
}

}  // namespace

ForeignArray Holdings::hold(ForeignArray array, Write write) {
  array.number = next_++;
  held_.emplace(array.number, std::move(write));
  return array;
}

ForeignArray Holdings::hold(ForeignArray array, const void* numbers, std::shared_ptr<const void> owner) {
  const std::uint64_t bytes = array.bytes();
  return hold(std::move(array),
              [numbers, bytes, owner = std::move(owner)](int file) { return write_all(file, numbers, bytes); });
}

const Holdings::Write* Holdings::find(std::uint64_t number) const {
  const auto found = held_.find(number);
  return found == held_.end() ? nullptr : &found->second;
}

ForeignPart hold_block(Holdings& holdings, CellBlock block) {
  ForeignPart part;
  part.name = block.name;
  part.points = hold_vector(holdings, {.type = NumberType::float64, .components = 3}, std::move(block.positions));
  part.types = hold_vector(holdings, {.type = NumberType::uint8}, std::move(block.types));
  part.offsets = hold_vector(holdings, {.type = NumberType::uint64}, std::move(block.offsets));
  part.connectivity = hold_vector(holdings, {.type = NumberType::uint32}, std::move(block.connectivity));
  for (const BlockField& field : block.fields)
    (field.association == scene::Association::point ? part.point_fields : part.cell_fields)
        .push_back(hold_field(holdings, field));
  return part;
}

}  // namespace tessera::io::helper
