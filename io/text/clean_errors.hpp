// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <new>
#include <optional>
#include <string>

#include "scene/error.hpp"
#include "tessera/program/printable.hpp"

namespace tessera::io {

using tessera::printable;

/// Runs `work`, which reads a file, and cleans its errors. The message becomes one printable line, whatever it quotes
/// from the file; if the message begins with `source`, `source` remains its subject. Running out of memory becomes
/// Error(system_failure).
template <class Work>
auto with_clean_errors(const std::string& source, const Work& work) {
  try {
    return work();
  } catch (const scene::Error& e) {
    // The message may quote arbitrary bytes of a file.
    throw scene::with_subject(scene::Error(e.code(), printable(e.what())), printable(source));
  } catch (const std::bad_alloc&) {
    throw scene::Error(scene::ErrorCode::system_failure, source, "memory ran out",
                       "use a larger machine or a part of the mesh");
  }
}

/// Returns the error bad_input for a damaged file.
inline scene::Error damaged(const std::filesystem::path& file, const std::string& what) {
  return scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it again", file.string(), what));
}

/// Throws Error(bad_input) if a time step is requested from a file without time steps.
inline void require_no_time_step(std::optional<std::size_t> time_step, const std::string& source) {
  if (time_step.value_or(0) > 0)
    throw scene::bad_input(fmt::format(
        "{}: there is no time step {}, because the file has no time steps; leave `time_step` out", source, *time_step));
}

}  // namespace tessera::io
