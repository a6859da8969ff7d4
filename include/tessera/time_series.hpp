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
  double time = 0;  ///< the time that the .pvd, the .series or the file states; otherwise the number in the file's name
                    ///< or the position in the list
  std::vector<std::filesystem::path> files;  ///< at least one; several files are pieces of one mesh
  std::optional<std::size_t> in_file{};      ///< index of the step in a file with several steps
                                             ///< (ReadOptions::time_step)
  bool has_time = false;                     ///< true if the .pvd, the .series or the file states the time
};

/// Whether the name denotes a time series: a .pvd, a .series, or a name with `%d` or `%04d` that is not the name of an
/// existing file.
TESSERA_EXPORT bool is_time_series(const std::filesystem::path& input);

/// Returns the steps of a time series, ordered by time. Not all of their files need to exist.
///
/// .pvd (ParaView): <VTKFile type="Collection"> with <DataSet timestep= part= file=>; relative paths start at the
/// directory of the .pvd, and entries with the same timestep are the parts of one mesh. .series (ParaView): JSON,
/// {"files": [{"name", "time"}, ...]}; each entry is a step. Pattern: all existing files whose names result from the
/// pattern with some number, ordered by number; numbers may be missing. If all are VTK files with `TimeValue` or `TIME`
/// in their field data, these are the times. Throws Error(bad_input), with a message of one line, for a missing,
/// malformed, huge or empty list and for a pattern without a file.
TESSERA_EXPORT std::vector<TimeStep> read_time_series(const std::filesystem::path& input);

/// Returns `pattern` with its first `%d` or `%0Nd` (as in printf) replaced by the number; nothing if the pattern has
/// neither. All other text, including other % characters, is kept.
TESSERA_EXPORT std::optional<std::string> numbered_name(const std::string& pattern, int number);

}  // namespace v0_1
}  // namespace tessera
