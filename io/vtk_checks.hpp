#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// VTK's readers believe the counts in a file: a wrong one makes them write through a null pointer. These walks over
/// the text compare every count with the bytes that are there, before VTK sees the file.
namespace tessera::io {

/// VTK XML (one piece file or whole): counts, extents and numbers of components against what the file could hold at
/// most; of a parallel file, that every piece exists and passes too. Throws Error(bad_input).
void check_vtk_xml(const std::filesystem::path& file);

/// Legacy VTK: walks from keyword to keyword, each payload has to fit; in CELLS each cell's length has to. Unknown
/// words are errors, since VTK knows words by their beginning only; what follows an array of strings is not checked.
/// Throws Error(bad_input, "SOURCE: ...").
void check_vtk_legacy(std::string_view text, const std::string& source);

/// A NetCDF classic header (versions 1, 2 and 5): every count in it against the bytes that are left, every variable
/// against the file's end, so that a truncated file is told as such. NetCDF's own reader allocates what a damaged
/// header asks for. Source: "NetCDF Classic Format Specification", Unidata. Throws Error(bad_input, "SOURCE: ...").
void check_netcdf_classic(std::string_view bytes, const std::string& source);

}  // namespace tessera::io
