// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/render/picture_writer.hpp"
#include "tessera/dataset.hpp"
#include "tessera/deep_image.hpp"
#include "tessera/image.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera::apps {

/// Checks, before anything is read, that the annotation may be valid for some data. Throws the same errors as
/// validate(const Annotation&) and fill_in().
void check_annotation(const AnnotationOptions& options);

/// Checks the annotation completely, before anything is rendered.
void check_annotation(const AnnotationOptions& options, const FilmFrame& frame, const Dataset& data,
                      const TransferFunction& function);

/// The data from which a frame's annotation is made.
struct AnnotatedFrame {
  const FilmFrame& frame;
  Camera camera;  ///< camera of the frame
  Dataset data;   ///< the frame's time step
  TransferFunction function;
  const RenderOptions& options;
};

/// Draws a frame's annotation, if there is any, over an image of any size. Throws the same errors as annotate().
void draw_annotation(Image& picture, const AnnotatedFrame& annotated);

/// Writes a frame's images with the annotation. With --annotation-layer, the images are not annotated, and the last
/// output of the frame is the layer. Deep images are never annotated. Throws the same errors as PictureWriter::write().
void write_annotated(const Image& image, const DeepImage& deep, const AnnotatedFrame& annotated, PictureWriter& writer);

}  // namespace tessera::apps
