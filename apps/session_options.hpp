#pragma once

#include "apps/render_options.hpp"
#include "tessera/dataset.hpp"
#include "tessera/settings.hpp"

/// The command line's values in the library's words.
namespace tessera::apps {

Settings session_settings(const RenderOptions& options);

ReadOptions read_options(const io::MeshOptions& options);
ReadOptions read_options(const io::VolumeOptions& options);
ReadOptions read_options(const RenderOptions& options);

/// How later steps of a time series are read: their field is the one that was chosen for the first step. A field that
/// varies in one step and not in the next would else make the film jump to another.
ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first);

/// The transfer function that the options name, or the default one, its words as the program says them.
LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options);

}  // namespace tessera::apps
