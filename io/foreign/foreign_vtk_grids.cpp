// SPDX-License-Identifier: BSD-3-Clause
// Regular and rectilinear grids in VTK's formats.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "io/files/file_beginnings.hpp"
#include "io/files/inflated_file.hpp"
#include "io/foreign/foreign_formats.hpp"
#include "io/foreign/foreign_grids.hpp"
#include "io/text/clean_errors.hpp"
#include "io/volume/plain_vtk_grid.hpp"
#include "io/volume/volume_formats.hpp"
#include "io/vtk/vtk_field_words.hpp"
#include "io/vtk/vtk_xml_file.hpp"

namespace tessera::io {
namespace {

/// Reads the whole grid into memory.
VolumeFile read_vtk_grid(const InputFile& file, const VolumeOptions& options) {
  const std::string type = vtk_xml_type(file.beginning);  // empty for a legacy file
  if (type.starts_with('P')) require_uncompressed(file.path);
  std::optional<ForeignFile> opened;
  if (type == "ImageData" || type == "RectilinearGrid") opened = open_vtk_xml(file.path, options.progress);
  if (!opened) {
    nlohmann::json request{{"reader", type.empty() ? "vtk_legacy" : "vtk_xml"}};
    if (!type.empty()) request["type"] = type;
    opened = open_foreign(file, std::move(request), options.progress);
  }
  VolumeFile result = grid_of(*opened, options);
  result.format = fmt::format("{} ({})", type.empty() ? "legacy VTK" : "VTK XML",
                              result.source->geometry().rectilinear() ? "rectilinear grid" : "image data");
  return result;
}

}  // namespace

VolumeFile open_vtk_grid(const InputFile& file, const VolumeOptions& options) {
  require_recognized(file);
  require_no_time_step(options.time_step, file.name);
  auto plain = read_plain_vtk_grid(file.path, options.most_in_memory());
  VolumeFile volume = plain ? open_stored(*std::move(plain), options, file.name) : read_vtk_grid(file, options);
  for (const auto& [name, word] : vtk_field_words(file.beginning)) take_word(name, word, volume.body_axes, volume.tags);
  return with_tag_note(std::move(volume));
}

}  // namespace tessera::io
