// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/brick_layout.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tessera::io {
namespace {

using BrickJson = nlohmann::json;
using scene::GridIndex;
using scene::SampleBox;

static_assert(std::endian::native == std::endian::little, "brick files are written in the byte order of memory");

BrickJson json_of_vector(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::string brick_header_of(const scene::Grid& grid, int side, const BrickWords& words,
                            const scene::ValueRange& range) {
  const scene::GridGeometry& g = grid.geometry;
  BrickJson direction = BrickJson::array();
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) direction.push_back(g.direction[column][row]);
  BrickJson header = {{"points", g.points},
                      {"association", g.association == scene::Association::cell ? "cell" : "point"},
                      {"origin", json_of_vector(g.origin)},
                      {"direction", direction},
                      {"spacing", json_of_vector(g.spacing)},
                      {"coordinates", g.coordinates},
                      {"type", scene::name_of(grid.type)},
                      {"scale", grid.scale},
                      {"shift", grid.shift},
                      {"field", grid.field_name},
                      {"block", side},
                      {"low", range.low},
                      {"high", range.high},
                      {"blanks", range.blanks}};
  for (const auto& [name, word] : words) header[name] = word;
  return header.dump(-1, ' ', false, BrickJson::error_handler_t::replace);
}

template <class T>
void append_bytes(std::string& text, const T* first, std::size_t count) {
  text.append(reinterpret_cast<const char*>(first), count * sizeof(T));
}

}  // namespace

void BlockRange::add(const scene::Grid& grid, std::span<const std::byte> samples) {
  std::array<double, 4096> values;
  const std::size_t size = scene::size_of(grid.type), count = samples.size() / size;
  for (std::size_t first = 0; first < count; first += values.size()) {
    const std::size_t now = std::min(values.size(), count - first);
    scene::convert_samples(samples.data() + first * size, grid.type, 1, false, static_cast<std::int64_t>(now),
                           reinterpret_cast<std::byte*>(values.data()), scene::SampleType::float64);
    for (const double sample : std::span(values).first(now)) {
      if (!std::isfinite(sample)) {
        ++blanks;
        continue;
      }
      const double value = grid.value(sample);
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
}

Blocks::Blocks(const GridIndex& samples, std::int64_t side) : samples_(samples), side_(side) {
  for (std::size_t a = 0; a < 3; ++a) count_[a] = (samples[a] + side - 1) / side;
}

SampleBox Blocks::box(const GridIndex& b) const {
  SampleBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = b[a] * side_;
    box.high[a] = std::min(samples_[a], box.low[a] + side_);
  }
  return box;
}

std::int64_t Blocks::first_sample(const GridIndex& b) const {
  const SampleBox own = box(b);
  return own.low[2] * samples_[1] * samples_[0] + own.extent(2) * own.low[1] * samples_[0] +
         own.extent(2) * own.extent(1) * own.low[0];
}

BrickLayout::BrickLayout(const scene::Grid& grid, int side, BrickWords words)
    : grid_(grid), side_(side), words_(std::move(words)), blocks_(grid.geometry.samples(), side) {
  // The header includes space for the longest possible ranges, because the ranges are known last.
  header_bytes_ = brick_header_of(grid_, side, words_, {}).size() + 3 * 32;
}

std::uint64_t BrickLayout::first_byte() const {
  return brick_magic.size() + sizeof header_bytes_ + header_bytes_ +
         static_cast<std::uint64_t>(blocks_.total()) * sizeof(BlockRange);
}

std::uint64_t BrickLayout::bytes() const {
  return first_byte() + static_cast<std::uint64_t>(grid_.geometry.all_samples().count()) * scene::size_of(grid_.type);
}

std::string BrickLayout::beginning(std::span<const BlockRange> ranges) const {
  scene::ValueRange whole;
  for (const BlockRange& range : ranges) {
    whole.low = std::min(whole.low, range.low);
    whole.high = std::max(whole.high, range.high);
    whole.blanks += range.blanks;
  }
  std::string header = brick_header_of(grid_, side_, words_, whole);
  header.resize(header_bytes_, ' ');
  std::string text(brick_magic);
  append_bytes(text, &header_bytes_, 1);
  text += header;
  append_bytes(text, ranges.data(), ranges.size());
  return text;
}

}  // namespace tessera::io
