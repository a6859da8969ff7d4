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
  double time = 0;  ///< as the .pvd, .series or file states it; otherwise the number in the name, or in the list
  std::vector<std::filesystem::path> files;  ///< at least one; several are pieces of one mesh
  std::optional<std::size_t> in_file{};      ///< in a file with several steps: its index (ReadOptions::time_step)
  bool has_time = false;  ///< the .pvd, .series or file states the time; otherwise `time` is the number or place
};

/// Whether the name denotes several meshes: a .pvd, a .series, or a file name with `%d` or `%04d` that is not itself a
/// file.
TESSERA_EXPORT bool is_time_series(const std::filesystem::path& input);

/// The steps of a film in the order of time; their files need not all exist.
///
/// .pvd (ParaView): <VTKFile type="Collection"> with <DataSet timestep= part= file=>; relative paths are relative to
/// the directory of the .pvd, entries with the same timestep are its parts. .series (ParaView): JSON, {"files":
/// [{"name", "time"}, ...]}, each entry a step. Pattern: the existing files whose name results from the pattern with
/// some number, ordered by number; gaps are allowed. If all are VTK files with `TimeValue` or `TIME` in their field
/// data, these are the times. Throws Error(bad_input) in one line for a missing, malformed or huge list, an empty list,
/// and a pattern without a file.
TESSERA_EXPORT std::vector<TimeStep> read_time_series(const std::filesystem::path& input);

/// A name with its first `%d` or `%0Nd` (as in printf) replaced by a number; nothing if it has none. Other text,
/// including other % characters, is kept.
TESSERA_EXPORT std::optional<std::string> numbered_name(const std::string& pattern, int number);

}  // namespace v0_1
}  // namespace tessera
