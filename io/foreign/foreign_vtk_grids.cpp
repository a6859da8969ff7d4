// SPDX-License-Identifier: BSD-3-Clause
// Regular and rectilinear grids in VTK's formats.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "io/foreign/foreign_grids.hpp"
#include "io/foreign/foreign_mixed.hpp"
#include "io/formats/file_beginnings.hpp"
#include "io/formats/inflated_file.hpp"
#include "io/formats/input_file.hpp"
#include "io/volume/volume_formats.hpp"
#include "io/vtk/vtk_xml_file.hpp"

namespace tessera::io {

VolumeFile read_vtk_grid(const std::filesystem::path& file, const VolumeOptions& options) {
  const std::string type = vtk_xml_type(read_beginning(file, 4096));  // empty of a legacy one
  if (type.starts_with('P')) require_beside_others(file);
  nlohmann::json request{{"reader", type.empty() ? "vtk_legacy" : "vtk_xml"}};
  if (!type.empty()) request["type"] = type;
  std::optional<ForeignFile> opened;
  if (type == "ImageData" || type == "RectilinearGrid") opened = open_vtk_xml(file, options.progress);
  if (!opened) {
    HelperTask task;
    task.progress = options.progress;
    opened = open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request));
  }
  VolumeFile result = grid_of(*opened, options);
  result.format = fmt::format("{} ({})", type.empty() ? "legacy VTK" : "VTK XML",
                              result.source->geometry().rectilinear() ? "rectilinear grid" : "image data");
  return result;
}

bool holds_grid_by_vtk(const std::filesystem::path& file, const char* reader) { return holds_one_grid(file, {reader}); }

VolumeFile read_by_vtk(const std::filesystem::path& file, const char* reader, const VolumeOptions& options) {
  return read_foreign_volume(file, {reader}, options);
}

}  // namespace tessera::io
