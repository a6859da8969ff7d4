// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/brick_file.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cells/field_choice.hpp"
#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "io/text/json_text.hpp"
#include "io/text/text_file.hpp"
#include "io/volume/brick_layout.hpp"
#include "io/volume/volume_formats.hpp"
#include "scene/error.hpp"
#include "scene/number_type.hpp"
#include "system/atomic_file.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

using BrickJson = nlohmann::json;
using scene::GridIndex;
using scene::SampleBox;

constexpr std::uint64_t longest_brick_header = 1 << 28;  // the header contains the coordinates of rectilinear grids

class BrickSource final : public scene::SampleSource {
 public:
  BrickSource(scene::Grid grid, const std::filesystem::path& file, const std::string& name, std::int64_t side,
              scene::ValueRange whole, std::vector<BlockRange> ranges, std::uint64_t first_byte)
      : SampleSource(std::move(grid), name.empty() ? file.string() : name),
        file_(file, name),
        side_(side),
        blocks_(geometry().samples(), side),
        whole_(whole),
        ranges_(std::move(ranges)),
        first_byte_(first_byte) {}

  [[nodiscard]] std::optional<scene::ValueRange> known_range(const SampleBox& box) const override {
    if (box == geometry().all_samples()) return whole_;
    scene::ValueRange range;
    each_block(box, [&](const GridIndex& b) {
      const BlockRange& r = ranges_[static_cast<std::size_t>(blocks_.number(b))];
      range.low = std::min(range.low, r.low);
      range.high = std::max(range.high, r.high);
      range.blanks += r.blanks;
    });
    return range;
  }
  [[nodiscard]] GridIndex storage_block() const override { return {side_, side_, side_}; }
  [[nodiscard]] std::uint64_t bytes_read() const override { return bytes_read_.load(std::memory_order_relaxed); }

 private:
  template <class Visit>
  void each_block(const SampleBox& box, const Visit& visit) const {
    if (box.count() == 0) return;
    const auto last = [&](std::size_t a) { return (box.high[a] - 1) / side_; };
    for (std::int64_t k = box.low[2] / side_; k <= last(2); ++k)
      for (std::int64_t j = box.low[1] / side_; j <= last(1); ++j)
        for (std::int64_t i = box.low[0] / side_; i <= last(0); ++i) visit(GridIndex{i, j, k});
  }

  void read_samples(const SampleBox& box, const scene::SampleLayout& layout, std::byte* destination) const override {
    std::vector<std::byte> scratch;
    each_block(box, [&](const GridIndex& b) {
      const SampleBox block = blocks_.box(b);
      SampleBox part;
      for (std::size_t a = 0; a < 3; ++a) {
        part.low[a] = std::max(box.low[a], block.low[a]);
        part.high[a] = std::min(box.high[a], block.high[a]);
      }
      read_part(b, block, part, box, layout, scratch, destination);
    });
  }

  /// Reads the bytes from the first to the last requested sample of each slice; reads all slices at once if that needs
  /// hardly more bytes.
  void read_part(const GridIndex& b, const SampleBox& block, const SampleBox& part, const SampleBox& box,
                 const scene::SampleLayout& layout, std::vector<std::byte>& scratch, std::byte* destination) const {
    const std::size_t size = scene::size_of(grid().type), to_size = scene::size_of(layout.type);
    const std::int64_t row = block.extent(0), slice = row * block.extent(1);
    const auto in_block = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      return (k - block.low[2]) * slice + (j - block.low[1]) * row + i - block.low[0];
    };
    const std::int64_t slice_span = (part.extent(1) - 1) * row + part.extent(0);
    const bool together = 4 * slice_span >= slice;
    const std::int64_t at_once = together ? part.extent(2) : 1;
    const std::int64_t span = (at_once - 1) * slice + slice_span;
    scratch.resize(static_cast<std::size_t>(span) * size);
    for (std::int64_t k = part.low[2]; k < part.high[2]; k += at_once) {
      const std::int64_t first = in_block(part.low[0], part.low[1], k);
      file_.read(first_byte_ + static_cast<std::uint64_t>(blocks_.first_sample(b) + first) * size, scratch.data(),
                 scratch.size());
      bytes_read_.fetch_add(scratch.size(), std::memory_order_relaxed);
      for (std::int64_t kk = k; kk < k + at_once; ++kk)
        for (std::int64_t j = part.low[1]; j < part.high[1]; ++j) {
          const std::int64_t from = in_block(part.low[0], j, kk) - first;
          const std::int64_t to =
              (kk - box.low[2]) * layout.slice_pitch + (j - box.low[1]) * layout.row_pitch + part.low[0] - box.low[0];
          scene::convert_samples(scratch.data() + static_cast<std::size_t>(from) * size, grid().type, 1, false,
                                 part.extent(0), destination + static_cast<std::size_t>(to) * to_size, layout.type);
        }
    }
  }

  system::PositionalFile file_;
  std::int64_t side_;
  Blocks blocks_;
  scene::ValueRange whole_;
  std::vector<BlockRange> ranges_;
  std::uint64_t first_byte_;
  mutable std::atomic<std::uint64_t> bytes_read_ = 0;
};

/// Returns an integer that is stored as an integer, not as 1e38, which does not fit into any integer type. Throws
/// BrickJson's exception for anything else.
std::int64_t whole_number(const BrickJson& json) {
  return json.is_number_integer() ? json.get<std::int64_t>() : json.get_ref<const std::int64_t&>();
}

glm::dvec3 vector_of_json(const BrickJson& json) { return {json.at(0), json.at(1), json.at(2)}; }

struct BrickHeader {
  scene::Grid grid;
  std::int64_t side = 0;
  scene::ValueRange range;
  BodyAxes axes = BodyAxes::none;
  VolumeTags tags{};
};

BrickHeader parse_brick_header(const std::string& text, const std::filesystem::path& file) {
  BrickHeader header;
  try {
    const BrickJson json = parse_json(text, file.string());
    scene::GridGeometry& g = header.grid.geometry;
    for (std::size_t axis = 0; axis < 3; ++axis) g.points[axis] = whole_number(json.at("points").at(axis));
    if (json.at("association") == "cell") g.association = scene::Association::cell;
    g.origin = vector_of_json(json.at("origin"));
    g.spacing = vector_of_json(json.at("spacing"));
    const BrickJson& direction = json.at("direction");
    for (std::size_t k = 0; k < 9; ++k) g.direction[static_cast<int>(k / 3)][static_cast<int>(k % 3)] = direction.at(k);
    g.coordinates = json.at("coordinates").get<std::array<std::vector<double>, 3>>();
    const auto type = parse_sample_type(json.at("type").get<std::string>());
    if (!type) throw damaged(file, fmt::format("its type is {}", quote(json.at("type").get<std::string>())));
    header.grid.type = *type;
    header.grid.scale = json.at("scale");
    header.grid.shift = json.at("shift");
    header.grid.field_name = json.at("field");
    header.side = whole_number(json.at("block"));
    header.range = {json.at("low"), json.at("high"), static_cast<std::uint64_t>(whole_number(json.at("blanks")))};
    for (const auto& [name, word] : json.items())
      if (word.is_string()) take_word(name, word.get<std::string>(), header.axes, header.tags);
  } catch (const BrickJson::exception&) {
    throw damaged(file, "its header lacks a keyword or a number");
  }
  if (header.side < least_side || header.side > most_side)
    throw damaged(file, fmt::format("its blocks have {} samples per side, which is not supported", header.side));
  return header;
}

}  // namespace

VolumeFile open_bricks(const std::filesystem::path& file, const ReadOptions& options, const std::string& name) {
  const system::PositionalFile opened = open_input(file);
  const std::uint64_t size = opened.size();
  std::uint64_t length = 0;
  const std::uint64_t before = brick_magic.size() + sizeof length;
  if (size < before) throw damaged(file, "its header is cut off");
  opened.read(brick_magic.size(), reinterpret_cast<std::byte*>(&length), sizeof length);
  if (length > longest_brick_header || length > size - before) throw damaged(file, "its header is cut off");
  std::string text(length, '\0');
  opened.read(before, reinterpret_cast<std::byte*>(text.data()), length);
  BrickHeader header = parse_brick_header(text, file);
  scene::validate(header.grid, file.string());
  const Blocks blocks(header.grid.geometry.samples(), header.side);
  const auto count = static_cast<std::uint64_t>(blocks.total());
  const auto samples = static_cast<std::uint64_t>(header.grid.geometry.all_samples().count());
  const std::uint64_t left = size - before - length;  // validate() keeps the products below 2^63
  if (count > left / sizeof(BlockRange) ||
      left - count * sizeof(BlockRange) != samples * scene::size_of(header.grid.type))
    throw damaged(file, fmt::format("{} samples in {} blocks do not match its {} bytes", samples, count, size));
  std::vector<BlockRange> ranges(count);
  opened.read(before + length, reinterpret_cast<std::byte*>(ranges.data()), count * sizeof(BlockRange));

  VolumeFile result;
  result.format = fmt::format("brick file, blocks of {}^3", header.side);
  cells::FieldSummary field{.name = header.grid.field_name,
                            .association = header.grid.geometry.association,
                            .type = scene::listed_name(scene::number_type_of(header.grid.type))};
  field.low = header.range.empty() ? 0 : header.range.low;
  field.high = header.range.empty() ? 0 : header.range.high;
  field.nan_count = header.range.blanks;
  result.fields.push_back(field);
  result.body_axes = header.axes;
  result.tags = std::move(header.tags);
  cells::choose_field(options.field, result.fields, file.string());  // throws if another field is requested
  result.in_memory = is_inflated(file);
  result.source = std::make_unique<BrickSource>(std::move(header.grid), file, name, header.side, header.range,
                                                std::move(ranges), before + length + count * sizeof(BlockRange));
  return result;
}

VolumeFile open_brick_file(const InputFile& file, const VolumeOptions& options) {
  require_recognized(file);
  require_no_time_step(options.time_step, file.name);
  return with_tag_note(open_bricks(file.path, options, file.name));
}

namespace {

/// Writes a brick file from a source. Reads the source once, one row of blocks at a time, and processes blocks on
/// several threads.
class BrickWriter {
 public:
  BrickWriter(const scene::SampleSource& source, int side, BrickWords words = {})
      : source_(source), grid_(source.grid()), layout_(grid_, side, std::move(words)) {}

  [[nodiscard]] std::uint64_t bytes() const { return layout_.bytes(); }

  template <class Out>
  void write(Out& out) {
    out.seek(layout_.first_byte());
    const GridIndex& count = layout_.blocks().count();
    std::vector<BlockRange> ranges(static_cast<std::size_t>(layout_.blocks().total()));
    std::vector<std::vector<std::byte>> row(static_cast<std::size_t>(count[0]));
    for (std::int64_t k = 0; k < count[2]; ++k)
      for (std::int64_t j = 0; j < count[1]; ++j) {
        tbb::parallel_for(std::int64_t{0}, count[0], [&](std::int64_t i) {
          const GridIndex b{i, j, k};
          ranges[static_cast<std::size_t>(layout_.blocks().number(b))] = read(b, row[static_cast<std::size_t>(i)]);
        });
        for (const std::vector<std::byte>& samples : row) out.write(samples.data(), samples.size());
      }
    const std::string beginning = layout_.beginning(ranges);
    out.seek(0);
    out.write(beginning);
  }

 private:
  BlockRange read(const GridIndex& b, std::vector<std::byte>& samples) const {
    const SampleBox box = layout_.blocks().box(b);
    samples.resize(static_cast<std::size_t>(box.count()) * scene::size_of(grid_.type));
    source_.read(box, {.type = grid_.type}, samples);
    BlockRange range;
    range.add(grid_, samples);
    return range;
  }

  const scene::SampleSource& source_;
  const scene::Grid& grid_;
  BrickLayout layout_;
};

}  // namespace

void write_bricks(const scene::SampleSource& source, const std::filesystem::path& file, int side, BodyAxes axes,
                  const VolumeTags& tags) {
  if (side < least_side || side > most_side)
    throw scene::bad_input(
        fmt::format("`block`: a block cannot have {} samples per side; give {} to {}", side, least_side, most_side));
  BrickWriter writer(source, side, tag_words(axes, tags));
  system::AtomicFile out(file);
  writer.write(out);
  out.commit();
}

std::unique_ptr<system::ScratchFile> scratch_bricks(const scene::SampleSource& source, const std::string& subject) {
  BrickWriter writer(source, 64);
  auto out = std::make_unique<system::ScratchFile>(subject, writer.bytes());
  writer.write(*out);
  return out;
}

bool unpacked_to_scratch(const StreamedSamples& samples, const VolumeOptions& options, const std::string& source,
                         VolumeFile& volume) {
  const std::uint64_t bytes = bytes_of(samples);
  if (bytes <= options.most_in_memory() || (!options.scratch_is_needed && !system::ScratchFile::has_room(bytes)))
    return false;
  volume.scratch = scratch_bricks(samples, source);
  volume.source = open_bricks(volume.scratch->path(), {}, source).source;
  volume.in_memory = false;
  return true;
}

}  // namespace tessera::io
