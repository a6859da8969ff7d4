#pragma once

#include <vector>

#include "apps/frame_list.hpp"
#include "apps/render_options.hpp"

namespace tessera::apps {

/// Before any reading or rendering: can everything this run promises be written?
/// Throws scene::Error(bad_input) for an unknown extension, a folder that is missing or closed to us, two outputs of
/// one name, or an output that is one of the inputs; Error(system_failure) if a picture cannot fit in this machine's
/// memory.
void check_outputs(const RenderOptions& options, const std::vector<Frame>& frames);

/// The same for one file that is neither input nor picture.
void check_output_file(const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace tessera::apps
