// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "io/files/file_beginnings.hpp"
#include "io/files/reader_programs.hpp"
#include "io/foreign/foreign_formats.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {
namespace {

using enum FileHolds;

constexpr std::array by_vtk = {Reader::vtk}, by_tetgen = {Reader::tetgen}, by_gmsh = {Reader::gmsh},
                     by_dicom = {Reader::dicom}, by_xdmf = {Reader::xdmf}, by_med = {Reader::med};
constexpr std::array by_vtk_and_tetgen = {Reader::vtk, Reader::tetgen};

constexpr const char* filled = "closed; filled with tets, field depth in addition to its own";
constexpr const char* pieces = "pieces fill the whole and have the same arrays";

/// The first parameters are members of every row, the last ones optional members.
constexpr Format row(const char* name, const char* extensions, FileHolds holds, std::span<const Reader> needs,
                     const char* remark, decltype(Format::recognizes) recognizes, Format format = {}) {
  format.name = name, format.extensions = extensions, format.holds = holds;
  format.needs = needs, format.remark = remark, format.recognizes = recognizes;
  return format;
}

/// A row for a known format that is not supported and is recognized by its name.
constexpr Format unread(const char* name, const char* extensions, const char* remark,
                        decltype(Format::recognizes) recognizes = nullptr, Format format = {}) {
  return row(name, extensions, not_read, {}, remark, recognizes, format);
}

/// If several rows recognize a file, the first of them applies.
constexpr std::array rows = {
    row("VTK XML unstructured grid", ".vtu .pvtu", mesh, {}, "pieces appended, ghost cells dropped; ranks read pieces",
        begins_as_vtu, {.container = Container::vtk_xml, .read_mesh = read_vtk_xml}),
    row("VTK XML curvilinear grid", ".vts .pvts", mesh, {}, pieces, begins_as_vts,
        {.container = Container::vtk_xml, .read_mesh = read_vtk_xml}),
    row("VTK XML multi-block", ".vtm .vtmb .vtpc .vtpd", mesh, {}, "all volumes in the list; surfaces left out",
        begins_as_vtk_list, {.container = Container::vtk_xml, .read_mesh = read_vtk_xml}),
    row("VTK XML AMR", ".vth .vthb", mesh, by_vtk,
        "overlapping or not; finest cells; `smooth` continuous across levels", begins_as_vtk_amr,
        {.read_mesh = read_amr_list}),
    row("VTK XML HyperTreeGrid", ".htg .phtg", mesh, by_vtk,
        "three dimensions; masked cells left out; `smooth` continuous across levels", begins_as_hyper_trees,
        {.read_mesh = read_hyper_trees}),
    row("AMReX plot file", "", mesh, {}, "its directory, or the Header in it; all levels, no particles",
        begins_as_amrex, {.read_mesh = read_amrex}),
    row("Enzo", ".hierarchy .boundary", mesh, by_vtk, "HDF5 files and parameters next to it; all levels, no particles",
        begins_as_enzo, {.read_mesh = read_enzo}),
    row("FLASH", "", mesh, by_vtk, "HDF5; all levels, no particles", nullptr),
    row("legacy VTK unstructured or curvilinear grid", ".vtk", mesh, by_vtk, "text or binary", begins_as_legacy_mesh,
        {.read_mesh = read_vtk_legacy}),
    row("Exodus II", ".ex2 .exo .exii .e .g", mesh, by_vtk,
        "NetCDF or HDF5; all element blocks; nodes moved by displacements", begins_as_exodus,
        {.read_mesh = read_exodus, .time_steps = exodus_time_steps}),
    row("OpenFOAM case", ".foam .openfoam", mesh, by_vtk,
        "the case's directory or a file in it; also decomposed; polyhedra", begins_as_openfoam,
        {.read_mesh = read_openfoam, .time_steps = steps_by<Reader::vtk, "openfoam">, .share_reader = "openfoam"}),
    row("EnSight 6 or Gold", ".case .encas .sos", mesh, by_vtk, "all parts, of .sos those of all its cases",
        begins_as_ensight, {.read_mesh = read_ensight, .time_steps = steps_by<Reader::vtk, "ensight">}),
    row("CGNS", ".cgns", mesh, by_vtk, "HDF5 or ADF", begins_as_adf,
        {.read_mesh = mesh_by<Reader::vtk, "cgns">,
         .time_steps = steps_by<Reader::vtk, "cgns">,
         .share_reader = "cgns"}),
    row("VTKHDF", ".vtkhdf", grid_or_mesh, by_vtk, "unstructured grids, and image data, which are volumes; time steps",
        nullptr,
        {.read_mesh = mesh_by<Reader::vtk, "vtk_hdf">,
         .open_volume = grid_by<Reader::vtk, "vtk_hdf">,
         .time_steps = steps_by<Reader::vtk, "vtk_hdf">}),
    row("MED", ".med .rmed", mesh, by_med,
        "Salome's, of version 2.3 and later; HDF5, by its name; fields of nodes and cells", nullptr,
        {.container = Container::hdf5,
         .read_mesh = mesh_by<Reader::med, "med">,
         .time_steps = steps_by<Reader::med, "med">}),
    row("XDMF", ".xdmf .xmf", grid_or_mesh, by_xdmf,
        "one grid is a volume, others are meshes; HDF5, binary or inline numbers", begins_as_xdmf,
        {.read_mesh = mesh_by<Reader::xdmf, "xdmf">,
         .open_volume = grid_by<Reader::xdmf, "xdmf">,
         .time_steps = steps_by<Reader::xdmf, "xdmf">,
         .holds_grid = holds_grid_by<Reader::xdmf, "xdmf">}),
    row("HDF5", "", grid_or_mesh, by_vtk, "", begins_as_hdf5,
        {.container = Container::hdf5,
         .is_listed = false,
         .read_mesh = read_hdf5,
         .open_volume = grid_by<Reader::vtk, "hdf5">,
         .time_steps = steps_by<Reader::vtk, "hdf5">,
         .holds_grid = holds_grid_by<Reader::vtk, "hdf5">,
         .share_reader = "hdf5"}),
    row("Fluent", ".cas", mesh, by_vtk, "text or binary, no HDF5; values from the .dat next to it", begins_as_fluent,
        {.read_mesh = read_fluent, .time_steps = steps_by<Reader::vtk, "fluent">}),
    row("GAMBIT", ".neu", mesh, by_vtk, "", begins_as_gambit,
        {.read_mesh = read_gambit, .time_steps = steps_by<Reader::vtk, "gambit">}),
    row("AVS UCD", ".inp .ucd", mesh, by_vtk, "text; binary by its name", begins_as_avs_ucd,
        {.read_mesh = read_avs_ucd, .time_steps = steps_by<Reader::vtk, "avs_ucd">}),
    row("Tecplot", ".tec", mesh, {}, "text; ordered zones, bricks, tetrahedra, polyhedra; solution times are steps",
        begins_as_tecplot, {.read_mesh = read_tecplot, .time_steps = tecplot_time_steps}),
    row("Gmsh", ".msh", mesh, by_gmsh, "MSH 1 to 4.1, text or binary; views are fields, physical groups blocks",
        begins_as_gmsh, {.read_mesh = mesh_by<Reader::gmsh, "gmsh">, .time_steps = steps_by<Reader::gmsh, "gmsh">}),
    row("Medit", ".mesh", mesh, {}, "text, without .sol; references are blocks", begins_as_medit,
        {.read_mesh = read_medit_text}),
    row("Medit binary", ".meshb", mesh, {}, "versions 1 to 4, without .sol; references are blocks", begins_as_meshb,
        {.read_mesh = read_medit_binary}),
    row("I-DEAS universal", ".unv", mesh, by_gmsh, "meshes; by its name", nullptr,
        {.read_mesh = mesh_by<Reader::gmsh, "by_gmsh">}),
    row("Nastran bulk data", ".bdf .nas", mesh, {}, "solid elements, a block a property; coordinate systems; INCLUDE",
        nullptr, {.read_mesh = read_nastran_mesh}),
    row("SU2", ".su2", mesh, {}, "meshes of 3 dimensions; zones are blocks", begins_as_su2, {.read_mesh = read_su2}),
    row("PLOT3D", ".xyz .p3d .x .bin", mesh, by_vtk, "text or binary; the solution next to it, or `q`; IBLANK 0 hides",
        nullptr, {.read_mesh = read_plot3d}),
    row("PLOT3D list", "", mesh, by_vtk, "ParaView's, of grids and solutions by time", begins_as_plot3d_list,
        {.read_mesh = read_plot3d_list, .time_steps = plot3d_list_time_steps}),
    row("TetGen mesh", ".node .ele", mesh, {}, "either name finds the other", nullptr, {.read_mesh = read_node_ele}),
    row("raw tetrahedra", ".tets", mesh, {}, "bytes in docs/FORMATS.md; ranks read ranges", nullptr,
        {.read_mesh = read_tets}),
    row("STL", ".stl", surface, by_vtk_and_tetgen, filled, begins_as_stl,
        {.read_mesh = fill_surface_file, .read_surface = read_stl_surface}),
    row("VTK surface", ".vtp", surface, by_vtk_and_tetgen, filled, begins_as_vtk_surface,
        {.container = Container::vtk_xml, .read_mesh = fill_surface_file, .read_surface = read_vtk_surface_file}),
    row("PLY", ".ply", surface, by_tetgen, filled, begins_as_ply,
        {.read_mesh = fill_surface_file, .read_surface = read_ply_surface}),
    row("TetGen surface", ".poly .smesh", surface, by_tetgen, filled, nullptr,
        {.read_mesh = fill_surface_file, .read_surface = read_tetgen_surface}),
    row("VTK XML image data", ".vti .pvti", grid, {}, pieces, begins_as_vti,
        {.container = Container::vtk_xml, .open_volume = open_vtk_grid}),
    row("VTK XML rectilinear grid", ".vtr .pvtr", grid_or_mesh, {}, pieces, begins_as_vtr,
        {.container = Container::vtk_xml, .read_mesh = read_vtk_xml, .open_volume = open_vtk_grid}),
    row("legacy VTK structured points or rectilinear grid", ".vtk", grid_or_mesh, by_vtk, "text or binary",
        begins_as_legacy_grid, {.read_mesh = read_vtk_legacy, .open_volume = open_vtk_grid}),
    row("NetCDF grid", ".nc .nc4 .cdf", grid_or_mesh, by_vtk,
        "CF conventions or plain; curvilinear ones are meshes; missing values blank", begins_as_netcdf,
        {.read_mesh = mesh_by<Reader::vtk, "netcdf">,
         .open_volume = grid_by<Reader::vtk, "netcdf">,
         .time_steps = steps_by<Reader::vtk, "netcdf">,
         .holds_grid = holds_grid_by<Reader::vtk, "netcdf">}),
    row("MINC", ".mnc", grid, by_vtk, "MINC 1, and 2 in HDF5; time", begins_as_minc,
        {.open_volume = grid_by<Reader::vtk, "minc">}),
    row("MetaImage", ".mhd .mha", grid, {}, "raw, compressed or text; slices in files; time", begins_as_meta_image,
        {.open_volume = open_meta_image, .end_of_samples = end_of_meta_image}),
    row("NRRD", ".nrrd .nhdr", grid, {}, "raw, gzip, text or hex; slices in files; time", begins_as_nrrd,
        {.open_volume = open_nrrd, .end_of_samples = end_of_nrrd}),
    row("NIfTI", ".nii", grid, {}, "NIfTI-1 and -2, also .hdr with .img; time", begins_as_nifti,
        {.open_volume = open_nifti, .reads_gzip = true}),
    row("Analyze 7.5", ".hdr .img", grid, {}, "header and samples; either name finds the other", begins_as_analyze,
        {.by_name_too = true, .open_volume = open_analyze, .reads_gzip = true}),
    row("DICOM", ".dcm .dicom .ima", grid, by_dicom, "a directory of slices, one of its files, or frames; time",
        begins_as_dicom, {.open_volume = grid_by<Reader::dicom, "dicom">}),
    row("bricks", ".bricks", grid, {}, "what convert writes", begins_as_brick_file, {.open_volume = open_brick_file}),
    row("raw samples", ".raw", grid, {}, "described by `dims` and `type`, or NAME_WxHxD_TYPE.raw", nullptr,
        {.open_volume = open_raw}),
    row("ParaView collection", ".pvd", series, {}, "of any meshes or grids", begins_as_pvd),
    row("ParaView file series", ".series", series, {}, "of any meshes or grids", begins_as_file_series),
    unread("Tecplot binary", ".plt .szplt", "its library is not free; write text, CGNS or .vtu",
           begins_as_binary_tecplot),
    unread("LS-DYNA input", ".k .key .dyn", "no library reads it; export Nastran .bdf from LS-PrePost",
           begins_as_ls_dyna),
    unread("LS-DYNA results", ".d3plot", "open d3plot in ParaView and save it as .vtm"),
    unread("Abaqus or Ansys input", ".cdb", "VTK has no reader; convert it to .vtu with meshio", begins_as_abaqus),
    unread("Abaqus or Ansys results", ".odb .rst .rth", "their libraries are not free; export Exodus, EnSight or .vtu"),
    unread("CalculiX results", ".frd", "convert it to .vtu with ccx2paraview", begins_as_frd),
    unread("Nastran results", ".op2 .xdb .pch",
           "meshes are read as .bdf; save results as .vtu by pyNastran and meshio"),
    unread("HyperMesh or HyperView", ".h3d .hm .hmascii", "its format is not open; export Nastran .bdf or EnSight"),
    unread("STAR-CCM+", ".ccm .ccmg .ccmp .sim", "its library is not free; export EnSight or CGNS"),
    unread("Ansys CFX", ".res .def", "its library is not free; export CGNS or EnSight"),
    unread("Fluent HDF5", ".cas.h5 .dat.h5 .msh.h5", "export CGNS, EnSight or a .cas without HDF5"),
    unread("COMSOL mesh", ".mphbin .mphtxt", "export Nastran .nas or .vtu from COMSOL"),
    unread("MOAB", ".h5m", "convert it to .vtk with mbconvert"),
    unread("AFLR3", ".ugrid", "convert it to .vtu with meshio"),
    unread("FLAC3D", ".f3grid", "convert it to .vtu with meshio"),
    unread("Kratos", ".mdpa", "convert it to .vtu with meshio"),
    unread("Silo", ".silo", "save it as .vtm in ParaView or VisIt"),
    unread("STEP geometry", ".step .stp", "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", begins_as_step),
    unread("IGES geometry", ".iges .igs", "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh"),
    unread("BREP geometry", ".brep", "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh", begins_as_brep),
    unread("Gmsh geometry", ".geo", "a shape without a mesh; mesh it: gmsh -3 FILE -o mesh.msh"),
    unread("Wavefront OBJ", ".obj", "a surface; convert it to .stl or .ply with meshio or MeshLab"),
    unread("OFF", ".off", "a surface; convert it to .stl or .ply with meshio or MeshLab", begins_as_off),
    unread("glTF", ".gltf .glb", "a surface; save it as .stl or .ply in Blender or MeshLab", begins_as_gltf),
    unread("3D scene", ".fbx .dae .3ds .blend .3mf .usd .usdc .usdz .abc",
           "a surface; save it as .stl or .ply in Blender"),
    unread("OpenVDB", ".vdb", "its library is not linked; save it as .vti in ParaView", begins_as_vdb),
    unread("NanoVDB", ".nvdb", "its library is not linked; save it as .vti from OpenVDB by ParaView", begins_as_nvdb),
    unread("Houdini geometry", ".bgeo .hip",
           "its format is not open; save volumes as .vdb, and these as .vti in ParaView"),
    unread("ADIOS2", ".bp", "open it in ParaView and save it as .vtm"),
    unread("Nek5000", ".nek5000", "VTK's reader is not packaged; save it as .vtu in ParaView", begins_as_nek5000),
    unread("MFEM", "", "its library is not packaged; have MFEM write .vtu", begins_as_mfem),
    unread("Netgen", ".vol", "VTK has no reader; convert it to .vtu with meshio", begins_as_netgen),
    unread("GRIB", ".grib .grb .grib2 .grb2", "convert it to NetCDF: cdo -f nc copy FILE out.nc", begins_as_grib),
    unread("HDF4", ".hdf .hdf4", "convert it to HDF5 with h4toh5, or to NetCDF with ncl_convert2nc", begins_as_hdf4),
    unread("FITS", ".fits .fit .fts", "save it as .nrrd by astropy and pynrrd", begins_as_fits),
    unread("FreeSurfer volume", ".mgz .mgh", "convert it: mri_convert FILE out.nii.gz", begins_as_freesurfer,
           {.by_name_too = true}),
    unread("GIPL", ".gipl", "convert it: c3d FILE -o out.nii.gz"),
    unread("AFNI", ".brik .head", "convert it: 3dAFNItoNIFTI FILE"),
    unread("MRC or CCP4 map", ".mrc .map .ccp4 .rec",
           "rename it to .raw and describe it: `dims`, `type` and `skip` 1024", begins_as_mrc),
    unread("Amira", ".am", "save it as .nrrd in 3D Slicer", begins_as_amira),
    unread("TIFF stack", ".tif .tiff", "save it as .nrrd in Fiji", begins_as_tiff),
    unread("microscope volume", ".czi .lif .nd2 .ims .oib .lsm", "save it as .nrrd in Fiji"),
    unread("NumPy array", ".npy .npz", "write it as .raw with NumPy's tofile, or as .nrrd with pynrrd",
           begins_as_numpy),
    unread("MATLAB data", ".mat", "write it as .raw by fwrite, or .nrrd by nrrdWriter"),
    unread("Zarr", ".zarr", "write it as .nrrd by pynrrd, or NetCDF by xarray"),
    // VTK XML of a kind that no other row has: damaged, or its reader determines the content.
    row("VTK XML", "", mesh, by_vtk, "", begins_as_vtk_xml,
        {.container = Container::vtk_xml, .is_listed = false, .read_mesh = read_vtk_xml}),
};

}  // namespace

std::span<const Format> formats() { return rows; }

}  // namespace tessera::io
