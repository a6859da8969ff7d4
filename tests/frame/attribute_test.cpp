// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "datasets/boxes.hpp"
#include "frame/mesh/double_source.hpp"
#include "projection/tile_lists.hpp"
#include "reference/view.hpp"

/// Segments that carry a second linear value in addition to the scalar. Here it is the light that reaches each point.
/// It is linear in space, so the light of a ray through a mesh of uniform extinction has a closed form.
namespace tessera::frame::attribute_test {
namespace {

constexpr double extinction = 0.8;
constexpr glm::dvec3 gradient{0.3, -0.2, 0.25};
double light_at(const glm::dvec3& p) { return 1.5 + glm::dot(gradient, p); }

/// Integral over [0, length] of extinction * (from + slope t) * exp(-extinction t).
double scattered(double from, double slope, double length) {
  const double through = std::exp(-extinction * length);
  return from * (1 - through) + slope * ((1 - through) / extinction - length * through);
}

/// A user of the extension point: emission scaled by the attribute, segment after segment.
class LightSink final : public compositor::TileSink<sorting::AttributeEncoding> {
 public:
  std::vector<double> light;

  LightSink(const projection::PixelSpace& space, scene::ImageSize size) : space_(&space), width_(size.width) {
    const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    light.assign(pixels, 0);
    transmittance_.assign(pixels, 1);
  }

  void start(const scene::PixelRect& rect) override {
    rect_ = rect;
    open_.assign(static_cast<std::size_t>(rect.area()), 1);
  }
  void take(Store& lists, double final_depth, std::size_t, scene::StageTimer&) override {
    lists.sort();
    const projection::AttributeSegments& s = lists.segments;
    for (std::size_t p = 0; p < lists.pixels(); ++p) {
      const int x = rect_.x0 + static_cast<int>(p) % rect_.width(), y = rect_.y0 + static_cast<int>(p) / rect_.width();
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      for (const auto& entry : lists.pixel(p)) {
        if (!(entry.depth < final_depth)) break;
        const std::uint32_t i = entry.segment;
        const double length = (s.back[i] - s.front[i]) * space_->length_per_depth(x + 0.5, y + 0.5);
        if (!(length > 0)) continue;
        light[at] += transmittance_[at] *
                     scattered(s.attribute_front[i], (s.attribute_back[i] - s.attribute_front[i]) / length, length);
        transmittance_[at] *= std::exp(-extinction * length);
      }
    }
    segments_ += lists.remove(final_depth, open_);
  }
  bool take_unordered(Store&, double, scene::StageTimer&) override { return false; }
  [[nodiscard]] const std::vector<std::uint8_t>& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return true; }
  void finish() override {}
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  const projection::PixelSpace* space_;
  std::vector<double> transmittance_;
  int width_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::vector<std::uint8_t> open_;
  std::uint64_t segments_ = 0;
};

/// A mesh in a view, ready for tiles.
struct Scene {
  scene::TetMesh mesh;
  projection::PreparedMesh prepared;
  scene::ImageSize size{48, 40};
  scene::Camera camera;
  projection::PixelSpace space;
  scene::TransferFunction function;
  std::vector<projection::PixelVertex> vertices;
  std::vector<double> light;
  std::vector<projection::Step> steps;
  projection::CellsAtSteps at_steps;

  Scene(scene::TetMesh m, const scene::Camera& view, const scene::TransferFunction& f)
      : mesh(std::move(m)), prepared(mesh), camera(view), space(camera, size), function(f) {
    vertices.resize(mesh.positions.size());
    space.project(mesh.positions, vertices);
    for (const glm::dvec3& p : mesh.positions) light.push_back(light_at(p));
    steps = projection::steps_of(function, scene::Emission::absorption, 10);
    at_steps = projection::CellsAtSteps(prepared, steps, 10, nullptr);
  }

  /// Renders all tiles into `sink`. The buffers are small, so that each tile is flushed several times.
  template <class Source, class Sink>
  void render(Sink& sink) {
    const projection::ProjectedMesh projected{
        &prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent(), 0, light};
    const projection::TileGrid grid{size, 16};
    projection::TileLists lists(projected, grid, function, false);
    lists.fill(0, grid.count());
    TileContext context{&projected, lists.depth_origin(), 1 << 20, nullptr};
    context.steps = steps;
    context.at_steps = at_steps.empty() ? nullptr : &at_steps;
    TileRenderer<Source> renderer(context);
    for (std::size_t tile = 0; tile < grid.count(); ++tile) {
      sink.begin_tile(tile, grid.rect(tile));
      renderer.render(grid.rect(tile), lists.tile(tile), sink);
      sink.end_tile();
    }
  }
};

/// Depths at which the ray enters and leaves [-1, 1]^3, in front of the eye and inside the clipping range.
std::optional<std::array<double, 2>> through_box(const reference::View& view, const reference::View::Ray& ray) {
  double near = std::max(0.0, view.nearest()), far = view.farthest();
  for (int k = 0; k < 3; ++k) {
    double a = (-1 - ray.origin[k]) / ray.step[k], b = (1 - ray.origin[k]) / ray.step[k];
    if (a > b) std::swap(a, b);
    near = std::max(near, a), far = std::min(far, b);
  }
  if (!(near < far)) return std::nullopt;
  return std::array{near, far};
}

std::vector<scene::Camera> views() {
  scene::Camera oblique;
  oblique.position = {3.1, 2.3, 4.2};
  oblique.parallel_scale = 1.8;
  scene::Camera clipped = oblique;
  clipped.clipping_range = {{5.1, 6.2}};
  scene::Camera inside;
  inside.position = {0.3, -0.2, 0.1};
  inside.focal_point = {0.05, 0.9, 0.02};
  inside.view_up = {0, 0, 1};
  inside.projection = scene::ProjectionKind::perspective;
  inside.view_angle = 80;
  return {oblique, clipped, inside};
}

const scene::TransferFunction smooth({{-10, {1, 1, 1}, extinction}, {10, {1, 1, 1}, extinction}});

TEST(Attribute, LightThatIsLinearInSpaceIsIntegratedAsInClosedForm) {
  for (const scene::Camera& camera : views()) {
    Scene scene(datasets::cube(6), camera, smooth);
    LightSink sink(scene.space, scene.size);
    scene.render<DoubleSourceOf<projection::AttributeSegments>>(sink);
    const reference::View view(camera, scene.size);
    double most = 0;
    std::size_t seen = 0;
    for (int y = 0, at = 0; y < scene.size.height; ++y)
      for (int x = 0; x < scene.size.width; ++x, ++at) {
        const reference::View::Ray ray = view.ray(x + 0.5, y + 0.5);
        double expected = 0;
        if (const auto depth = through_box(view, ray)) {
          const auto point = [&](double z) { return ray.origin + z * ray.step; };
          const double length = glm::length(ray.step) * ((*depth)[1] - (*depth)[0]);
          const double from = light_at(point((*depth)[0])), to = light_at(point((*depth)[1]));
          expected = scattered(from, (to - from) / length, length);
          ++seen;
        }
        most = std::max(most, std::abs(sink.light[static_cast<std::size_t>(at)] - expected));
      }
    EXPECT_GT(seen, 300u);
    // Vertices are rounded to 2^-32 pixel (PixelSpace), here 2e-11 world units. Where a ray grazes the box, its entry
    // moves by a few tens of times this distance.
    EXPECT_LT(most, 1e-9);
  }
}

/// Where a step of the transfer function cuts a cell, the attribute is cut too: the sum over the pieces is the same.
TEST(Attribute, IsCutWithItsSegmentAtSteps) {
  scene::TetMesh mesh = datasets::cube(6);
  // All scalars are within the last places of a double from the step, so that cells need extra precision.
  for (std::size_t i = 0; i < mesh.scalars.size(); ++i) mesh.scalars[i] = i % 3 == 0 ? 0.5 : std::nextafter(0.5, i % 2);
  const scene::TransferFunction step(
      {{0, {1, 1, 1}, extinction}, {0.5, {1, 1, 1}, extinction}, {0.5, {0, 1, 0}, 2}, {1, {0, 1, 0}, 2}});
  Scene whole(mesh, views()[0], smooth), cut(mesh, views()[0], step);
  ASSERT_TRUE(whole.at_steps.empty());
  ASSERT_FALSE(cut.at_steps.empty());
  LightSink in_one(whole.space, whole.size), in_pieces(cut.space, cut.size);
  whole.render<DoubleSourceOf<projection::AttributeSegments>>(in_one);
  cut.render<DoubleSourceOf<projection::AttributeSegments>>(in_pieces);
  EXPECT_GT(in_pieces.segments(), in_one.segments());
  for (std::size_t p = 0; p < in_one.light.size(); ++p) EXPECT_NEAR(in_pieces.light[p], in_one.light[p], 1e-12);
}

/// Stores all segments, whichever values they carry.
template <class Segments>
class KeepingSink final : public compositor::TileSink<sorting::DoubleEncodingOf<Segments>> {
 public:
  using Store = typename sorting::DoubleEncodingOf<Segments>::Store;
  std::vector<std::array<double, 4>> kept;

  void start(const scene::PixelRect& rect) override { open_.assign(static_cast<std::size_t>(rect.area()), 1); }
  void take(Store& lists, double final_depth, std::size_t, scene::StageTimer&) override {
    lists.sort();
    const Segments& s = lists.segments;
    for (std::size_t p = 0; p < lists.pixels(); ++p)
      for (const auto& entry : lists.pixel(p))
        if (entry.depth < final_depth) {
          const std::uint32_t i = entry.segment;
          kept.push_back({s.front[i], s.back[i], s.scalar_front[i], s.scalar_back[i]});
        }
    lists.remove(final_depth, {});
  }
  bool take_unordered(Store&, double, scene::StageTimer&) override { return false; }
  [[nodiscard]] const std::vector<std::uint8_t>& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return true; }
  void finish() override {}
  [[nodiscard]] std::uint64_t segments() const override { return kept.size(); }

 private:
  std::vector<std::uint8_t> open_;
};

TEST(Attribute, LeavesDepthsAndScalarsAsTheyAre) {
  for (const scene::Camera& camera : views()) {
    Scene scene(datasets::cube(6), camera, smooth);
    KeepingSink<projection::RaySegments> without;
    KeepingSink<projection::AttributeSegments> with;
    scene.render<DoubleSource>(without);
    scene.render<DoubleSourceOf<projection::AttributeSegments>>(with);
    ASSERT_GT(without.kept.size(), 1000u);
    std::sort(without.kept.begin(), without.kept.end());  // attributes need memory, so flushes occur at other times
    std::sort(with.kept.begin(), with.kept.end());
    EXPECT_EQ(with.kept, without.kept);
  }
}

}  // namespace
}  // namespace tessera::frame::attribute_test
