// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tessera/program/render_options.hpp"

/// Conversion of option words to values, by subject: the parts of render_options(), which throw as it does.
namespace tessera::api {

/// `all`, FIRST:LAST or FIRST:LAST:STRIDE of --time-step; no value for other words, which name one step.
std::optional<StepRange> time_steps(const OptionWords& words);

/// transfer_function_of() with the library's setting names in messages.
LoadedTransferFunction chosen_function(const Dataset& data, const RenderOptions& options);
/// How images are written to files.
ImageFileOptions image_options(const OptionWords& words);

void set_function(const OptionWords& words, RenderOptions& options);
void set_view(const OptionWords& words, RenderOptions& options);

/// Includes the triangles of files; names of blocks are added to `blocks`.
Surfaces surfaces_of(const OptionWords& words, std::vector<BlockSurfaceWord>& blocks);
/// Only the iso-surfaces.
std::vector<IsoSurface> iso_surfaces_of(const OptionWords& words);
/// A warning for each iso-surface whose value is outside `range`, the field's.
std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range);

/// How pixels are computed, once it is known whether the data are meshes or grids.
void set_method(const OptionWords& words, RenderOptions& options);
/// Without options of devices: no backends, which means the CPU.
DeviceSettings device_settings(const OptionWords& words, bool for_volume);
/// Jobs of several ranks.
void set_ranks(const OptionWords& words, RenderOptions& options);

/// Images, films and standard output.
void set_outputs(const OptionWords& words, RenderOptions& options);
/// The contents of images: deep samples, layers, annotation. The method must already be set.
void set_pictures(const OptionWords& words, RenderOptions& options);

/// `image` has the background and colours of the image.
AnnotationOptions annotation_options(const OptionWords& words, const ImageFileOptions& image);

}  // namespace tessera::api
