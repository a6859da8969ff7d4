// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/reader_programs.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "io/files/format.hpp"

namespace tessera::io {
namespace {

constexpr std::array programs = {
    ReaderProgram{Reader::vtk, "tessera-read-vtk", "read"},
    ReaderProgram{Reader::tetgen, "tessera-read-tetgen", "filled"},
    ReaderProgram{Reader::gmsh, "tessera-read-gmsh", "read"},
    ReaderProgram{Reader::dicom, "tessera-read-dicom", "read"},
    ReaderProgram{Reader::xdmf, "tessera-read-xdmf", "read"},
    ReaderProgram{Reader::med, "tessera-read-med", "read"},
};

/// The file from which this code was loaded: the library, or the program that links it.
std::filesystem::path own_file() {
  Dl_info info{};
  std::error_code unknown;
  if (::dladdr(reinterpret_cast<const void*>(&own_file), &info) != 0 && info.dli_fname != nullptr) {
    std::filesystem::path file = std::filesystem::canonical(info.dli_fname, unknown);
    if (!unknown) return file;  // the path under which a program was started may not lead to its file
  }
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

bool is_program(const std::filesystem::path& file) { return ::access(file.c_str(), X_OK) == 0; }

/// The owner of a file, and whether all users may modify the file.
struct Ownership {
  uid_t owner;
  bool is_open_to_all;
};
std::optional<Ownership> ownership_of(const std::filesystem::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return std::nullopt;
  return Ownership{facts.st_uid, (facts.st_mode & S_IWOTH) != 0};
}

/// Whether no other user can have installed the reader; any user can create /tmp/libexec, for example. The reader and
/// the directories that contain it must belong to root, this user or the owner of `own`, and must not be more writable
/// than `own`.
bool is_trusted(const std::filesystem::path& program, const std::filesystem::path& own) {
  const auto self = ownership_of(own);
  const std::filesystem::path folder = program.parent_path();
  for (const std::filesystem::path& each : {program, folder, folder.parent_path()}) {
    const auto found = ownership_of(each);
    if (!found || (found->is_open_to_all && !(self && self->is_open_to_all))) return false;
    if (found->owner != 0 && found->owner != ::geteuid() && (!self || found->owner != self->owner)) return false;
  }
  return true;
}

/// An alternative to suggest to users who do not have the reader.
std::string other_remedy(Reader reader, const Format* format) {
  if (reader == Reader::tetgen) return "give a mesh of tetrahedra";
  if (reader == Reader::dicom) return "convert them to .nii.gz with dcm2niix";
  if (format == nullptr || std::string_view(format->extensions).starts_with(".vtu"))
    return "convert the file to another format";
  switch (format->holds) {
    case FileHolds::surface:
      return "convert the file to .ply";
    case FileHolds::grid:
      return "convert the file to .nrrd";
    case FileHolds::grid_or_mesh:
      return "convert the file to .nrrd or .vtu";
    default:
      return "convert the file to .vtu";
  }
}

}  // namespace

std::span<const ReaderProgram> reader_programs() { return programs; }

const ReaderProgram& reader_program(Reader reader) { return programs[static_cast<std::size_t>(reader)]; }

std::filesystem::path find_reader(Reader reader) {
  const char* const name = reader_program(reader).program;
  std::error_code unknown;
  for (const std::filesystem::path& own : {own_file(), std::filesystem::read_symlink("/proc/self/exe", unknown)}) {
    std::filesystem::path start = own;
    for (int levels = 0; levels < 5 && start.has_relative_path(); ++levels) {
      start = start.parent_path();
      std::filesystem::path file = start / "libexec/tessera" / name;
      if (is_program(file) && is_trusted(file, own)) return file;
    }
  }
  const std::filesystem::path installed = std::filesystem::path(TESSERA_LIBEXEC) / name;
  return is_program(installed) ? installed : std::filesystem::path();
}

bool has_reader(Reader reader) { return !find_reader(reader).empty(); }

scene::Error missing_reader(Reader reader, const std::string& source, const Format* format) {
  const ReaderProgram& program = reader_program(reader);
  // Formats that this library reads itself need a reader only for their rare features.
  const char* const words = format != nullptr && !needs_reader(*format, reader)
                                ? "{}: this {} file has parts that are {} only by {}"
                                : "{}: {} files are {} by {}";
  return scene::bad_input(fmt::format(fmt::runtime(words), source, format != nullptr ? format->name : "such",
                                      program.does, program.program) +
                          fmt::format(", which is not installed; install it (scripts/readers.sh of the sources builds "
                                      "it), or {}",
                                      other_remedy(reader, format)));
}

bool needs_reader(const Format& format, Reader reader) { return std::ranges::count(format.needs, reader) > 0; }

}  // namespace tessera::io
