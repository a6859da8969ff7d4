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

/// Says before anything is read what is wrong with it whatever the data is. Throws as validate(const Annotation&) and
/// fill_in().
void check_annotation(const AnnotationOptions& options);

/// The same before anything is rendered.
void check_annotation(const AnnotationOptions& options, const FilmFrame& frame, const Dataset& data,
                      const TransferFunction& function);

/// A frame and what its annotation tells of.
struct AnnotatedFrame {
  const FilmFrame& frame;
  Camera camera;  ///< the frame's
  Dataset data;   ///< its time step
  TransferFunction function;
  const RenderOptions& options;
};

/// Draws a frame's annotation, if there is any, over its picture, of whatever size that is. Throws as annotate().
void draw_annotation(Image& picture, const AnnotatedFrame& annotated);

/// Writes a frame's pictures, annotated; with --annotation-layer they stay bare, and the frame's last output is the
/// layer. Deep pictures are never annotated. Throws as PictureWriter::write().
void write_annotated(const Image& image, const DeepImage& deep, const AnnotatedFrame& annotated, PictureWriter& writer);

}  // namespace tessera::apps
