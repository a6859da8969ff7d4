// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/foreign_formats.hpp"

#include <nlohmann/json.hpp>

#include "io/files/inflated_file.hpp"
#include "io/foreign/foreign_grids.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {
namespace {

ForeignFile open_by(const ForeignReader& by, const InputFile& file, nlohmann::json request,
                    const ReadProgressFunction& progress = {}) {
  request["reader"] = by.name;
  HelperTask task;
  task.reader = by.program;
  if (by.remedy != nullptr) task.remedy = by.remedy;
  return open_foreign(file, std::move(request), progress, std::move(task));
}

ForeignFile open_mesh_by(const ForeignReader& by, const InputFile& file, const MeshOptions& options) {
  nlohmann::json request{{"blocks", options.blocks}, {"field", options.field}};
  if (options.time_step) request["time_step"] = *options.time_step;
  if (options.surfaces) request["surfaces"] = true;
  return open_by(by, file, std::move(request), options.progress);
}

}  // namespace

bool holds_one_grid(const InputFile& file, const ForeignReader& by) {
  const auto look = [&](const InputFile& content) {
    const auto& parts = open_by(by, content, {{"look", true}}).contents.parts;
    return parts.size() == 1 &&
           (parts[0].kind == ForeignPart::Kind::image || parts[0].kind == ForeignPart::Kind::rectilinear);
  };
  try {
    return file.is_gzip ? InflatedFile(file, InflatedFile::Holds::grid).read(look) : look(file);
  } catch (const scene::Error&) {
    return false;
  }
}

VolumeFile read_foreign_volume(const InputFile& file, const ForeignReader& by, const VolumeOptions& options) {
  if (by.program != Reader::dicom) require_recognized(file);
  VolumeOptions asked = options;
  if (asked.field.starts_with('/')) asked.field.erase(0, 1);  // the field is a path, as HDF5's tools print it
  nlohmann::json request{{"field", asked.field}};
  if (asked.time_step) request["time_step"] = *asked.time_step;
  return grid_of(open_by(by, file, std::move(request), asked.progress), asked);
}

cells::MeshBlocks read_foreign_mesh(const InputFile& file, const ForeignReader& by, const MeshOptions& options) {
  return mesh_of(open_mesh_by(by, file, options), GridsAre::hexahedra);
}

scene::TimeStepRead foreign_time_steps(const InputFile& file, const ForeignReader& by, const MeshOptions& options) {
  return open_mesh_by(by, file, options).contents.time_step;
}

}  // namespace tessera::io
