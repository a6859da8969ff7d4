// SPDX-License-Identifier: BSD-3-Clause
#include "io/formats/file_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/formats/file_beginnings.hpp"
#include "io/formats/input_file.hpp"
#include "scene/error.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

constexpr const char* filled = "closed; filled with tets, field depth beside its own";
constexpr const char* pieces = "pieces fill the whole and have the same arrays";
constexpr auto unlisted = FormatRow::Listed::no;

/// A file is of the first row that it begins as; rows of one beginning are in the order in which they are asked.
constexpr std::array rows = {
    FormatRow{FileKind::vtk_xml, "VTK XML unstructured grid", ".vtu .pvtu", FileHolds::mesh, Needs::nothing,
              "pieces appended, ghost cells dropped; ranks read pieces", begins_as_vtu},
    FormatRow{FileKind::vtk_xml, "VTK XML curvilinear grid", ".vts .pvts", FileHolds::mesh, Needs::nothing, pieces,
              begins_as_vts},
    FormatRow{FileKind::vtk_xml, "VTK XML multi-block", ".vtm .vtmb .vtpc .vtpd", FileHolds::mesh, Needs::nothing,
              "all volumes among them; surfaces left out", begins_as_vtk_list},
    FormatRow{FileKind::amr, "VTK XML AMR", ".vth .vthb", FileHolds::mesh, Needs::vtk,
              "overlapping or not; finest cells; `smooth` continuous across levels", begins_as_vtk_amr, "amr_list"},
    FormatRow{FileKind::amr, "VTK XML HyperTreeGrid", ".htg .phtg", FileHolds::mesh, Needs::vtk,
              "three dimensions; masked cells left out; `smooth` continuous across levels", begins_as_hyper_trees,
              "hyper_trees"},
    FormatRow{FileKind::amr, "AMReX plot file", "", FileHolds::mesh, Needs::nothing,
              "its folder, or the Header in it; all levels, no particles", begins_as_amrex, "amrex"},
    FormatRow{FileKind::amr, "Enzo", ".hierarchy .boundary", FileHolds::mesh, Needs::vtk,
              "HDF5 files and parameters beside it; all levels, no particles", begins_as_enzo, "enzo"},
    FormatRow{FileKind::hdf5, "FLASH", "", FileHolds::mesh, Needs::vtk, "HDF5; all levels, no particles", nullptr},
    FormatRow{FileKind::vtk_legacy, "legacy VTK unstructured or curvilinear grid", ".vtk", FileHolds::mesh, Needs::vtk,
              "text or binary", begins_as_legacy_mesh},
    FormatRow{FileKind::exodus, "Exodus II", ".ex2 .exo .exii .e .g", FileHolds::mesh, Needs::vtk,
              "NetCDF or HDF5; all element blocks; nodes moved by displacements", begins_as_exodus, "", true},
    FormatRow{FileKind::solver, "OpenFOAM case", ".foam .openfoam", FileHolds::mesh, Needs::vtk,
              "the case's folder or a file in it; also decomposed; polyhedra", begins_as_openfoam, "openfoam", true},
    FormatRow{FileKind::solver, "EnSight 6 or Gold", ".case .encas .sos", FileHolds::mesh, Needs::vtk,
              "all parts, of .sos those of all its cases", begins_as_ensight, "ensight", true},
    FormatRow{FileKind::solver, "CGNS", ".cgns", FileHolds::mesh, Needs::vtk, "HDF5 or ADF", begins_as_adf, "cgns",
              true},
    FormatRow{FileKind::solver, "VTKHDF", ".vtkhdf", FileHolds::grid_or_mesh, Needs::vtk,
              "unstructured grids, and image data, which are volumes; time steps", nullptr, "vtk_hdf", true},
    FormatRow{FileKind::med, "MED", ".med .rmed", FileHolds::mesh, Needs::med,
              "Salome's, of version 2.3 and later; HDF5, by its name; fields of nodes and cells", nullptr, "med", true},
    FormatRow{FileKind::xdmf, "XDMF", ".xdmf .xmf", FileHolds::grid_or_mesh, Needs::xdmf,
              "one grid is a volume, others are meshes; HDF5, binary or inline numbers", begins_as_xdmf, "xdmf", true},
    FormatRow{FileKind::hdf5, "HDF5", "", FileHolds::grid_or_mesh, Needs::vtk, "", begins_as_hdf5, "", true, unlisted},
    FormatRow{FileKind::solver, "Fluent", ".cas", FileHolds::mesh, Needs::vtk,
              "text or binary, no HDF5; values from the .dat beside it", begins_as_fluent, "fluent", true},
    FormatRow{FileKind::solver, "GAMBIT", ".neu", FileHolds::mesh, Needs::vtk, "", begins_as_gambit, "gambit", true},
    FormatRow{FileKind::solver, "AVS UCD", ".inp .ucd", FileHolds::mesh, Needs::vtk, "text; binary by its name",
              begins_as_avs_ucd, "avs_ucd", true},
    FormatRow{FileKind::tecplot, "Tecplot", ".tec", FileHolds::mesh, Needs::nothing,
              "text; ordered zones, bricks, tetrahedra, polyhedra; solution times are steps", begins_as_tecplot, "",
              true},
    FormatRow{FileKind::gmsh, "Gmsh", ".msh", FileHolds::mesh, Needs::gmsh,
              "MSH 1 to 4.1, text or binary; views are fields, physical groups blocks", begins_as_gmsh, "gmsh", true},
    FormatRow{FileKind::medit_text, "Medit", ".mesh", FileHolds::mesh, Needs::nothing,
              "text, without .sol; references are blocks", begins_as_medit},
    FormatRow{FileKind::medit, "Medit binary", ".meshb", FileHolds::mesh, Needs::nothing,
              "versions 1 to 4, without .sol; references are blocks", begins_as_meshb},
    FormatRow{FileKind::gmsh, "I-DEAS universal", ".unv", FileHolds::mesh, Needs::gmsh, "meshes; by its name", nullptr,
              "by_gmsh"},
    FormatRow{FileKind::nastran, "Nastran bulk data", ".bdf .nas", FileHolds::mesh, Needs::nothing,
              "solid elements, a block a property; coordinate systems; INCLUDE", nullptr},
    FormatRow{FileKind::su2, "SU2", ".su2", FileHolds::mesh, Needs::nothing, "meshes of 3 dimensions; zones are blocks",
              begins_as_su2},
    FormatRow{FileKind::plot3d, "PLOT3D", ".xyz .p3d .x .bin", FileHolds::mesh, Needs::vtk,
              "text or binary; the solution beside it, or `q`; IBLANK 0 hides", nullptr},
    FormatRow{FileKind::plot3d_list, "PLOT3D list", "", FileHolds::mesh, Needs::vtk,
              "ParaView's, of grids and solutions by time", begins_as_plot3d_list, "", true},
    FormatRow{FileKind::tetgen_mesh, "TetGen mesh", ".node .ele", FileHolds::mesh, Needs::nothing,
              "either name finds the other", nullptr},
    FormatRow{FileKind::tets, "raw tetrahedra", ".tets", FileHolds::mesh, Needs::nothing,
              "bytes in docs/FORMATS.md; ranks read ranges", nullptr},
    FormatRow{FileKind::stl, "STL", ".stl", FileHolds::surface, Needs::vtk_and_tetgen, filled, begins_as_stl},
    FormatRow{FileKind::vtk_surface, "VTK surface", ".vtp", FileHolds::surface, Needs::vtk_and_tetgen, filled,
              begins_as_vtk_surface},
    FormatRow{FileKind::ply, "PLY", ".ply", FileHolds::surface, Needs::tetgen, filled, begins_as_ply},
    FormatRow{FileKind::tetgen_surface, "TetGen surface", ".poly .smesh", FileHolds::surface, Needs::tetgen, filled,
              nullptr},
    FormatRow{FileKind::vtk_grid, "VTK XML image data", ".vti .pvti", FileHolds::grid, Needs::nothing, pieces,
              begins_as_vti},
    FormatRow{FileKind::vtk_grid, "VTK XML rectilinear grid", ".vtr .pvtr", FileHolds::grid_or_mesh, Needs::nothing,
              pieces, begins_as_vtr},
    FormatRow{FileKind::vtk_grid, "legacy VTK structured points or rectilinear grid", ".vtk", FileHolds::grid_or_mesh,
              Needs::vtk, "text or binary", begins_as_legacy_grid},
    FormatRow{FileKind::netcdf, "NetCDF grid", ".nc .nc4 .cdf", FileHolds::grid_or_mesh, Needs::vtk,
              "CF conventions or plain; curvilinear ones are meshes; missing values blank", begins_as_netcdf, "netcdf",
              true},
    FormatRow{FileKind::minc, "MINC", ".mnc", FileHolds::grid, Needs::vtk, "MINC 1, and 2 in HDF5; time",
              begins_as_minc, "minc", true},
    FormatRow{FileKind::meta_image, "MetaImage", ".mhd .mha", FileHolds::grid, Needs::nothing,
              "raw, compressed or text; slices in files; time", begins_as_meta_image, "", true},
    FormatRow{FileKind::nrrd, "NRRD", ".nrrd .nhdr", FileHolds::grid, Needs::nothing,
              "raw, gzip, text or hex; slices in files; time", begins_as_nrrd, "", true},
    FormatRow{FileKind::nifti, "NIfTI", ".nii", FileHolds::grid, Needs::nothing,
              "NIfTI-1 and -2, also .hdr with .img; time", begins_as_nifti, "", true},
    FormatRow{FileKind::analyze, "Analyze 7.5", ".hdr .img", FileHolds::grid, Needs::nothing,
              "header and samples; either name finds the other", begins_as_analyze, "", true},
    FormatRow{FileKind::dicom, "DICOM", ".dcm .dicom .ima", FileHolds::grid, Needs::dicom,
              "a folder of slices, one of its files, or frames; time", begins_as_dicom, "", true},
    FormatRow{FileKind::bricks, "bricks", ".bricks", FileHolds::grid, Needs::nothing, "what convert writes",
              begins_as_brick_file},
    FormatRow{FileKind::raw, "raw samples", ".raw", FileHolds::grid, Needs::nothing,
              "described by `dims` and `type`, or NAME_WxHxD_TYPE.raw", nullptr},
    FormatRow{FileKind::pvd, "ParaView collection", ".pvd", FileHolds::series, Needs::nothing, "of any meshes or grids",
              begins_as_pvd},
    FormatRow{FileKind::pvd, "ParaView file series", ".series", FileHolds::series, Needs::nothing,
              "of any meshes or grids", begins_as_file_series},
    FormatRow{FileKind::unread, "Tecplot binary", ".plt .szplt", FileHolds::not_read, Needs::nothing,
              "its library is not free; write text, CGNS or .vtu", begins_as_binary_tecplot},
    FormatRow{FileKind::unread, "LS-DYNA input", ".k .key .dyn", FileHolds::not_read, Needs::nothing,
              "no library reads it; export Nastran .bdf from LS-PrePost", begins_as_ls_dyna},
    FormatRow{FileKind::unread, "LS-DYNA results", ".d3plot", FileHolds::not_read, Needs::nothing,
              "open d3plot in ParaView and save it as .vtm", begins_as_d3plot},
    FormatRow{FileKind::unread, "Abaqus or Ansys input", ".cdb", FileHolds::not_read, Needs::nothing,
              "VTK has no reader; convert it to .vtu with meshio", begins_as_abaqus},
    FormatRow{FileKind::unread, "Abaqus or Ansys results", ".odb .rst .rth", FileHolds::not_read, Needs::nothing,
              "their libraries are not free; export Exodus, EnSight or .vtu", nullptr},
    FormatRow{FileKind::unread, "CalculiX results", ".frd", FileHolds::not_read, Needs::nothing,
              "convert it to .vtu with ccx2paraview", begins_as_frd},
    FormatRow{FileKind::unread, "Nastran results", ".op2 .xdb .pch", FileHolds::not_read, Needs::nothing,
              "meshes are read as .bdf; save results as .vtu by pyNastran and meshio", nullptr},
    FormatRow{FileKind::unread, "HyperMesh or HyperView", ".h3d .hm .hmascii", FileHolds::not_read, Needs::nothing,
              "its format is not open; export Nastran .bdf or EnSight", nullptr},
    FormatRow{FileKind::unread, "STAR-CCM+", ".ccm .ccmg .ccmp .sim", FileHolds::not_read, Needs::nothing,
              "its library is not free; export EnSight or CGNS", nullptr},
    FormatRow{FileKind::unread, "Ansys CFX", ".res .def", FileHolds::not_read, Needs::nothing,
              "its library is not free; export CGNS or EnSight", nullptr},
    FormatRow{FileKind::unread, "Fluent HDF5", ".cas.h5 .dat.h5 .msh.h5", FileHolds::not_read, Needs::nothing,
              "export CGNS, EnSight or a .cas without HDF5", nullptr},
    FormatRow{FileKind::unread, "COMSOL mesh", ".mphbin .mphtxt", FileHolds::not_read, Needs::nothing,
              "export Nastran .nas or .vtu from COMSOL", nullptr},
    FormatRow{FileKind::unread, "MOAB", ".h5m", FileHolds::not_read, Needs::nothing,
              "convert it to .vtk with mbconvert", nullptr},
    FormatRow{FileKind::unread, "AFLR3", ".ugrid", FileHolds::not_read, Needs::nothing,
              "convert it to .vtu with meshio", nullptr},
    FormatRow{FileKind::unread, "FLAC3D", ".f3grid", FileHolds::not_read, Needs::nothing,
              "convert it to .vtu with meshio", nullptr},
    FormatRow{FileKind::unread, "Kratos", ".mdpa", FileHolds::not_read, Needs::nothing,
              "convert it to .vtu with meshio", nullptr},
    FormatRow{FileKind::unread, "Silo", ".silo", FileHolds::not_read, Needs::nothing,
              "save it as .vtm in ParaView or VisIt", nullptr},
    FormatRow{FileKind::unread, "STEP geometry", ".step .stp", FileHolds::not_read, Needs::nothing,
              "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", begins_as_step},
    FormatRow{FileKind::unread, "IGES geometry", ".iges .igs", FileHolds::not_read, Needs::nothing,
              "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", nullptr},
    FormatRow{FileKind::unread, "BREP geometry", ".brep", FileHolds::not_read, Needs::nothing,
              "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", begins_as_brep},
    FormatRow{FileKind::unread, "Gmsh geometry", ".geo", FileHolds::not_read, Needs::nothing,
              "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", nullptr},
    FormatRow{FileKind::unread, "Wavefront OBJ", ".obj", FileHolds::not_read, Needs::nothing,
              "a surface; convert it to .stl or .ply with meshio or MeshLab", nullptr},
    FormatRow{FileKind::unread, "OFF", ".off", FileHolds::not_read, Needs::nothing,
              "a surface; convert it to .stl or .ply with meshio or MeshLab", begins_as_off},
    FormatRow{FileKind::unread, "glTF", ".gltf .glb", FileHolds::not_read, Needs::nothing,
              "a surface; save it as .stl or .ply in Blender or MeshLab", begins_as_gltf},
    FormatRow{FileKind::unread, "3D scene", ".fbx .dae .3ds .blend .3mf .usd .usdc .usdz .abc", FileHolds::not_read,
              Needs::nothing, "a surface; save it as .stl or .ply in Blender", nullptr},
    FormatRow{FileKind::unread, "OpenVDB", ".vdb", FileHolds::not_read, Needs::nothing,
              "its library is not linked; save it as .vti in ParaView", begins_as_vdb},
    FormatRow{FileKind::unread, "NanoVDB", ".nvdb", FileHolds::not_read, Needs::nothing,
              "its library is not linked; save it as .vti from OpenVDB by ParaView", begins_as_nvdb},
    FormatRow{FileKind::unread, "Houdini geometry", ".bgeo .hip", FileHolds::not_read, Needs::nothing,
              "its format is not open; save volumes as .vdb, and these as .vti in ParaView", nullptr},
    FormatRow{FileKind::unread, "ADIOS2", ".bp", FileHolds::not_read, Needs::nothing,
              "open it in ParaView and save it as .vtm", nullptr},
    FormatRow{FileKind::unread, "Nek5000", ".nek5000", FileHolds::not_read, Needs::nothing,
              "VTK's reader is not packaged; save it as .vtu in ParaView", begins_as_nek5000},
    FormatRow{FileKind::unread, "MFEM", "", FileHolds::not_read, Needs::nothing,
              "its library is not packaged; have MFEM write .vtu", begins_as_mfem},
    FormatRow{FileKind::unread, "Netgen", ".vol", FileHolds::not_read, Needs::nothing,
              "VTK has no reader; convert it to .vtu with meshio", begins_as_netgen},
    FormatRow{FileKind::unread, "GRIB", ".grib .grb .grib2 .grb2", FileHolds::not_read, Needs::nothing,
              "convert it to NetCDF: cdo -f nc copy FILE out.nc", begins_as_grib},
    FormatRow{FileKind::unread, "HDF4", ".hdf .hdf4", FileHolds::not_read, Needs::nothing,
              "convert it to HDF5 with h4toh5, or to NetCDF with ncl_convert2nc", begins_as_hdf4},
    FormatRow{FileKind::unread, "FITS", ".fits .fit .fts", FileHolds::not_read, Needs::nothing,
              "save it as .nrrd by astropy and pynrrd", begins_as_fits},
    FormatRow{FileKind::unread, "FreeSurfer volume", ".mgz .mgh", FileHolds::not_read, Needs::nothing,
              "convert it: mri_convert FILE out.nii.gz", begins_as_freesurfer},
    FormatRow{FileKind::unread, "GIPL", ".gipl", FileHolds::not_read, Needs::nothing,
              "convert it: c3d FILE -o out.nii.gz", nullptr},
    FormatRow{FileKind::unread, "AFNI", ".brik .head", FileHolds::not_read, Needs::nothing,
              "convert it: 3dAFNItoNIFTI FILE", nullptr},
    FormatRow{FileKind::unread, "MRC or CCP4 map", ".mrc .map .ccp4 .rec", FileHolds::not_read, Needs::nothing,
              "rename it to .raw and describe it: `dims`, `type` and `skip` 1024", begins_as_mrc},
    FormatRow{FileKind::unread, "Amira", ".am", FileHolds::not_read, Needs::nothing, "save it as .nrrd in 3D Slicer",
              begins_as_amira},
    FormatRow{FileKind::unread, "TIFF stack", ".tif .tiff", FileHolds::not_read, Needs::nothing,
              "save it as .nrrd in Fiji", begins_as_tiff},
    FormatRow{FileKind::unread, "microscope volume", ".czi .lif .nd2 .ims .oib .lsm", FileHolds::not_read,
              Needs::nothing, "save it as .nrrd in Fiji", nullptr},
    FormatRow{FileKind::unread, "NumPy array", ".npy .npz", FileHolds::not_read, Needs::nothing,
              "write it as .raw by tofile, or .nrrd by pynrrd", begins_as_numpy},
    FormatRow{FileKind::unread, "MATLAB data", ".mat", FileHolds::not_read, Needs::nothing,
              "write it as .raw by fwrite, or .nrrd by nrrdWriter", nullptr},
    FormatRow{FileKind::unread, "Zarr", ".zarr", FileHolds::not_read, Needs::nothing,
              "write it as .nrrd by pynrrd, or NetCDF by xarray", nullptr},
};

/// VTK XML of a kind that no row has: its reader says what it holds.
constexpr FormatRow other_vtk_xml{FileKind::vtk_xml, "VTK XML", "", FileHolds::mesh, Needs::vtk, "", nullptr};

bool has_extension(const FormatRow& row, const std::string& extension) {
  std::string_view rest = row.extensions;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == extension) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool is_vtk(const FormatRow& row) {
  return row.kind == FileKind::vtk_xml || row.kind == FileKind::vtk_legacy || row.kind == FileKind::vtk_grid ||
         row.kind == FileKind::vtk_surface;
}

/// Of those whose files are told by what the helper finds in them.
bool may_be_hdf5(const FormatRow& row) {
  return row.kind == FileKind::exodus || row.kind == FileKind::netcdf || row.kind == FileKind::minc ||
         row.kind == FileKind::hdf5 || std::string_view(row.extensions) == ".cgns" ||
         std::string_view(row.extensions) == ".vtkhdf";
}

const FormatRow& row_of_beginning(bool (*begins)(const FileBeginning&)) {
  return *std::find_if(rows.begin(), rows.end(), [&](const FormatRow& r) { return r.begins == begins; });
}

const FormatRow& row_of_folder(const std::filesystem::path& folder) {
  return row_of_beginning(is_case_folder(folder)    ? begins_as_openfoam
                          : is_amrex_folder(folder) ? begins_as_amrex
                                                    : begins_as_dicom);
}

}  // namespace

std::span<const FormatRow> format_rows() { return rows; }

const FormatRow* format_named(const std::filesystem::path& file) {
  const bool compressed = system::lower_extension(file) == ".gz";
  const std::string extension = system::lower_extension(compressed ? file.stem() : file);
  if (extension.empty()) return nullptr;
  const auto* row =
      std::find_if(rows.begin(), rows.end(), [&](const FormatRow& r) { return has_extension(r, extension); });
  return row == rows.end() ? nullptr : row;
}

const FormatRow* format_begun(const std::filesystem::path& file) {
  std::error_code unknown;
  if (is_input_folder(file)) return &row_of_folder(file);
  if (!std::filesystem::is_regular_file(file, unknown) || std::filesystem::file_size(file, unknown) == 0 || unknown)
    return nullptr;
  constexpr std::size_t length = 4096;
  std::string text = read_beginning(file, length);
  std::uint64_t size = std::filesystem::file_size(file, unknown);
  if (system::looks_like_gzip(text)) {
    const auto inner = system::inflate_beginning(std::as_bytes(std::span(text)), length);
    text.assign(reinterpret_cast<const char*>(inner.data()), inner.size());
    size = 0;
  }
  const FileBeginning beginning{file, text, size};
  for (const FormatRow& row : rows)
    if (row.begins != nullptr && row.begins(beginning)) return &row;
  const FormatRow* const named = format_named(file);
  if ((named == nullptr || may_be_hdf5(*named)) && has_hdf5_behind_block(file))
    return &row_of_beginning(begins_as_hdf5);
  // VTK XML of a kind that no row has: damaged, or its reader says what it holds.
  if (!begins_as_other_vtk_xml(beginning) || (named != nullptr && is_vtk(*named))) return nullptr;
  return &other_vtk_xml;
}

const FormatRow* format_of(const std::filesystem::path& file) {
  const FormatRow* const begun = format_begun(file);
  if (begun == nullptr || begun->kind == FileKind::hdf5) {
    const FormatRow* const named = format_named(file);
    if (begun == nullptr || (named != nullptr && named->kind == FileKind::med)) return named;
  }
  return begun;
}

void refuse_as_mesh(const std::filesystem::path& file) {
  const FormatRow* const row = format_of(file);
  if (row == nullptr)
    throw scene::bad_input(fmt::format(
        "{}: it neither begins as a file of a known format nor has a name of one; `tessera formats` lists them",
        file.string()));
  if (row->kind == FileKind::unread)
    throw scene::bad_input(fmt::format("{}: its format ({}) is not read; {}", file.string(), row->name, row->remark));
  if (row->holds == FileHolds::series)
    throw scene::bad_input(
        fmt::format("{}: it is a time series, which render and serve take; give one of its meshes", file.string()));
  throw scene::bad_input(
      fmt::format("{}: it is a regular grid, no mesh; give it alone or among volumes", file.string()));
}

}  // namespace tessera::io
