// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "io/formats/identify.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"

/// Files identified and read by their names, as most tests do.
namespace tessera::io {

inline cells::MeshFile read_mesh(const std::filesystem::path& file, const ReadOptions& options = {}) {
  return read_mesh(identify(file), options);
}
inline cells::MeshFile read_mesh(const std::vector<std::filesystem::path>& files, const ReadOptions& options = {}) {
  std::vector<InputFile> all;
  for (const std::filesystem::path& file : files) all.push_back(identify(file));
  return read_mesh(all, options);
}
inline VolumeFile open_volume(const std::filesystem::path& file, const VolumeOptions& options = {}) {
  return open_volume(identify(file), options);
}
inline VolumeFile open_unscanned_volume(const std::filesystem::path& file, const VolumeOptions& options = {}) {
  return open_unscanned_volume(identify(file), options);
}
inline bool is_volume(const std::filesystem::path& file) { return is_volume(identify(file)); }

}  // namespace tessera::io
