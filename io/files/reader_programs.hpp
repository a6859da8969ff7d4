// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/error.hpp"

namespace tessera::io {

struct Format;

/// The programs that read files with third-party libraries (readers/README.md). Each links one of these libraries and
/// may be installed or not: that is known only at run time, not when this library is built.
enum class Reader : std::uint8_t { vtk, tetgen, gmsh, dicom, xdmf, med };

struct ReaderProgram {
  Reader reader;
  const char* program;  ///< its file name
  const char* does;     ///< what it does to files, as a participle
};

/// One row for each Reader, in the order of the enumeration.
std::span<const ReaderProgram> reader_programs();
const ReaderProgram& reader_program(Reader reader);

/// The program's file: libexec/tessera/PROGRAM in one of the five directories above the library or program that
/// contains this code, unless another user may have put it there; otherwise its install location. Empty if it is in
/// none of them.
std::filesystem::path find_reader(Reader reader);

bool has_reader(Reader reader);

/// The error for a file whose reader is not installed: it names the format, if known, the program and how to get it.
scene::Error missing_reader(Reader reader, const std::string& source, const Format* format);

/// Whether that program reads or fills files of a format.
bool needs_reader(const Format& format, Reader reader);

}  // namespace tessera::io
