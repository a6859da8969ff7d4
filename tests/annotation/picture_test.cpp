// SPDX-License-Identifier: BSD-3-Clause
// Position and colour of everything drawn, checked by the pixels of finished images.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <thread>

#include "annotation/small_pictures.hpp"
#include "support/some_cases.hpp"
#include "tessera/error.hpp"

namespace tessera::annotation {
namespace {

const Box box{{-1, -2, -3}, {4, 5, 6}};

/// Returns the pixel position of a point, computed independently of the library.
glm::dvec2 pixel_of(const View& view, const glm::dvec3& p) {
  const Camera& c = view.camera;
  const glm::dvec3 forward = glm::normalize(c.focal_point - c.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, c.view_up)), up = glm::cross(right, forward);
  const glm::dvec3 d = p - c.position;
  const double half = c.projection == ProjectionKind::perspective
                          ? glm::dot(d, forward) * std::tan(c.view_angle * std::numbers::pi / 360)
                          : c.parallel_scale;
  const double scale = view.size.height / (2 * half);
  return {view.size.width / 2.0 + scale * glm::dot(d, right), view.size.height / 2.0 - scale * glm::dot(d, up)};
}

std::vector<View> views() {
  std::vector<View> list;
  for (const ImageSize size : {ImageSize{1300, 1100}, {300, 500}, {640, 200}})
    for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective})
      list.push_back({frame_box(box, size, kind), size});
  list.push_back({perspective({1, 1, 1}, {4, 3, 2}, 100), {400, 300}});  // inside the box
  list.push_back({orthographic({1, 1, 12}, {1, 1, 0}, 5), {333, 222}});  // head on
  return list;
}

TEST(AnnotatedPicture, TheOutlinesEdgesAreWhereTheCameraSeesThem) {
  Annotation outline;
  outline.outline = Outline{};
  for (const View& view : views()) {
    const Image layer = annotation_layer(empty_picture(view.size), outline, view, box, {});
    std::vector<char> near_an_edge(layer.depth.size());
    const glm::dvec3 forward = glm::normalize(view.camera.focal_point - view.camera.position);
    int on_picture = 0;
    constexpr int reach = 6;  // largest distance in pixels of ink and halo from an edge, for any image size
    for (int bits = 0; bits < 8; ++bits)
      for (int axis = 0; axis < 3; ++axis) {
        if ((bits >> axis & 1) != 0) continue;
        constexpr int steps = 4000;
        for (int i = 0; i <= steps; ++i) {
          glm::dvec3 p{(bits & 1) != 0 ? box.high.x : box.low.x, (bits & 2) != 0 ? box.high.y : box.low.y,
                       (bits & 4) != 0 ? box.high.z : box.low.z};
          p[axis] = box.low[axis] + (box.high[axis] - box.low[axis]) * i / steps;
          if (glm::dot(p - view.camera.position, forward) < 1e-3) continue;
          const glm::dvec2 at = pixel_of(view, p);
          const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
          for (int v = std::max(y - reach, 0); v <= std::min(y + reach, view.size.height - 1); ++v)
            for (int u = std::max(x - reach, 0); u <= std::min(x + reach, view.size.width - 1); ++u)
              near_an_edge[layer.index(u, v)] = 1;
          if (x < 0 || y < 0 || x >= view.size.width || y >= view.size.height) continue;
          ++on_picture;
          // The coverages of the pixel of a point and its neighbours by a line one pixel wide through the point sum to
          // one.
          float ink = 0;
          for (int v = std::max(y - 1, 0); v <= std::min(y + 1, view.size.height - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, view.size.width - 1); ++u)
              ink += black_ink(layer, u, v);
          ASSERT_GT(ink, 0.9) << x << " " << y << " of " << view.size.width << "x" << view.size.height;
        }
      }
    ASSERT_GT(on_picture, 3000);
    for (std::size_t i = 0; i < near_an_edge.size(); ++i)
      if (near_an_edge[i] == 0) {
        ASSERT_EQ(layer.rgba[4 * i + 3], 0) << i % static_cast<std::size_t>(view.size.width);
      }
  }
}

TEST(AnnotatedPicture, EdgesBehindTheDataAreSeenThroughIt) {
  Annotation outline;
  outline.outline = Outline{};
  const View view{frame_box(box, {300, 300}), {300, 300}};
  const Image bare = annotation_layer(empty_picture(view.size), outline, view, box, {});
  Image opaque = plain_picture(view.size, 0.25F, 1), half = plain_picture(view.size, 0.25F, 0.5F);
  annotate(opaque, outline, view, box, {});
  annotate(half, outline, view, box, {});
  // The far corner is behind everything; the near one is in front. Both are well inside the outline.
  const ViewBasis basis = view_basis(view.camera);
  int far = 0, near = 0;
  for (int bits = 0; bits < 8; ++bits) {
    const double depth = glm::dot(corner(box, bits), basis.forward);
    if (depth > glm::dot(corner(box, far), basis.forward)) far = bits;
    if (depth < glm::dot(corner(box, near), basis.forward)) near = bits;
  }
  int seen = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_far : {false, true}) {
      const int from = is_far ? far : near;
      const glm::dvec2 at = pixel_of(view, corner(box, from) * 0.7 + corner(box, from ^ 1 << axis) * 0.3);
      const std::size_t i = bare.index(static_cast<int>(at.x), static_cast<int>(at.y));
      const float line_light = bare.rgba[4 * i], line_alpha = bare.rgba[4 * i + 3];
      ASSERT_GT(line_alpha, 0.3);
      ++seen;
      // P and A are light and alpha of the image, L and a those of the line. A line behind the image gives P + (1 - A)
      // L, a line in front of it L + (1 - a) P. The tolerance is that of floats.
      const float through = is_far ? 0.25F + 0.5F * line_light : line_light + (1 - line_alpha) * 0.25F;
      EXPECT_NEAR(half.rgba[4 * i], through, 1e-6);
      EXPECT_NEAR(half.rgba[4 * i + 3], is_far ? 0.5F + 0.5F * line_alpha : line_alpha + (1 - line_alpha) * 0.5F, 1e-6);
      EXPECT_NEAR(opaque.rgba[4 * i], is_far ? 0.25F : line_light + (1 - line_alpha) * 0.25F, 1e-6);
    }
  EXPECT_EQ(seen, 6);
}

TEST(AnnotatedPicture, TheScaleBarHasTheLengthOfItsLabel) {
  Annotation annotation;
  annotation.scale_bar = ScaleBar{};
  annotation.style.text_size = 13;  // lines of one pixel
  struct Case {
    Camera camera;
    ImageSize size;
    double length;  ///< world units: the largest 1, 2 or 5 times a power of ten within a quarter of the image's width
  };
  // Orthographic: 2.5 pixels per unit, so that a quarter of 800 pixels is 80 units. Perspective: the window at the
  // focal point is 20 units high.
  for (const Case& c : {Case{orthographic({0, 0, 1}, {}, 120), {800, 600}, 50},
                        Case{orthographic({0, 0, 1}, {}, 3e-7), {801, 600}, 2e-7},
                        Case{orthographic({0, 0, 1}, {}, 3e20), {900, 600}, 2e20},
                        Case{perspective({0, 0, 10}, {}, 90), {900, 600}, 5}}) {
    const View view{c.camera, c.size};
    const Image layer = annotation_layer(empty_picture(c.size), annotation, view, {}, {});
    const double window = c.camera.projection == ProjectionKind::perspective ? 20 : 2 * c.camera.parallel_scale;
    double longest = 0;  // row with the most ink
    for (int y = 0; y < c.size.height; ++y) {
      double row = 0;
      for (int x = 0; x < c.size.width; ++x) row += black_ink(layer, x, y);
      longest = std::max(longest, row);
    }
    // The length is measured between the centres of the end lines, which extend half a pixel further at each side.
    // Coverage has 8 bits.
    EXPECT_NEAR(longest - 1, c.length / window * c.size.height, 0.02) << c.length;
  }
}

/// The bar's colours, from its low end up: all pixels with exactly this green.
std::vector<glm::vec3> bar_colors(const Image& layer, bool upright, float green) {
  std::vector<glm::vec3> colors, along;
  const int outer = upright ? layer.size.width : layer.size.height,
            inner = upright ? layer.size.height : layer.size.width;
  for (int i = 0; i < outer && colors.empty(); ++i) {
    for (int j = 0; j < inner; ++j) {
      const float* pixel = &layer.rgba[4 * (upright ? layer.index(i, inner - 1 - j) : layer.index(j, i))];
      if (pixel[1] == green && pixel[3] == 1) colors.emplace_back(pixel[0], pixel[1], pixel[2]);
    }
  }
  return colors;
}

TEST(AnnotatedPicture, TheColourBarHasTheTransferFunctionsColours) {
  const TransferFunction function({{1, {0.0, 0.1234, 1.0}, 0},
                                   {10, {0.5, 0.1234, 0.25}, 1},
                                   {10, {3.0, 0.1234, 0.0}, 1},  // a step, and light above 1
                                   {1000, {1.0, 0.1234, 0.5}, 2}});
  for (const Place place : {Place::right, Place::left, Place::top, Place::bottom, Place::bottom_right})
    for (const bool logarithmic : {false, true}) {
      Annotation annotation;
      annotation.color_bar = ColorBar{.title = "T", .place = place, .logarithmic = logarithmic};
      const View view{{}, {400, 300}};
      const Image layer = annotation_layer(empty_picture(view.size), annotation, view, {}, function);
      const auto colors = bar_colors(layer, place == Place::right || place == Place::left, 0.1234F);
      ASSERT_GT(colors.size(), 120u);
      for (std::size_t i = 0; i < colors.size(); ++i) {
        const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(colors.size());
        const double value = logarithmic ? std::pow(10, 3 * t) : 1 + 999 * t;
        const glm::vec3 color = function.evaluate(value).color;
        // Colours are floats. The logarithmic value has an error of about 1e-15, and colours change by at most 2 over a
        // range of 990.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(colors[i][c], color[c], 1e-6) << i << " of " << colors.size();
      }
    }
}

TEST(AnnotatedPicture, TheColourBarShowsTheRangeThatIsAskedFor) {
  const TransferFunction function({{0, {0.0, 0.1234, 1.0}, 0}, {8, {1.0, 0.1234, 0.0}, 1}});
  Annotation annotation;
  annotation.color_bar = ColorBar{.range = std::array{-8.0, 8.0}};
  const Image layer = annotation_layer(empty_picture({400, 300}), annotation, {{}, {400, 300}}, {}, function);
  const auto colors = bar_colors(layer, true, 0.1234F);
  ASSERT_GT(colors.size(), 100u);
  EXPECT_EQ(colors[colors.size() / 3], glm::vec3(0, 0.1234F, 1));  // clamped below 0
  EXPECT_NEAR(colors.back().x, 1, 0.01);
}

TEST(AnnotatedPicture, TheLayerOverThePictureIsTheAnnotatedPicture) {
  for (const View& view : views()) {
    for (const bool background : {false, true}) {
      Annotation annotation = everything();
      if (background) annotation.style.background = glm::dvec3(0.5);
      const Image picture = noise(view.size, 5);
      const Image layer = annotation_layer(picture, annotation, view, box, ramp());
      Image annotated = picture;
      annotate(annotated, annotation, view, box, ramp());
      std::size_t touched = 0;
      for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        const float alpha = layer.rgba[i / 4 * 4 + 3];
        if (alpha > 0) ++touched;
        const float over = layer.rgba[i] + (1 - alpha) * picture.rgba[i];
        ASSERT_NEAR(annotated.rgba[i], over, 2e-7);  // a product and a sum of floats, perhaps fused
        if (alpha == 0) {
          ASSERT_EQ(annotated.rgba[i], picture.rgba[i]);
        }
      }
      EXPECT_GT(touched, picture.rgba.size() / 100);
      EXPECT_LT(touched, picture.rgba.size() / 2);
      EXPECT_EQ(annotated.depth, picture.depth);
    }
  }
}

bool same_bits(const Image& a, const Image& b) {
  return a.rgba.size() == b.rgba.size() &&
         std::memcmp(a.rgba.data(), b.rgba.data(), a.rgba.size() * sizeof(float)) == 0;
}

TEST(AnnotatedPicture, HasTheSameBitsOnAnyThread) {
  const View view{frame_box(box, {500, 400}), {500, 400}};
  const Image picture = noise(view.size, 1);
  const auto drawn = [&] { return annotation_layer(picture, everything(), view, box, ramp()); };
  const Image first = drawn();
  std::array<Image, 4> images;
  std::vector<std::thread> threads;
  for (Image& image : images) threads.emplace_back([&image, &drawn] { image = drawn(); });
  for (std::thread& thread : threads) thread.join();
  for (const Image& image : images) EXPECT_TRUE(same_bits(first, image));
}

TEST(AnnotatedPicture, LinesDoNotDependOnTheWorldsUnit) {
  Annotation lines;
  lines.outline = Outline{};
  lines.axes = Axes{};
  const ImageSize size{200, 200};
  for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    const auto drawn = [&](double unit) {
      const Box scaled{box.low * unit, box.high * unit};
      Camera camera = frame_box(box, size, kind);
      camera.position *= unit;
      camera.focal_point *= unit;
      camera.parallel_scale *= unit;
      return annotation_layer(empty_picture(size), lines, {camera, size}, scaled, {});
    };
    const Image one = drawn(1);
    for (const double unit : {0x1p-70, 0x1p70}) EXPECT_TRUE(same_bits(one, drawn(unit))) << unit;  // 1e-21, 1e21
  }
}

TEST(AnnotatedPicture, AnySizeAndViewGivesFiniteLightAndNoMoreThanFullAlpha) {
  std::vector<View> all = views();
  for (const int width : {1, 2, 7, 16, 33, 64, 200})
    for (const int height : {1, 5, 20, 64}) all.push_back({frame_box(box, {width, height}), {width, height}});
  const std::array<Box, 6> boxes{box,
                                 Box{},
                                 Box{{1, 1, 1}, {1, 1, 1}},                         // a point
                                 Box{{0, 0, 2}, {5, 5, 2}},                         // flat
                                 Box{{7.388e6, 3.5e5, -3}, {7.3881e6, 3.51e5, 4}},  // far from the origin
                                 Box{{-1e300, -1e300, 0}, {1e300, 1e300, 1}}};
  test::SomeCases some(7);
  for (const View& view : all)
    for (const Box& b : boxes)
      for (const auto place : {Place::right, Place::bottom, Place::top_left}) {
        if (!some.next()) continue;
        Annotation annotation = everything();
        annotation.color_bar->place = annotation.axes->place = annotation.scale_bar->place = place;
        const Image layer =
            annotation_layer(plain_picture(view.size, 0.5F, 0.5F), annotation, view, b, ramp(1e6, 1.001e6));
        for (std::size_t i = 0; i < layer.rgba.size(); ++i) {
          ASSERT_TRUE(std::isfinite(layer.rgba[i]));
          ASSERT_GE(layer.rgba[i], 0);
          ASSERT_LE(layer.rgba[i], 1.00001);  // rounding
        }
      }
}

TEST(AnnotatedPicture, AConstantFieldHasABarOfOneValue) {
  Annotation annotation;
  annotation.color_bar = ColorBar{.title = "constant"};
  for (const bool logarithmic : {false, true}) {
    annotation.color_bar->logarithmic = logarithmic;
    const TransferFunction function({{293, {0.5, 0.1234, 0.5}, 1}});
    const Image layer = annotation_layer(empty_picture({300, 300}), annotation, {{}, {300, 300}}, {}, function);
    const auto colors = bar_colors(layer, true, 0.1234F);
    ASSERT_GT(colors.size(), 100u);
    for (const auto& color : colors) EXPECT_EQ(color, glm::vec3(0.5F, 0.1234F, 0.5F));
  }
}

std::string complaint(const Annotation& annotation, const TransferFunction& function = ramp()) {
  try {
    validate(annotation, function);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return {};
}

TEST(AnnotatedPicture, NamesWhatCannotBeDrawn) {
  EXPECT_EQ(complaint({}), "");
  EXPECT_EQ(complaint(everything()), "");
  Annotation logarithmic;
  logarithmic.color_bar = ColorBar{.logarithmic = true};
  EXPECT_NE(complaint(logarithmic).find("0 to 10, includes 0 or negative values"), std::string::npos)
      << complaint(logarithmic);
  EXPECT_EQ(complaint(logarithmic, ramp(1, 10)), "");
  logarithmic.color_bar->range = std::array{0.5, 10.0};
  EXPECT_EQ(complaint(logarithmic), "");
  logarithmic.color_bar->range = std::array{10.0, 0.5};
  EXPECT_NE(complaint(logarithmic).find("ascending"), std::string::npos);
  for (const double size : {0.0, -1.0, 1e4, std::nan("")}) {
    Annotation sized;
    sized.style.text_size = size;
    EXPECT_NE(complaint(sized).find("`annotation_size`"), std::string::npos) << size;
  }
  Annotation colored;
  colored.style.ink = glm::dvec3(0, -1, 0);
  EXPECT_NE(complaint(colored).find("`annotation_color`: component 2 is -1"), std::string::npos) << complaint(colored);
}

TEST(AnnotatedPicture, RefusesAnImageOfAnotherSizeThanTheView) {
  Image picture({8, 8});
  EXPECT_THROW(annotate(picture, {}, {{}, {8, 9}}, {}, {}), Error);
  EXPECT_THROW(annotate(picture, {}, {orthographic({0, 0, 1}, {}, -1), {8, 8}}, {}, {}), Error);
  picture.rgba.pop_back();
  EXPECT_THROW(annotate(picture, {}, {{}, {8, 8}}, {}, {}), Error);
}

}  // namespace
}  // namespace tessera::annotation
