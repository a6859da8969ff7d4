// SPDX-License-Identifier: BSD-3-Clause
// Replaces the drawing sources if TESSERA_CAIRO is OFF.
#include "tessera/annotation.hpp"
#include "tessera/error.hpp"

namespace tessera {
inline namespace v0_1 {

// An annotation without elements does not need Cairo.
void validate(const Annotation& annotation, const TransferFunction&) {
  if (!annotation.color_bar && !annotation.axes && !annotation.outline && !annotation.scale_bar &&
      annotation.texts.empty())
    return;
  throw bad_input(
      "annotation: needs Cairo, which this build leaves out; build with TESSERA_CAIRO=ON, or leave the annotation out");
}

void annotate(Image&, const Annotation& annotation, const View&, const Box&, const TransferFunction& function) {
  validate(annotation, function);
}

Image annotation_layer(const Image& picture, const Annotation& annotation, const View&, const Box&,
                       const TransferFunction& function) {
  validate(annotation, function);
  return Image(picture.size);
}

}  // namespace v0_1
}  // namespace tessera
