// SPDX-License-Identifier: BSD-3-Clause
// The first bytes of an HDF5 file do not identify its contents.
#include <fmt/format.h>
#include <vtk_netcdf.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/hdf5_references.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"
#include "readers/vtk/hdf5/hdf5_grid.hpp"
#include "readers/vtk/hdf5/vtk_hdf_mesh.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Whether a file is read as NetCDF: it is NetCDF-4, or another HDF5 file with dimension scales, which NetCDF's library
/// treats as NetCDF.
bool is_netcdf(const Hdf5File& opened, const std::filesystem::path& file) {
  const std::vector<Hdf5Array> arrays = opened.arrays();
  const bool is_written_by_netcdf = opened.has_attribute("_NCProperties") || opened.has_attribute("_nc3_strict");
  if (!is_written_by_netcdf &&
      std::none_of(arrays.begin(), arrays.end(), [&](const Hdf5Array& array) { return opened.has_scales(array); }))
    return false;
  int id = 0;
  if (nc_open(file.c_str(), NC_NOWRITE, &id) != NC_NOERR) return false;
  nc_close(id);
  // Reading as NetCDF is preferred, because its dimensions have a meaning, such as time, while those of other arrays do
  // not.
  return is_written_by_netcdf || holds_netcdf_grid(file) || !holds_arrays(opened);
}

/// Whether the type is that of a mesh. Files without a type are of the first version, which has only meshes.
bool is_mesh_type(const std::string& vtk_type) { return vtk_type.empty() || vtk_type == "UnstructuredGrid"; }

}  // namespace

io::ForeignContents read_hdf5(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  io::require_real_name(file);
  allow_for(file);
  std::string vtk_type;
  enum class Kind { unknown, netcdf, vtk, vtk_image, cgns, exodus, flash, fluent, minc, med } kind = Kind::unknown;
  {
    const Hdf5File opened(file);
    if (!opened.is_open())
      throw scene::bad_input(fmt::format(
          "{}: it begins like an HDF5 file, but cannot be opened; it is truncated or damaged, write it again",
          file.string()));
    require_sound_references(file, ReferencesMay::point_below);
    if (opened.has("VTKHDF")) {
      vtk_type = opened.text_of("VTKHDF", "Type");
      kind = vtk_type == "ImageData" ? Kind::vtk_image : Kind::vtk;
    } else if (opened.has("CGNSLibraryVersion"))
      kind = Kind::cgns;
    else if (opened.has_attribute("floating_point_word_size") || opened.has("num_nodes"))
      kind = Kind::exodus;
    else if (opened.has("gid") && opened.has("refine level") && opened.has("bounding box"))
      kind = Kind::flash;
    else if (opened.has("meshes") && opened.has("settings"))
      kind = Kind::fluent;
    else if (opened.has("minc-2.0"))
      kind = Kind::minc;
    else if (opened.has("ENS_MAA"))
      kind = Kind::med;
    else if (is_netcdf(opened, file))
      kind = Kind::netcdf;
    const bool is_first_share = request.value("part", 0) == 0, is_look = request.value("look", false);
    if (kind == Kind::vtk && is_mesh_type(vtk_type) && is_first_share && !is_look)
      return read_vtk_hdf_mesh(holdings, opened, file.string(), request);
    if (kind == Kind::vtk_image) return read_vtk_hdf_image(holdings, opened, file.string(), request);
    if (kind == Kind::unknown) return read_arrays(holdings, opened, file.string(), request);
  }
  const auto refuse = [&](const char* what, const char* remedy) {
    return scene::bad_input(fmt::format("{}: it is an HDF5 file that contains {}; {}", file.string(), what, remedy));
  };
  if (request.value("look", false) && kind != Kind::netcdf && kind != Kind::minc) return {};  // the file is not a grid
  if (kind != Kind::cgns && request.value("part", 0) > 0)
    return {};  // the first share is the whole file; other shares are empty
  switch (kind) {
    case Kind::vtk:
      throw refuse(
          fmt::format("VTKHDF of the type {}; only UnstructuredGrid and ImageData are read", quote(vtk_type)).c_str(),
          "save it as .vtu, .vtm, .vth or .vtp in ParaView");
    case Kind::cgns:
      if (!io::read_beginning(file, 8).starts_with("\x89HDF"))
        throw refuse("CGNS after a user block, which the CGNS library cannot open",
                     "remove the block with HDF5's tools: h5unjam -i FILE -u BLOCK -o OUT.cgns");
      return read_cgns(holdings, file, request);
    case Kind::exodus:
      return read_exodus(holdings, file, request);
    case Kind::flash:
      return read_flash(holdings, file, request);
    case Kind::fluent:
      throw refuse("a Fluent case, which is supported only as text", "export CGNS, EnSight or a .cas without HDF5");
    case Kind::minc:
      return read_minc2(holdings, file, request);
    case Kind::med:
      throw refuse("a MED mesh, which is recognized by its name only", "rename it to end in .med");
    case Kind::netcdf:
    case Kind::vtk_image:
    case Kind::unknown:
      break;
  }
  return read_netcdf(holdings, file, request);
}

}  // namespace tessera::readers
