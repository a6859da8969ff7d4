// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "scene/time_step_read.hpp"
#include "tessera/file_formats.hpp"

namespace tessera::cells {
struct MeshBlocks;
}  // namespace tessera::cells

namespace tessera::io {

struct InputFile;
struct MeshOptions;
struct SurfaceFile;
struct VolumeFile;
struct VolumeOptions;
enum class Reader : std::uint8_t;  // defined in reader_programs.hpp

/// The first bytes of a file. Those of a gzip file are inflated.
struct FileBeginning {
  std::string_view text;   ///< the first bytes, at most 4096
  std::uint64_t size = 0;  ///< size of the whole file in bytes; 0 if the file is compressed
};

/// Kinds of files that several formats share: the first bytes identify only the container, not the format in it.
enum class Container : std::uint8_t { none, vtk_xml, hdf5 };

/// A row of the table of formats (io/formats/format_table.cpp): how files of the format are recognized and which
/// functions read them. The list of formats, the meaning of file names and the formats named in errors are derived from
/// the table.
struct Format {
  const char* name = "";
  const char* extensions = "";  ///< lower case, separated by blanks; writers use the first
  FileHolds holds = FileHolds::not_read;
  std::span<const Reader> needs{};  ///< reader programs
  const char* remark = "";          ///< supported features and limits, or why the format is not read
  /// Whether the first bytes alone identify the format. Null: the format is recognized by the file's name alone.
  bool (*recognizes)(const FileBeginning&) = nullptr;
  bool by_name_too = false;  ///< the file's name must have one of the extensions, too
  /// A file that begins like this container has this format if the file's name has one of `extensions`. A row with
  /// `is_listed` = false represents the container itself.
  Container container = Container::none;
  bool is_listed = true;

  // Null if files of this format have no mesh, volume or surface.
  cells::MeshBlocks (*read_mesh)(const InputFile&, const MeshOptions&) = nullptr;
  VolumeFile (*open_volume)(const InputFile&, const VolumeOptions&) = nullptr;
  SurfaceFile (*read_surface)(const InputFile&) = nullptr;
  /// Returns the number of time steps of a mesh file and their times, as selected by ReadOptions::time_step.
  scene::TimeStepRead (*time_steps)(const InputFile&, const MeshOptions&) = nullptr;

  bool (*holds_grid)(const InputFile&) = nullptr;  ///< whether a file is a volume; only for formats that also contain
                                                   ///< meshes
  bool reads_gzip = false;  ///< open_volume reads gzip files itself; other gzip files are inflated first
  /// Returns where the samples of a gzip file end, according to the header, so that inflating can stop there. No value
  /// if the header does not determine the end.
  std::optional<std::uint64_t> (*end_of_samples)(const InputFile&) = nullptr;
  const char* share_reader = nullptr;  ///< name of the reader, in its program, for meshes in shares
};

}  // namespace tessera::io
