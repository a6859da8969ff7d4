#pragma once

#include <filesystem>
#include <optional>

#include "io/foreign_file.hpp"

namespace tessera::io {

/// Opens a .vtu, VTK's XML file of an unstructured grid, in this process: ascii, base64 and raw arrays, uncompressed or
/// by zlib, LZ4 or LZMA. Its pieces are one part, as VTK's reader makes them. Nothing if the file has what this reader
/// does not know, and VTK's may (read_vtk_xml_grid). Throws Error(bad_input) in one line for a file that is damaged.
///
/// Memory  numbers are read where they are stored, when they are asked for; types and offsets of cells are held.
std::optional<ForeignFile> open_vtu(const std::filesystem::path& file);

/// Throws Error(bad_input) unless a VTK XML file ends as one does.
void require_vtk_xml_end(const std::filesystem::path& file);

}  // namespace tessera::io
