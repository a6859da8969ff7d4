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

/// Checks before anything is read whether the annotation is valid for any data. Throws as validate(const Annotation&)
/// and fill_in().
void check_annotation(const AnnotationOptions& options);

/// The complete check, before anything is rendered.
void check_annotation(const AnnotationOptions& options, const FilmFrame& frame, const Dataset& data,
                      const TransferFunction& function);

/// A frame and the sources of its annotation.
struct AnnotatedFrame {
  const FilmFrame& frame;
  Camera camera;  ///< the frame's
  Dataset data;   ///< its time step
  TransferFunction function;
  const RenderOptions& options;
};

/// Draws a frame's annotation, if there is any, over its image, whatever its size. Throws as annotate().
void draw_annotation(Image& picture, const AnnotatedFrame& annotated);

/// Writes a frame's images, annotated. With --annotation-layer they are not annotated, and the frame's last output is
/// the layer. Deep images are never annotated. Throws as PictureWriter::write().
void write_annotated(const Image& image, const DeepImage& deep, const AnnotatedFrame& annotated, PictureWriter& writer);

}  // namespace tessera::apps
