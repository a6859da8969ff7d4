// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/foreign_mixed.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/foreign/foreign_grids.hpp"
#include "io/formats/inflated_file.hpp"
#include "io/formats/input_file.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

ForeignFile open_by(const ForeignReader& by, const std::filesystem::path& file, nlohmann::json request,
                    const ReadProgressFunction& progress = {}) {
  request["reader"] = by.reader;
  HelperTask task = by.task;
  task.progress = progress;
  return open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request));
}

}  // namespace

bool holds_one_grid(const std::filesystem::path& file, const ForeignReader& by) {
  const auto look = [&](const std::filesystem::path& content) {
    const auto& parts = open_by(by, content, {{"look", true}}).contents.parts;
    return parts.size() == 1 &&
           (parts[0].kind == ForeignPart::Kind::image || parts[0].kind == ForeignPart::Kind::rectilinear);
  };
  try {
    if (system::looks_like_gzip(read_beginning(file, 2)))
      return InflatedFile(file, InflatedFile::Holds::grid).read(look);
    return look(file);
  } catch (const scene::Error&) {
    return false;
  }
}

VolumeFile read_foreign_volume(const std::filesystem::path& file, const ForeignReader& by,
                               const VolumeOptions& options) {
  VolumeOptions asked = options;
  if (asked.field.starts_with('/')) asked.field.erase(0, 1);  // a path, as HDF5's tools write it
  nlohmann::json request{{"field", asked.field}};
  if (asked.time_step) request["time_step"] = *asked.time_step;
  return grid_of(open_by(by, file, std::move(request), asked.progress), asked);
}

cells::MeshBlocks read_foreign_mesh(const std::filesystem::path& file, const ForeignReader& by,
                                    const cells::MeshOptions& options, GridsAre grids) {
  nlohmann::json request{{"blocks", options.blocks}, {"field", options.field}};
  if (options.time_step) request["time_step"] = *options.time_step;
  if (options.surfaces) request["surfaces"] = true;
  const ForeignFile opened = open_by(by, file, std::move(request), options.progress);
  cells::MeshBlocks result;
  result.format = opened.contents.format;
  result.notes = opened.contents.notes;
  result.time_step = opened.contents.time_step;
  result.beside_degrees = opened.contents.beside_degrees;
  result.block_names = opened.contents.block_names;
  result.surface_names = opened.contents.surface_names;
  result.blocks = blocks_of(opened, result.notes, grids);
  return result;
}

}  // namespace tessera::io
