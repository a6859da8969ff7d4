// SPDX-License-Identifier: BSD-3-Clause
/// The error of the `scanline` rasterizer (Juliachs et al. 2007, 4.1-4.2), for docs/ACCURACY.md.
///
/// Usage: scanline_error [MESH_FILE ...]; prints one Markdown row per mesh, 1024 x 1024 pixels.
///
/// Cells on a ray are compared with those of `planes`, which are the reference's (tests/projection), and the image of
/// the `exact` integrator with that of `planes` (3e-8 from the reference).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compositor/picture_sink.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/transfer_functions.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "projection/scanline/scanline_rasterizer.hpp"
#include "projection/tile_lists.hpp"
#include "scene/camera.hpp"

using namespace tessera;

namespace {

std::vector<std::uint64_t> sorted_keys(const projection::RaySegments& s) {
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < s.size; ++i) keys.push_back(static_cast<std::uint64_t>(s.pixel(i)) << 32 | s.tet(i));
  std::sort(keys.begin(), keys.end());
  return keys;
}

struct Difference {
  double most = 0, sum = 0;
  std::uint64_t count = 0, over = 0;
  void add(const scene::Image& a, const scene::Image& b, std::size_t pixel) {
    double worst = 0;
    for (std::size_t c = 4 * pixel; c < 4 * pixel + 4; ++c) {
      const double d = std::abs(static_cast<double>(a.rgba[c]) - b.rgba[c]);
      worst = std::max(worst, d);
      sum += d * d;
    }
    count += 4;
    most = std::max(most, worst);
    over += worst > 2e-5;
  }
  [[nodiscard]] double rms() const { return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count)); }
};

void measure(const std::string& name, const scene::TetMesh& mesh, const scene::Camera& camera, scene::ImageSize size,
             const scene::TransferFunction& function) {
  const projection::PreparedMesh prepared(mesh);
  const projection::PixelSpace space(camera, size);
  std::vector<projection::PixelVertex> vertices;
  for (const auto& p : mesh.positions) vertices.push_back(space.project(p));
  const projection::ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth(),
                                            space.pixels_per_tangent()};
  const projection::TileGrid grid{size, 32};
  projection::TileLists lists(projected, grid, function, false);
  lists.fill(0, grid.count());
  const float edge = projection::longest_edge(mesh);
  const integrals::SegmentIntegrator integrator(function, {.kind = scene::IntegratorKind::exact},
                                                scene::Emission::absorption);

  projection::RaySegments segments;
  projection::ScanlineBuffers buffers;
  projection::RasterCounts counts;
  sorting::SegmentLists store;
  scene::Image planes(size), scanline(size);
  std::uint64_t all = 0, lost = 0, added = 0;
  const auto rasterize = [&](std::size_t tile, bool paper) {
    segments.size = 0;
    const scene::PixelRect rect = grid.rect(tile);
    const auto entries = lists.tile(tile);
    for (std::size_t next = 0; next < entries.size();) {
      next += paper ? rasterize_scanline({projected, edge}, entries.subspan(next), rect, buffers, segments, counts)
                    : rasterize_planes(projected, entries.subspan(next), rect, segments, counts);
      if (next < entries.size()) segments.reserve(2 * segments.capacity() + 8192);
    }
    return sorted_keys(segments);
  };
  const auto composite = [&](std::size_t tile, bool paper, scene::Image& image) {
    const scene::PixelRect rect = grid.rect(tile);
    compositor::PictureSink<sorting::DoubleEncoding> pixels(
        {&space, &integrator, integrals::opacity_weight(function.max_color(), 1e9, scene::Emission::absorption)},
        {&image});
    pixels.start(rect);
    store.reset(static_cast<std::size_t>(rect.area()),
                paper ? sorting::SegmentLists::Key::back : sorting::SegmentLists::Key::front);
    store.segments = segments;
    scene::StageTimer timer(nullptr);
    pixels.take(store, sorting::DoubleEncoding::end, 1, timer);
    pixels.finish();
  };
  for (std::size_t tile = 0; tile < grid.count(); ++tile) {
    if (lists.entry_count(tile) == 0) continue;
    segments.reserve(8192);
    const auto found = rasterize(tile, true);
    composite(tile, true, scanline);
    const auto right = rasterize(tile, false);
    composite(tile, false, planes);
    std::vector<std::uint64_t> both;
    std::set_intersection(right.begin(), right.end(), found.begin(), found.end(), std::back_inserter(both));
    all += right.size(), lost += right.size() - both.size(), added += found.size() - both.size();
  }

  Difference difference;
  for (std::size_t p = 0; p < planes.depth.size(); ++p)
    if (planes.rgba[4 * p + 3] != 0 || scanline.rgba[4 * p + 3] != 0) difference.add(scanline, planes, p);
  fmt::print("| {} | {:.1e} | {:.1e} | {} of {} | {} / {} of {:.1f} M |\n", name, difference.most, difference.rms(),
             difference.over, difference.count / 4, lost, added, 1e-6 * static_cast<double>(all));
}

}  // namespace

int main(int argc, char** argv) {
  const scene::ImageSize size{1024, 1024};
  const scene::TransferFunction function = datasets::benchmark_transfer_function();
  scene::Camera oblique;
  oblique.position = {3.1, 2.3, 4.2};
  oblique.parallel_scale = 1.8;
  fmt::print("| | max | RMS | pixels over 2e-5 | segments lost / added of |\n|---|---|---|---|---|\n");
  measure("cube 64, jittered, oblique", datasets::cube(64, 0.2), oblique, size, function);
  measure("the same with cell data", datasets::with_cell_data(datasets::cube(64, 0.2)), oblique, size, function);
  for (int i = 1; i < argc; ++i) {
    const scene::TetMesh mesh = io::read_mesh(io::identify(argv[i])).mesh;
    const auto range = scene::scalar_range(mesh);
    std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
    const double thickness = scene::mean_thickness(mesh);
    for (scene::Knot& k : knots) k.value = range[0] + (range[1] - range[0]) * k.value, k.extinction *= 2 / thickness;
    measure(std::filesystem::path(argv[i]).parent_path().filename().string(), mesh,
            scene::frame_box(scene::bounds(mesh), size), size, scene::TransferFunction(knots));
  }
}
