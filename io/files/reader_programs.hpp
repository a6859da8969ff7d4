// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/error.hpp"

namespace tessera::io {

struct Format;

/// The programs that read files with third-party libraries (readers/README.md). Each program links one of these
/// libraries. Whether a program is installed is known only at run time, not when this library is built.
enum class Reader : std::uint8_t { vtk, tetgen, gmsh, dicom, xdmf, med };

struct ReaderProgram {
  Reader reader;
  const char* program;  ///< file name of the program
  const char* does;     ///< what the program does to files, as a participle
};

/// One row for each Reader, in the order of the enumeration.
std::span<const ReaderProgram> reader_programs();
const ReaderProgram& reader_program(Reader reader);

/// Returns the path of the program: libexec/tessera/PROGRAM in one of the five directories above the library or program
/// that contains this code, unless another user may have put it there; otherwise the install location. Empty if none of
/// these contains the program.
std::filesystem::path find_reader(Reader reader);

bool has_reader(Reader reader);

/// The error for a file whose reader is not installed. The message names the format, if known, the program, and how to
/// get the program.
scene::Error missing_reader(Reader reader, const std::string& source, const Format* format);

/// Whether the program `reader` is needed to read files of a format or to fill their surfaces with tets.
bool needs_reader(const Format& format, Reader reader);

}  // namespace tessera::io
