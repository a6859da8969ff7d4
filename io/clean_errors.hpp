#pragma once

#include <fmt/format.h>

#include <new>
#include <string>

#include "io/mesh_reader.hpp"
#include "scene/error.hpp"

namespace tessera::io {

/// Runs one reading of a mesh: its errors come out in one line whatever they quote, and memory that runs out as
/// Error(system_failure).
template <class Work>
auto with_clean_errors(const std::string& source, const Work& work) {
  try {
    return work();
  } catch (const scene::Error& e) {
    std::string message = e.what();  // may quote what a file holds, which may be anything
    for (char& c : message)
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
    throw scene::Error(e.code(), message);
  } catch (const std::bad_alloc&) {
    throw scene::Error(scene::ExitCode::system_failure,
                       fmt::format("{}: memory ran out; use a larger machine or a part of the mesh", source));
  }
}

/// Throws Error(bad_input) if a time step is asked of a file that has none.
inline void require_no_time_step(const MeshOptions& options, const std::string& source) {
  if (options.time_step.value_or(0) > 0)
    throw scene::bad_input(
        fmt::format("{}: there is no time step {}, the file has none; leave it out", source, *options.time_step));
}

}  // namespace tessera::io
