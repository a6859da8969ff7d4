// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "cells/part_range.hpp"
#include "io/files/file_beginnings.hpp"
#include "io/files/inflated_file.hpp"
#include "io/foreign/client/foreign_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Removes and returns the digits after the last dot of a name.
std::optional<std::string> last_number(std::string& name) {
  const std::size_t point = name.rfind('.');
  if (point == std::string::npos || point == 0) return std::nullopt;
  const std::string digits = name.substr(point + 1);
  constexpr std::size_t most = 7;
  if (digits.empty() || digits.size() > most || digits.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  name.resize(point);
  return digits;
}

int number_in(const std::string& digits) {
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

/// Returns the helper's reader of a file that may be Exodus, according to the first bytes; null: the file is not
/// Exodus.
const char* exodus_reader(const FileBeginning& start) {
  return begins_as_exodus(start) ? "exodus" : begins_as_hdf5(start) ? "hdf5" : nullptr;
}

nlohmann::json request_for(const char* reader, const ReadOptions& options) {
  nlohmann::json request{{"reader", reader}, {"blocks", options.blocks}};
  if (options.time_step) request["time_step"] = *options.time_step;
  return request;
}

void add_blocks(const ForeignFile& opened, cells::MeshBlocks& blocks, const std::string& source) {
  cells::add_notes(opened.contents.notes, blocks.notes);
  cells::add_notes(opened.contents.block_names, blocks.block_names);
  cells::add_notes(opened.contents.surface_names, blocks.surface_names);
  blocks.time_step = opened.contents.time_step;
  for (cells::CellBlock& block : blocks_of(opened, blocks.notes, GridsAre::hexahedra)) {
    block.source = source;
    blocks.blocks.push_back(std::move(block));
  }
}

cells::MeshBlocks read_exodus_files(std::span<const std::filesystem::path> files, const Format* format,
                                    const ReadOptions& options, int part, int parts) {
  cells::MeshBlocks result;
  result.format = fmt::format("Exodus II in {} files", files.size());
  HelperTask task;
  task.progress = options.progress;
  task.format = format;
  const auto helper = std::make_shared<HelperProcess>(std::move(task));
  const std::uint64_t last = cells::first_of_part(files.size(), part + 1, parts);
  for (std::uint64_t k = cells::first_of_part(files.size(), part, parts); k < last; ++k) {
    const char* const reader = exodus_reader({read_beginning(files[k], 4096)});
    if (reader == nullptr)
      throw scene::bad_input(fmt::format(
          "{}: it states that it is one of {} Exodus files of a mesh, but is not an Exodus file; write the file again",
          files[k].string(), files.size()));
    add_blocks(open_foreign(helper, files[k], request_for(reader, options)), result, files[k].string());
  }
  return result;
}

}  // namespace

std::vector<std::filesystem::path> exodus_files(const InputFile& input) {
  const std::filesystem::path& file = input.path;
  std::string name = file.filename().string();
  const std::optional<std::string> number = last_number(name);
  const std::optional<std::string> count = number ? last_number(name) : std::nullopt;
  if (!count || name.empty() || number->size() < count->size()) return {};
  const int files = number_in(*count);
  if (files < 2 || number_in(*number) >= files || exodus_reader(input.start()) == nullptr) return {};
  std::vector<std::filesystem::path> all;
  for (int k = 0; k < files; ++k) {
    all.push_back(file.parent_path() / fmt::format("{}.{}.{:0{}}", name, *count, k, number->size()));
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(all.back(), unknown))
      throw scene::bad_input(
          fmt::format("{}: it is one of {} files of a mesh, and {} is missing; put the missing file next to this one, "
                      "or rename this one to see it alone",
                      file.string(), files, all.back().filename().string()));
  }
  return all;
}

bool has_shares(const InputFile& file) {
  if (file.format == nullptr) return false;
  if (file.format->share_reader == nullptr) return !exodus_files(file).empty();
  // Among HDF5 files, the name identifies CGNS.
  return file.format->container != Container::hdf5 || system::lower_extension(file.path) == ".cgns" ||
         !exodus_files(file).empty();
}

cells::MeshBlocks read_share(const InputFile& file, const ReadOptions& options, int part, int parts) {
  if (const auto files = exodus_files(file); !files.empty())
    return read_exodus_files(files, file.format, options, part, parts);
  require_uncompressed(file.path);
  nlohmann::json request = request_for(file.format->share_reader, options);
  request["part"] = part;
  request["parts"] = parts;
  const ForeignFile opened = open_foreign(file, std::move(request), options.progress);
  if (opened.contents.has_levels)
    throw scene::bad_input(fmt::format(
        "{}: it has the name of a CGNS file, but is a mesh of several levels; give it another name", file.name));
  cells::MeshBlocks result;
  result.format = opened.contents.format;
  add_blocks(opened, result, "");
  return result;
}

}  // namespace tessera::io
