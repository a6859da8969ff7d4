#pragma once

#include "apps/annotation_options.hpp"
#include "apps/render_options.hpp"
#include "tessera/dataset.hpp"
#include "tessera/deep_image.hpp"
#include "tessera/film.hpp"
#include "tessera/image.hpp"

namespace tessera::apps {

/// Says before anything is read what is wrong with it whatever the data is. Throws as validate(const Annotation&) and
/// fill_in().
void check_annotation(const AnnotationOptions& options);

/// The same before anything is rendered.
void check_annotation(const AnnotationOptions& options, const FilmFrame& frame, const Dataset& data,
                      const TransferFunction& function);

/// Writes a frame's pictures as write_pictures() does, annotated; with --annotation-layer they stay bare, and the
/// frame's last output is the layer. Deep pictures are never annotated. `camera` is the frame's, `data` its time step.
void write_annotated(const Image& image, const DeepImage& deep, const FilmFrame& frame, const Camera& camera,
                     const Dataset& data, const TransferFunction& function, const RenderOptions& options);

}  // namespace tessera::apps
