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
  std::uint64_t size = 0;  ///< of the whole; 0 if it is compressed
};

/// Containers that several formats share, so that a beginning identifies only the container.
enum class Container : std::uint8_t { none, vtk_xml, hdf5 };

/// A row of the one table of formats (io/formats/format_table.cpp): how its files are recognized and what reads them.
/// What is listed, what a name means and which errors name a format follow from it.
struct Format {
  const char* name = "";
  const char* extensions = "";  ///< in lower case, with blanks between; the first is what writers use
  FileHolds holds = FileHolds::not_read;
  std::span<const Reader> needs{};  ///< reader programs
  const char* remark = "";          ///< what applies, limits; why it is not read
  /// By what a file begins with alone; null: by its name alone.
  bool (*recognizes)(const FileBeginning&) = nullptr;
  bool by_name_too = false;  ///< recognized only under one of the extensions
  /// A file that begins as this container is of this format if its name is. A row that is not listed stands for the
  /// container itself.
  Container container = Container::none;
  bool is_listed = true;

  // Null: files of this format have none.
  cells::MeshBlocks (*read_mesh)(const InputFile&, const MeshOptions&) = nullptr;
  VolumeFile (*open_volume)(const InputFile&, const VolumeOptions&) = nullptr;
  SurfaceFile (*read_surface)(const InputFile&) = nullptr;
  /// Of meshes: how many there are and when; ReadOptions::time_step applies.
  scene::TimeStepRead (*time_steps)(const InputFile&, const MeshOptions&) = nullptr;

  bool (*holds_grid)(const InputFile&) = nullptr;  ///< looks into a file that may hold a grid or a mesh
  bool reads_gzip = false;  ///< open_volume does; other gzip files are inflated before they are read
  /// Where a gzip file's samples end, by its header: no more is inflated. No value if that does not tell.
  std::optional<std::uint64_t> (*end_of_samples)(const InputFile&) = nullptr;
  const char* share_reader = nullptr;  ///< the helper's reader of a mesh in pieces that processes share
};

}  // namespace tessera::io
