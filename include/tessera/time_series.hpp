// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// One mesh or grid of a time series.
struct TimeStep {
  double time = 0;  ///< as the .pvd, .series or file gives it; else the number in the name, or the place in a list
  std::vector<std::filesystem::path> files;  ///< at least one; several are pieces of one mesh
  std::optional<std::size_t> in_file{};      ///< of a file with several steps: which of them (ReadOptions::time_step)
  bool has_time = false;  ///< the .pvd, .series or file says the time; else the number or place stands for it
};

/// Whether the name stands for several meshes: a .pvd, a .series, or a file name with `%d` or `%04d` that is not a file
/// itself.
TESSERA_EXPORT bool is_time_series(const std::filesystem::path& input);

/// The steps of a film in the order of time; not all of their files need exist.
///
/// .pvd (ParaView's): <VTKFile type="Collection"> with <DataSet timestep= part= file=>; relative paths are against the
/// .pvd's folder, entries of one timestep are its parts. .series (ParaView's): JSON, {"files": [{"name", "time"},
/// ...]}, each entry a step. Pattern: the files there are whose name the pattern gives for some number, by number; gaps
/// are fine; where all are VTK files with `TimeValue` or `TIME` in their field data, times are these. Throws
/// Error(bad_input) in one line for a missing, malformed or huge list, one that lists nothing, and a pattern without a
/// file.
TESSERA_EXPORT std::vector<TimeStep> read_time_series(const std::filesystem::path& input);

/// A name with its first `%d` or `%0Nd` (as in printf) replaced by a number; nothing if it has none. Other text, other
/// % too, stays.
TESSERA_EXPORT std::optional<std::string> numbered_name(const std::string& pattern, int number);

}  // namespace v0_1
}  // namespace tessera
