// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/formats/identify.hpp"
#include "io/mesh/block_surface.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"

/// Identifies and reads files by their names, as most tests do.
namespace tessera::io {

inline cells::MeshFile read_mesh(const std::filesystem::path& file, const ReadOptions& options = {}) {
  return read_mesh(identify(file), options);
}
inline std::vector<InputFile> identify_all(std::span<const std::filesystem::path> files) {
  std::vector<InputFile> all;
  all.reserve(files.size());
  for (const std::filesystem::path& file : files) all.push_back(identify(file));
  return all;
}
inline cells::MeshFile read_mesh(const std::vector<std::filesystem::path>& files, const ReadOptions& options = {}) {
  return read_mesh(identify_all(files), options);
}
inline BlockFaces read_block_faces(std::span<const std::filesystem::path> files, const ReadOptions& options) {
  return read_block_faces(identify_all(files), options);
}
inline VolumeFile open_volume(const std::filesystem::path& file, const ReadOptions& options = {}) {
  return open_volume(identify(file), options);
}
inline VolumeFile open_unscanned_volume(const std::filesystem::path& file, const ReadOptions& options = {},
                                        bool scratch_is_needed = false) {
  return open_unscanned_volume(identify(file), options, scratch_is_needed);
}
inline bool is_volume(const std::filesystem::path& file) { return is_volume(identify(file)); }

}  // namespace tessera::io
