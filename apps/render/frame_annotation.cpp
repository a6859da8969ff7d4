// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/frame_annotation.hpp"

namespace tessera::apps {
namespace {

Annotation filled(const Annotation& annotation, const FilmFrame& frame, const Dataset& data) {
  const double time = frame.data.has_time ? frame.data.time : data.time().value_or(frame.data.time);
  const std::string file = frame.data.files.front().filename().string();
  return filled_annotation(annotation, annotation_values(data, time, file, frame.number));
}

}  // namespace

void check_annotation(const AnnotationOptions& options) {
  if (!options.annotation) return;
  Annotation annotation = filled_annotation(*options.annotation, {});
  // Without a given range, the colour bar's range depends on the transfer function, which is not known yet.
  if (annotation.color_bar && !annotation.color_bar->range) annotation.color_bar.reset();
  validate(annotation, {});
}

void check_annotation(const AnnotationOptions& options, const FilmFrame& frame, const Dataset& data,
                      const TransferFunction& function) {
  if (options.annotation) validate(filled(*options.annotation, frame, data), function);
}

void draw_annotation(Image& picture, const AnnotatedFrame& annotated) {
  const auto& [frame, camera, data, function, options] = annotated;
  if (!options.annotation.annotation) return;
  const Annotation annotation = filled(*options.annotation.annotation, frame, data);
  annotate(picture, annotation, {camera, picture.size}, data.bounds(), function);
}

void write_annotated(const Image& image, const DeepImage& deep, const AnnotatedFrame& annotated,
                     PictureWriter& writer) {
  const auto& [frame, camera, data, function, options] = annotated;
  const AnnotationOptions& asked = options.annotation;
  if (!asked.annotation) return writer.write(image, deep, frame);
  if (asked.layer.empty()) {
    Image picture = image;  // a copy, because the image without annotation is verified later
    draw_annotation(picture, annotated);
    return writer.write(picture, deep, frame);
  }
  const Annotation annotation = filled(*asked.annotation, frame, data);
  const View view{camera, frame.size};
  FilmFrame bare = frame;
  bare.outputs.pop_back();
  writer.write(image, deep, bare);
  ImageFileOptions transparent = options.image;
  transparent.background.reset();
  PictureWriter::write_file(annotation_layer(image, annotation, view, data.bounds(), function), frame.outputs.back(),
                            transparent);
}

}  // namespace tessera::apps
