// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "io/foreign/client/foreign_file.hpp"
#include "tessera/read_progress.hpp"

namespace tessera::io {

/// Opens a VTK XML file of one data set (.vtu .vts .vtr .vti) in this process: ascii, base64 and raw arrays,
/// uncompressed or compressed by zlib, LZ4 or LZMA. The pieces of an unstructured grid become one part, as in VTK's
/// reader; other grids are read if one piece covers the whole grid. No value if the file has features that only VTK's
/// reader may support (read_vtk_xml_grid). Throws Error(bad_input) with a message of one line for a damaged file.
///
/// Memory  numbers are read from the file on demand; types and offsets of cells stay in memory.
std::optional<ForeignFile> open_vtk_xml(const std::filesystem::path& file, const ReadProgressFunction& progress = {});

}  // namespace tessera::io
