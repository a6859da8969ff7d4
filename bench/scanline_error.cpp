// SPDX-License-Identifier: BSD-3-Clause
/// The error of the `scanline` rasterizer (Juliachs et al. 2007, 4.1-4.2) and its sources, and its time compared with
/// `planes`.
///
/// Usage: scanline_error [IMAGE_HEIGHT] [MESH_FILE ...]; prints one Markdown row per mesh. Times are processor time.
///
/// Cells on a ray are compared with those of `planes`, which are the reference's (tests/projection). Three images are
/// made with the `exact` integrator and compared with that of `planes` (3e-8 from the reference): from the segments of
/// `scanline`; from those of `planes` rounded to the four floats of the tuple, which is the error of the format alone;
/// and from those of `scanline` on pixels whose cells are all correct, which excludes the lost and added ones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compositor/picture_sink.hpp"
#include "cpu_time.hpp"
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

struct Picture {
  scene::Image image;
  double seconds = 0;
  std::uint64_t segments = 0;
};

struct Cells {  ///< cells of scanline compared with planes
  std::uint64_t lost = 0, added = 0, unpaired = 0;
  std::uint64_t pixels = 0, pixels_lost = 0, pixels_added = 0;
  std::vector<std::uint8_t> wrong;  ///< per pixel of the image
};

/// Rounds a segment to {z_back, length over the longest edge, s_front, s_back} in float.
void to_floats(projection::RaySegments& s, float edge) {
  for (std::size_t i = 0; i < s.size; ++i)
    projection::from_tuple(projection::to_tuple(s, i, edge), s.pixel(i), s.tet(i), edge, s, i);
}

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
  Picture planes, rounded, scanline;
  for (Picture* p : {&planes, &rounded, &scanline}) p->image = scene::Image(size);
  Cells cells;
  cells.wrong.assign(planes.image.depth.size(), 0);
  const auto rasterize = [&](std::size_t tile, bool paper, Picture& picture) {
    const double start = bench::thread_seconds();
    segments.size = 0;
    const scene::PixelRect rect = grid.rect(tile);
    const auto entries = lists.tile(tile);
    for (std::size_t next = 0; next < entries.size();) {
      next += paper ? rasterize_scanline({projected, edge}, entries.subspan(next), rect, buffers, segments, counts)
                    : rasterize_planes(projected, entries.subspan(next), rect, segments, counts);
      if (next < entries.size()) segments.reserve(2 * segments.capacity() + 8192);
    }
    picture.seconds += bench::thread_seconds() - start;
    picture.segments += segments.size;
  };
  const auto composite = [&](std::size_t tile, bool paper, Picture& picture) {
    const scene::PixelRect rect = grid.rect(tile);
    compositor::PictureSink<sorting::DoubleEncoding> pixels(
        {&space, &integrator, integrals::opacity_weight(function.max_color(), 1e9, scene::Emission::absorption)},
        {&picture.image});
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
    Picture untimed;  // both use the same warm buffers
    rasterize(tile, false, untimed);
    rasterize(tile, true, scanline);
    const auto found = sorted_keys(segments);
    composite(tile, true, scanline);
    rasterize(tile, false, planes);
    const auto right = sorted_keys(segments);
    composite(tile, false, planes);
    to_floats(segments, edge);
    composite(tile, true, rounded);

    const scene::PixelRect rect = grid.rect(tile);
    const auto note = [&](const std::vector<std::uint64_t>& from, const std::vector<std::uint64_t>& without,
                          std::uint64_t& cell_count, std::uint64_t& pixel_count) {
      std::vector<std::uint64_t> only;
      std::set_difference(from.begin(), from.end(), without.begin(), without.end(), std::back_inserter(only));
      cell_count += only.size();
      std::uint64_t last = ~0ull;
      for (const std::uint64_t key : only) {
        const auto p = static_cast<int>(key >> 32);
        pixel_count += key >> 32 != last;
        last = key >> 32;
        cells.wrong[planes.image.index(rect.x0 + p % rect.width(), rect.y0 + p / rect.width())] = 1;
      }
    };
    note(right, found, cells.lost, cells.pixels_lost);
    note(found, right, cells.added, cells.pixels_added);
    std::uint64_t last = ~0ull;
    for (const std::uint64_t key : right) cells.pixels += key >> 32 != last, last = key >> 32;
  }
  cells.unpaired = counts.unpaired;

  Difference all, right_cells, format;
  for (std::size_t p = 0; p < planes.image.depth.size(); ++p) {
    if (planes.image.rgba[4 * p + 3] == 0 && scanline.image.rgba[4 * p + 3] == 0) continue;
    all.add(scanline.image, planes.image, p);
    format.add(rounded.image, planes.image, p);
    if (!cells.wrong[p]) right_cells.add(scanline.image, planes.image, p);
  }
  fmt::print("| {} | {} | {:.1e} | {:.1e} | {:.4f} % | {:.1e} | {:.1e} | {} | {} | {} | {:.1f} | {:.1f} |\n", name,
             planes.segments, all.most, all.rms(),
             100.0 * static_cast<double>(all.over) / (static_cast<double>(all.count) / 4), right_cells.most,
             format.most, cells.lost, cells.added, std::count(cells.wrong.begin(), cells.wrong.end(), 1),
             1e9 * scanline.seconds / static_cast<double>(scanline.segments),
             1e9 * planes.seconds / static_cast<double>(planes.segments));
}

}  // namespace

int main(int argc, char** argv) {
  const int height = argc > 1 ? std::atoi(argv[1]) : 1024;
  const scene::ImageSize size{height, height};
  const scene::TransferFunction function = datasets::benchmark_transfer_function();
  scene::Camera oblique;
  oblique.position = {3.1, 2.3, 4.2};
  oblique.parallel_scale = 1.8;
  // Along the axis of the regular split with voxel corners on pixel centres: a voxel is 1/16 wide, and height / 64
  // pixels.
  scene::Camera along;
  const double pixel = 4.0 / height, shift = 0.5 * pixel;
  along.parallel_scale = 0.5 * pixel * height;
  along.position = {shift, -shift, 5};
  along.focal_point = {shift, -shift, 0};

  fmt::print(
      "| mesh | segments | max | RMS | pixels over 2e-5 | max where all cells are right | of the format alone | "
      "segments lost | added | pixels with either | scanline [ns/segment] | planes |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  measure("cube 32", datasets::cube(32, 0.2), oblique, size, function);
  measure("cube 64", datasets::cube(64, 0.2), oblique, size, function);
  measure("cube 64, cell data", datasets::with_cell_data(datasets::cube(64, 0.2)), oblique, size, function);
  const scene::TetMesh regular = datasets::regular_split(32, 32, 32, glm::dvec3(2.0 / 32), glm::dvec3(-1));
  measure("regular 32, oblique", regular, oblique, size, function);
  measure("regular 32, along its axis", regular, along, size, function);
  measure("the same, cell data", datasets::with_cell_data(regular), along, size, function);
  measure("slivers 16, 1e4", datasets::slivers(16, 1e4), oblique, size, function);
  measure("slivers 16, 1e7", datasets::slivers(16, 1e7), oblique, size, function);
  for (int i = 2; i < argc; ++i) {
    const scene::TetMesh mesh = io::read_mesh(io::identify(argv[i])).mesh;
    const auto range = scene::scalar_range(mesh);
    std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
    const double thickness = scene::mean_thickness(mesh);
    for (scene::Knot& k : knots) k.value = range[0] + (range[1] - range[0]) * k.value, k.extinction *= 2 / thickness;
    measure(std::filesystem::path(argv[i]).parent_path().filename().string(), mesh,
            scene::frame_box(scene::bounds(mesh), size), size, scene::TransferFunction(knots));
  }
}
