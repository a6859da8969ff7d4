// SPDX-License-Identifier: BSD-3-Clause
#include "readers/common/holdings.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tessera::readers {
namespace {

constexpr std::size_t tuples_at_once = 1 << 16;

/// Reads the doubles of a field, in tuples.
void read_field(const cells::BlockField& field, std::uint64_t first, std::uint64_t count, std::byte* out) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> plane(std::min<std::size_t>(count, tuples_at_once));
  for (std::size_t done = 0; done < count; done += plane.size()) {
    const std::size_t n = std::min<std::size_t>(plane.size(), count - done);
    for (std::size_t c = 0; c < components; ++c) {
      field.read(static_cast<int>(c), first + done, std::span(plane).first(n));
      for (std::size_t k = 0; k < n; ++k)
        std::memcpy(out + ((done + k) * components + c) * sizeof(double), &plane[k], sizeof(double));
    }
  }
}

io::ForeignArray hold_field(Holdings& holdings, const cells::BlockField& field) {
  io::ForeignArray array;
  array.name = field.name;
  array.type = NumberType::float64;
  array.components = field.components;
  array.tuples = field.tuples;
  array.active = field.active;
  array.ids = field.ids;
  std::vector<double> some(std::min(field.tuples, tuples_at_once));
  for (std::size_t first = 0; first < field.tuples; first += some.size()) {
    const std::span chunk = std::span(some).first(std::min(some.size(), field.tuples - first));
    field.read(field.components == 1 ? 0 : cells::magnitude, first, chunk);
    array.tally.add(chunk);
  }
  return holdings.hold(std::move(array), [field](std::uint64_t first, std::uint64_t count, std::byte* out) {
    read_field(field, first, count, out);
  });
}

}  // namespace

io::ForeignArray Holdings::hold(io::ForeignArray array, Read read) {
  array.number = next_++;
  held_.emplace(array.number, Held{array, std::move(read)});
  return array;
}

io::ForeignArray Holdings::hold(io::ForeignArray array, const void* numbers, std::shared_ptr<const void> owner) {
  const std::size_t tuple = array.tuple_bytes();
  return hold(std::move(array), [start = static_cast<const std::byte*>(numbers), tuple, owner = std::move(owner)](
                                    std::uint64_t first, std::uint64_t count, std::byte* out) {
    if (count > 0) std::memcpy(out, start + first * tuple, count * tuple);
  });
}

const Holdings::Held* Holdings::find(std::uint64_t number) const {
  const auto found = held_.find(number);
  return found == held_.end() ? nullptr : &found->second;
}

io::ForeignPart hold_block(Holdings& holdings, cells::CellBlock block) {
  io::ForeignPart part;
  part.name = block.name;
  part.points = hold_vector(holdings, {.type = NumberType::float64, .components = 3}, std::move(block.positions));
  part.types = hold_vector(holdings, {.type = NumberType::uint8}, std::move(block.types));
  part.offsets = hold_vector(holdings, {.type = NumberType::uint64}, std::move(block.offsets));
  part.connectivity = hold_vector(holdings, {.type = NumberType::uint32}, std::move(block.connectivity));
  if (!block.faces.empty()) {
    part.faces = hold_vector(holdings, {.type = NumberType::uint32}, std::move(block.faces));
    part.face_locations = hold_vector(holdings, {.type = NumberType::int64}, std::move(block.face_locations));
  }
  for (const cells::BlockField& field : block.fields)
    (field.association == scene::Association::point ? part.point_fields : part.cell_fields)
        .push_back(hold_field(holdings, field));
  return part;
}

}  // namespace tessera::readers
