// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/error.hpp"

namespace tessera::io {

struct Format;

/// The programs that read files with other people's libraries (readers/README.md). Each links one of these libraries
/// and may be installed or not: that is a fact about the machine at run time, not about the build of this library.
enum class Reader : std::uint8_t { vtk, tetgen, gmsh, dicom, xdmf, med };

struct ReaderProgram {
  Reader reader;
  const char* program;  ///< its file name
  const char* does;     ///< what it does to files, a participle
};

/// One row for each Reader, in their order.
std::span<const ReaderProgram> reader_programs();
const ReaderProgram& reader_program(Reader reader);

/// The program's file: libexec/tessera/PROGRAM in one of the five folders above the library or program that this code
/// is in, unless another user may have put it there; else where it was to be installed. Empty if it is in none of them.
std::filesystem::path find_reader(Reader reader);

bool has_reader(Reader reader);

/// The error of a file whose reader is not installed: it names the format, if that is known, the program and how to get
/// it.
scene::Error missing_reader(Reader reader, const std::string& source, const Format* format);

/// Whether files of a format are read, or filled, by that program.
bool needs_reader(const Format& format, Reader reader);

}  // namespace tessera::io
