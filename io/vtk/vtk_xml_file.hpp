// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "io/foreign/client/foreign_file.hpp"
#include "tessera/read_progress.hpp"

namespace tessera::io {

/// Opens a VTK XML file of one data set (.vtu .vts .vtr .vti) in this process: ascii, base64 and raw arrays,
/// uncompressed or by zlib, LZ4 or LZMA. The pieces of an unstructured grid are one part, as VTK's reader makes them;
/// other grids are read if one piece is the whole. No value if the file has features that only VTK's reader may know
/// (read_vtk_xml_grid). Throws Error(bad_input) in one line for a file that is damaged.
///
/// Memory  numbers are read where they are stored, when they are asked for; types and offsets of cells are held.
std::optional<ForeignFile> open_vtk_xml(const std::filesystem::path& file, const ReadProgressFunction& progress = {});

}  // namespace tessera::io
