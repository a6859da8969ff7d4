// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "io/files/format.hpp"

/// Functions that recognize formats by the first bytes of a file. No function returns true for a file of another format
/// of the table.
namespace tessera::io {

inline constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

/// Returns the value of the attribute `type` in <VTKFile type="...">, or an empty text if there is none.
std::string vtk_xml_type(std::string_view beginning);

/// Whether a text begins like the Header of an AMReX plot file: a line without blanks, the number of fields, the names
/// of the fields, and the number of dimensions.
bool looks_like_amrex(std::string_view beginning);

/// Whether a file begins like a DICOM file: any 128 bytes, then DICM.
bool looks_like_dicom(std::string_view beginning);

/// Whether a file begins like a binary Medit mesh (.meshb): a 32-bit 1 in either byte order, a version of 1 to 4, and a
/// dimension of 2 or 3.
bool begins_as_medit_binary(std::string_view beginning);

/// Whether a file begins like a Medit mesh in text form (.mesh).
bool begins_as_medit_text(std::string_view beginning);

/// Throws Error(bad_input) for a VTK XML file in UTF-16, in which the other functions would not find their keywords.
void require_no_utf16(std::string_view beginning, const std::string& source);

/// Returns the word after DATASET of a legacy VTK file, or an empty text if there is none.
std::string vtk_legacy_type(std::string_view beginning);

bool begins_as_vtu(const FileBeginning& file);
bool begins_as_vts(const FileBeginning& file);
bool begins_as_vtk_amr(const FileBeginning& file);
bool begins_as_hyper_trees(const FileBeginning& file);
bool begins_as_amrex(const FileBeginning& file);
bool begins_as_enzo(const FileBeginning& file);
bool begins_as_vtk_list(const FileBeginning& file);
bool begins_as_vtk_surface(const FileBeginning& file);
bool begins_as_vti(const FileBeginning& file);
bool begins_as_vtr(const FileBeginning& file);
bool begins_as_pvd(const FileBeginning& file);
bool begins_as_file_series(const FileBeginning& file);
bool begins_as_vtk_xml(const FileBeginning& file);
bool begins_as_legacy_mesh(const FileBeginning& file);
bool begins_as_legacy_grid(const FileBeginning& file);
bool begins_as_exodus(const FileBeginning& file);
bool begins_as_minc(const FileBeginning& file);
bool begins_as_netcdf(const FileBeginning& file);
bool begins_as_hdf5(const FileBeginning& file);
bool begins_as_adf(const FileBeginning& file);
bool begins_as_openfoam(const FileBeginning& file);
bool begins_as_ensight(const FileBeginning& file);
bool begins_as_fluent(const FileBeginning& file);
bool begins_as_gambit(const FileBeginning& file);
bool begins_as_gmsh(const FileBeginning& file);
bool begins_as_medit(const FileBeginning& file);
bool begins_as_freesurfer(const FileBeginning& file);
bool begins_as_meshb(const FileBeginning& file);
bool begins_as_su2(const FileBeginning& file);
bool begins_as_plot3d_list(const FileBeginning& file);
bool begins_as_avs_ucd(const FileBeginning& file);
bool begins_as_tecplot(const FileBeginning& file);
bool begins_as_stl(const FileBeginning& file);
bool begins_as_ply(const FileBeginning& file);
bool begins_as_brick_file(const FileBeginning& file);
bool begins_as_nrrd(const FileBeginning& file);
bool begins_as_meta_image(const FileBeginning& file);
bool begins_as_nifti(const FileBeginning& file);
bool begins_as_dicom(const FileBeginning& file);
bool begins_as_analyze(const FileBeginning& file);
bool begins_as_xdmf(const FileBeginning& file);

// Whether a file begins like a binary Tecplot file. The format is recognized only so that an error can name it: binary
// Tecplot files are not read.
bool begins_as_binary_tecplot(const FileBeginning& file);
bool begins_as_abaqus(const FileBeginning& file);
bool begins_as_mfem(const FileBeginning& file);
bool begins_as_netgen(const FileBeginning& file);
bool begins_as_nek5000(const FileBeginning& file);
bool begins_as_amira(const FileBeginning& file);
bool begins_as_brep(const FileBeginning& file);
bool begins_as_fits(const FileBeginning& file);
bool begins_as_frd(const FileBeginning& file);
bool begins_as_gltf(const FileBeginning& file);
bool begins_as_grib(const FileBeginning& file);
bool begins_as_hdf4(const FileBeginning& file);
bool begins_as_ls_dyna(const FileBeginning& file);
bool begins_as_mrc(const FileBeginning& file);
bool begins_as_numpy(const FileBeginning& file);
bool begins_as_nvdb(const FileBeginning& file);
bool begins_as_off(const FileBeginning& file);
bool begins_as_step(const FileBeginning& file);
bool begins_as_tiff(const FileBeginning& file);
bool begins_as_vdb(const FileBeginning& file);

}  // namespace tessera::io
