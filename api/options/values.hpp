// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tessera/program/render_options.hpp"

/// Words of options to values, by subject: the parts of render_options(), and the functions that throw as it does.
namespace tessera::api {

/// `all`, or FIRST:LAST, or FIRST:LAST:STRIDE of --time-step; nothing for other words, which are one step.
std::optional<StepRange> time_steps(const OptionWords& words);

void set_function(const OptionWords& words, RenderOptions& options);
void set_view(const OptionWords& words, RenderOptions& options);

/// With the triangles of files; names of blocks go to `blocks`.
Surfaces surfaces_of(const OptionWords& words, std::vector<BlockSurfaceWord>& blocks);
/// Of them those of a value.
std::vector<IsoSurface> iso_surfaces_of(const OptionWords& words);
/// A warning for each surface of a value that the field does not have.
std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range);

/// How pixels are computed, once it is known whether of meshes or grids.
void set_method(const OptionWords& words, RenderOptions& options);
/// Nothing given: no backends, which is the CPU without a word about devices.
DeviceSettings device_settings(const OptionWords& words, bool for_volume);
/// Jobs of several ranks.
void set_ranks(const OptionWords& words, RenderOptions& options);

/// Pictures, films and standard output.
void set_outputs(const OptionWords& words, RenderOptions& options);
/// How pictures become files, and what they contain: deep samples, layers. The method is set already.
void set_pictures(const OptionWords& words, RenderOptions& options);

/// `image` has the picture's background and colours.
AnnotationOptions annotation_options(const OptionWords& words, const ImageFileOptions& image);

}  // namespace tessera::api
