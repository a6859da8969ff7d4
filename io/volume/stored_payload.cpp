// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/stored_payload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "io/volume/stored_samples.hpp"
#include "system/gzip.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

/// Returns the number of bytes of one step. Checks that neither this number nor the size of all steps overflows for a
/// damaged header.
std::uint64_t bytes_needed(const StoredVolume& volume, const std::string& source) {
  std::uint64_t needed = scene::size_of(volume.number) * static_cast<std::uint64_t>(volume.components);
  std::uint64_t all = 0;
  bool is_too_large = false;
  for (const std::int64_t n : volume.grid.geometry.samples())
    is_too_large = is_too_large || __builtin_mul_overflow(needed, static_cast<std::uint64_t>(n), &needed);
  is_too_large = is_too_large || __builtin_mul_overflow(needed, volume.steps, &all) || all > (1ull << 62);
  if (is_too_large)
    throw scene::bad_input(fmt::format(
        "{}: its header states more samples than can be addressed; the file is damaged, write it again", source));
  return needed;
}

std::uint64_t size_of_payload(const StoredVolume& volume, const std::filesystem::path& file) {
  return volume.payload_size > 0 ? volume.payload_size : require_file(file);
}

/// The requested part of a file of samples: bytes [first, first + count) of its `all` bytes.
struct Wanted {
  std::uint64_t first, count, all;
};

/// Returns the error for a file that is too small.
scene::Error too_few(const StoredVolume& volume, const Wanted& wanted, std::uint64_t has, const std::string& source) {
  const scene::GridIndex n = volume.grid.geometry.samples();
  const std::string after = volume.offset > 0 ? fmt::format(" after its first {}", volume.offset) : "";
  if (!volume.slices.empty())
    return scene::bad_input(fmt::format(
        "{}: its part of the samples is {} bytes, but the file has {}{}; the file is truncated, write it again", source,
        wanted.all, has, after));
  const std::uint64_t needed = wanted.first + wanted.count;
  const std::string remedy =
      !volume.exact_size ? "the file is truncated, write it again"
      : has > needed     ? fmt::format("give the right dimensions and type, or `skip` {} if a header is before them",
                                       volume.offset + has - needed)
                         : "give the right dimensions and type";
  return scene::bad_input(fmt::format("{}: {}x{}x{} samples of {} {}{} are {} bytes, but the file has {}{}; {}", source,
                                      n[0], n[1], n[2], volume.components, scene::name_of(volume.number),
                                      volume.steps > 1 ? fmt::format(", of {} steps,", volume.steps) : "", needed, has,
                                      after, remedy));
}

/// Returns the range to unpack of a compressed volume's file.
system::InflatedRange range_of(const StoredVolume& volume, const std::filesystem::path& file, const Wanted& wanted,
                               std::uint64_t size) {
  const std::uint64_t skip = volume.compressed_whole ? 0 : volume.offset;
  const std::uint64_t before = (volume.compressed_whole ? volume.offset : 0) + volume.skip_inflated;
  if (skip > size) throw damaged(file, fmt::format("its samples begin at byte {} of {}", skip, size));
  return {skip, before + wanted.first, wanted.count};
}

/// Returns the range of one step's bytes; with interleaved steps, that of all steps.
Wanted wanted_of(const StoredVolume& volume, std::size_t step, const std::string& source) {
  const std::uint64_t needed = bytes_needed(volume, source), all = needed * volume.steps;
  return volume.interleaved_steps ? Wanted{0, all, all} : Wanted{step * needed, needed, all};
}

VolumePayload kept(std::vector<std::byte> unpacked, std::uint64_t before) {
  auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(unpacked));
  const auto wanted = std::span<const std::byte>(*bytes).subspan(before);
  return {wanted, bytes, {}, wanted.size()};
}

VolumePayload payload_of_file(const StoredVolume& volume, const std::filesystem::path& file, const Wanted& wanted) {
  const std::string source = file.string();
  const std::uint64_t size = size_of_payload(volume, file), end = wanted.first + wanted.count;
  if (volume.compressed) {
    std::vector<std::byte> bytes;
    system::inflate_parts(file, range_of(volume, file, wanted, size), source, [&](std::span<const std::byte> part) {
      if (bytes.empty()) bytes.reserve(wanted.count);  // the count has been checked against the compressed size
      bytes.insert(bytes.end(), part.begin(), part.end());
    });
    return kept(std::move(bytes), 0);
  }
  if (volume.vtk_array) {
    std::vector<std::byte> bytes;
    bytes.reserve(wanted.count);
    read_vtk_array(file, *volume.vtk_array, wanted.count, source,
                   [&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return kept(std::move(bytes), 0);
  }
  if (volume.coding != StoredVolume::Coding::binary) {
    if (volume.offset > size)
      throw damaged(file, fmt::format("its samples begin at byte {} of {}", volume.offset, size));
    const WholeFile whole(file);
    const std::string_view text = whole.text().substr(std::min<std::uint64_t>(volume.offset, whole.text().size()));
    return kept(volume.coding == StoredVolume::Coding::hex
                    ? bytes_of_hex(text, end, source)
                    : samples_of_text(text, end / scene::size_of(volume.number), volume.number, source),
                wanted.first);
  }
  const auto payload_from = [&](std::uint64_t first_byte) {
    return VolumePayload{{}, nullptr, {{file, first_byte}}, wanted.count};
  };
  if (volume.at_end && wanted.all <= size) return payload_from(size - wanted.all + wanted.first);
  if (volume.offset > size || end > size - volume.offset || (volume.exact_size && end != size - volume.offset))
    throw too_few(volume, wanted, size > volume.offset ? size - volume.offset : 0, source);
  return payload_from(volume.offset + wanted.first);
}

/// Concatenates files with equal shares of the payload.
VolumePayload payload_of_slices(const StoredVolume& volume, const Wanted& wanted, const std::string& source) {
  const std::uint64_t files = volume.slices.size();
  if (wanted.all % files != 0)
    throw scene::bad_input(
        fmt::format("{}: it lists {} files for {} bytes of samples, which are not equal parts; list all its slices",
                    source, files, wanted.all));
  const std::uint64_t part = wanted.all / files;
  auto bytes = std::make_shared<std::vector<std::byte>>();
  for (std::uint64_t k = wanted.first / part; k * part < wanted.first + wanted.count; ++k) {
    const std::uint64_t first = std::max(wanted.first, k * part) - k * part;
    const std::uint64_t last = std::min(wanted.first + wanted.count, (k + 1) * part) - k * part;
    VolumePayload slice = payload_of_file(volume, volume.slices[k], {first, last - first, part});
    // Reserves all memory only if the files are known to contain the samples; text and gzip files are checked while
    // they are read.
    if (k * part <= wanted.first && slice.in_file) bytes->reserve(std::min(wanted.count, files * part));
    slice = in_memory(std::move(slice), volume.slices[k].string());
    bytes->insert(bytes->end(), slice.bytes.begin(), slice.bytes.end());
  }
  return {std::span<const std::byte>(*bytes), bytes, {}, bytes->size()};
}

}  // namespace

VolumePayload in_memory(VolumePayload payload, const std::string& source) {
  if (!payload.in_file) return payload;
  std::vector<std::byte> bytes(payload.count);
  system::PositionalFile(payload.in_file->file, source).read(payload.in_file->first_byte, bytes.data(), bytes.size());
  return kept(std::move(bytes), 0);
}

VolumePayload payload_of(const StoredVolume& volume, std::size_t step, const std::string& source) {
  const Wanted wanted = wanted_of(volume, step, source);
  return volume.slices.empty() ? payload_of_file(volume, volume.payload, wanted)
                               : payload_of_slices(volume, wanted, source);
}

std::uint64_t payload_bytes(const StoredVolume& volume, const std::string& source) {
  return bytes_needed(volume, source) * volume.steps;
}

bool comes_in_parts(const StoredVolume& volume) {
  const bool as_it_comes = volume.coding == StoredVolume::Coding::binary && volume.wide == StoredVolume::Wide::no &&
                           (!volume.planar || volume.components == 1);
  return as_it_comes && volume.slices.empty() && (volume.compressed || volume.vtk_array);
}

void unpack_payload(const StoredVolume& volume, std::size_t step, const std::string& source,
                    const system::ByteSink& use) {
  const Wanted wanted = wanted_of(volume, step, source);
  if (volume.vtk_array) return read_vtk_array(volume.payload, *volume.vtk_array, wanted.count, source, use);
  const std::uint64_t size = size_of_payload(volume, volume.payload);
  system::inflate_parts(volume.payload, range_of(volume, volume.payload, wanted, size), volume.payload.string(), use);
}

VolumePayload interleaved(const StoredVolume& volume, const VolumePayload& planar) {
  const std::size_t width = scene::size_of(volume.number), components = static_cast<std::size_t>(volume.components);
  const std::size_t plane = planar.bytes.size() / components, samples = plane / width;
  auto bytes = std::make_shared<std::vector<std::byte>>(planar.bytes.size());
  for (std::size_t k = 0; k < samples; ++k)
    for (std::size_t c = 0; c < components; ++c)
      std::memcpy(bytes->data() + (k * components + c) * width, planar.bytes.data() + c * plane + k * width, width);
  return {std::span<const std::byte>(*bytes), bytes, {}, bytes->size()};
}

}  // namespace tessera::io
