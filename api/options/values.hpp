// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tessera/program/render_options.hpp"

/// Conversion of option words to values: the parts of render_options(), each for one subject. They throw the same
/// errors.
namespace tessera::api {

/// Reads `all`, FIRST:LAST or FIRST:LAST:STRIDE of --time-step. Returns none for any other word, which denotes a single
/// step.
std::optional<StepRange> time_steps(const OptionWords& words);

/// Does the same as transfer_function_of(), but its messages contain the library's names of settings.
LoadedTransferFunction chosen_function(const Dataset& data, const RenderOptions& options);
/// Options for writing images to files.
ImageFileOptions image_options(const OptionWords& words);

void set_function(const OptionWords& words, RenderOptions& options);
void set_view(const OptionWords& words, RenderOptions& options);

/// The surfaces, including the triangles of files. Names of blocks are added to `blocks`.
Surfaces surfaces_of(const OptionWords& words, std::vector<BlockSurfaceWord>& blocks);
/// Only the iso-surfaces of surfaces_of().
std::vector<IsoSurface> iso_surfaces_of(const OptionWords& words);
/// Returns a warning for each iso-surface whose value is outside the field's range, `range`.
std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range);

/// Sets how pixels are computed. It must be known whether the data are meshes or grids.
void set_method(const OptionWords& words, RenderOptions& options);
/// The settings of devices. Without options for devices there are no backends, which means the CPU.
DeviceSettings device_settings(const OptionWords& words, bool for_volume);
/// Sets the options for jobs of several ranks.
void set_ranks(const OptionWords& words, RenderOptions& options);

/// Sets the options for images, films and standard output.
void set_outputs(const OptionWords& words, RenderOptions& options);
/// Sets the contents of images: deep samples, layers, annotation. The method must already be set.
void set_pictures(const OptionWords& words, RenderOptions& options);

/// The annotation. `image` contains the background and the colours of the image.
AnnotationOptions annotation_options(const OptionWords& words, const ImageFileOptions& image);

}  // namespace tessera::api
