// SPDX-License-Identifier: BSD-3-Clause
// A file to a picture that explains itself, and the explanation alone as a layer.
#include <iostream>

#include "tessera/tessera.hpp"

int main(int argc, char** argv) try {
  if (argc != 2) throw tessera::bad_input("arguments: give a mesh or a grid");
  const tessera::Dataset data = tessera::Dataset::open(argv[1]);
  const tessera::View view = data.default_view({640, 480});
  const tessera::TransferFunction function = data.transfer_function("viridis").function;

  tessera::Annotation annotation;
  annotation.color_bar = tessera::ColorBar{.title = data.field_name()};
  annotation.axes = tessera::Axes{.triad = true, .box = true};
  annotation.outline = tessera::Outline{};
  annotation.scale_bar = tessera::ScaleBar{};
  annotation.texts = {{data.source(), tessera::Place::top}};
  annotation.style.background = glm::dvec3(1);  // write_image() below uses the same background
  validate(annotation, function);               // throws if the annotation is not valid, before rendering

  auto frame = tessera::Session(data).render(view, function);
  tessera::write_image(tessera::annotation_layer(frame.image, annotation, view, data.bounds(), function), "layer.png");
  tessera::annotate(frame.image, annotation, view, data.bounds(), function);
  tessera::write_image(frame.image, "annotated.png", {.background = annotation.style.background});
  std::cout << "annotated.png and layer.png\n";
} catch (const tessera::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
