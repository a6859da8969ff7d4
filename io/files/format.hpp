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
enum class Reader : std::uint8_t;  // reader_programs.hpp

/// The first bytes of a file, unpacked if it is gzip.
struct FileBeginning {
  std::string_view text;   ///< its first bytes, at most 4096
  std::uint64_t size = 0;  ///< of the whole file; 0 if it is compressed
};

/// Containers shared by several formats: the first bytes identify only the container.
enum class Container : std::uint8_t { none, vtk_xml, hdf5 };

/// A row of the table of formats (io/formats/format_table.cpp): how files of the format are recognized and what reads
/// them. The list of formats, the meaning of file names and the formats named in errors are derived from it.
struct Format {
  const char* name = "";
  const char* extensions = "";  ///< lower case, separated by blanks; the first is the one that writers use
  FileHolds holds = FileHolds::not_read;
  std::span<const Reader> needs{};  ///< reader programs
  const char* remark = "";          ///< supported features and limits; or why it is not read
  /// Recognizes the format by its first bytes alone; null: by its name alone.
  bool (*recognizes)(const FileBeginning&) = nullptr;
  bool by_name_too = false;  ///< recognized only with one of the extensions
  /// A file that begins like this container has this format if its name matches. A row that is not listed represents
  /// the container itself.
  Container container = Container::none;
  bool is_listed = true;

  // Null if files of this format have no mesh, volume or surface.
  cells::MeshBlocks (*read_mesh)(const InputFile&, const MeshOptions&) = nullptr;
  VolumeFile (*open_volume)(const InputFile&, const VolumeOptions&) = nullptr;
  SurfaceFile (*read_surface)(const InputFile&) = nullptr;
  /// For meshes: the number of time steps and their times; ReadOptions::time_step applies.
  scene::TimeStepRead (*time_steps)(const InputFile&, const MeshOptions&) = nullptr;

  bool (*holds_grid)(const InputFile&) = nullptr;  ///< inspects a file that may contain a grid or a mesh
  bool reads_gzip = false;  ///< open_volume reads gzip; other gzip files are inflated before they are read
  /// Where the samples of a gzip file end, according to its header, so that inflating can stop there. No value if the
  /// header does not determine it.
  std::optional<std::uint64_t> (*end_of_samples)(const InputFile&) = nullptr;
  const char* share_reader = nullptr;  ///< the program's reader of a mesh in pieces shared by processes
};

}  // namespace tessera::io
