#include "frame/render.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "compositor/segment_integrator.hpp"
#include "compositor/tile_pixels.hpp"
#include "frame/tile_renderer.hpp"
#include "projection/prepared_mesh.hpp"
#include "projection/tile_lists.hpp"
#include "scene/error.hpp"

namespace tessera::frame {
namespace {

int thread_count(int asked) { return asked > 0 ? asked : tbb::info::default_concurrency(); }

void check(const RenderSettings& settings) {
  if (settings.threads < 0 || settings.threads > 4096)
    throw scene::bad_input(fmt::format("--threads {}: it must be 0 (all cores) to 4096", settings.threads));
  if (settings.tile_size < 1 || settings.tile_size > 1024)
    throw scene::bad_input(fmt::format("--tile-size {}: it must be 1 to 1024 pixels", settings.tile_size));
}

/// Half the budget less what the frame holds already is for segments, shared by the threads.
std::uint64_t segment_budget(const RenderSettings& settings, std::uint64_t held, int threads) {
  const std::uint64_t least = held + static_cast<std::uint64_t>(threads) * (1u << 20);
  if (settings.memory_bytes < least)
    throw scene::bad_input(fmt::format("--memory {} MiB: this mesh and image need at least {} MiB for frame buffers",
                                       settings.memory_bytes >> 20, (least >> 20) + 1));
  return (settings.memory_bytes - held) / static_cast<std::uint64_t>(threads);
}

}  // namespace

struct Renderer::State {
  State(const scene::TetMesh& mesh, const RenderSettings& s)
      : settings((check(s), s)),
        parallelism(tbb::global_control::max_allowed_parallelism,
                    static_cast<std::size_t>(std::max(thread_count(s.threads), tbb::info::default_concurrency()))),
        arena(thread_count(s.threads)),
        prepared(arena.execute([&] {
          const scene::TraceScope timing(s.trace, "prepare");
          return projection::PreparedMesh(mesh);
        })) {
    const scene::Box box = scene::bounds(mesh);
    diagonal = box.empty() ? 0 : glm::length(box.high - box.low);
  }

  void project_vertices(const projection::PixelSpace& space) {
    const scene::TraceScope timing(settings.trace, "transform");
    const std::vector<glm::dvec3>& positions = prepared.mesh().positions;
    vertices.resize(positions.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size(), 4096), [&](const auto& range) {
      for (std::size_t v = range.begin(); v != range.end(); ++v) vertices[v] = space.project(positions[v]);
    });
  }

  scene::Image render(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& function,
                      FrameStatistics& statistics);

  RenderSettings settings;
  tbb::global_control parallelism;  ///< more threads than cores, where asked for, without oneTBB's warning
  tbb::task_arena arena;
  projection::PreparedMesh prepared;
  double diagonal = 0;
  std::vector<projection::PixelVertex> vertices;
};

scene::Image Renderer::State::render(const scene::Camera& camera, scene::ImageSize size,
                                     const scene::TransferFunction& function, FrameStatistics& statistics) {
  const projection::PixelSpace space(camera, size);
  const compositor::SegmentIntegrator integrator(function, settings.integrator, settings.emission, settings.trace);
  const bool independent = settings.emission == scene::Emission::independent;
  scene::Image image(size);
  project_vertices(space);
  const projection::ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth()};
  const projection::TileGrid grid{size, settings.tile_size};

  std::optional<projection::TileLists> lists;
  {
    const scene::TraceScope timing(settings.trace, "cull");
    lists.emplace(projected, grid, function, independent);
  }
  const int threads = arena.max_concurrency();
  const std::uint64_t held = vertices.capacity() * sizeof(projection::PixelVertex) + lists->bytes();
  // A quarter of what is left for the lists of a band of tiles; the rest for segments.
  const std::uint64_t list_budget =
      std::max<std::uint64_t>(segment_budget(settings, held, 1) / 4 / sizeof(projection::TileEntry), 1);
  const std::uint64_t budget = segment_budget(settings, held, threads) / 4 * 3;

  const TileContext context{&projected, lists->depth_origin(), budget, settings.trace};
  struct Worker {
    TileRenderer renderer;
    compositor::TilePixels pixels;
  };
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{TileRenderer(context),
                  compositor::TilePixels(space, integrator, function.max_color(), diagonal, settings.emission, image)};
  });
  std::uint64_t most_list_bytes = 0;
  for (std::size_t first = 0; first < grid.count();) {
    std::size_t last = first;
    for (std::uint64_t entries = 0; last < grid.count(); ++last) {
      entries += lists->entry_count(last);
      if (last > first && entries > list_budget) break;
    }
    {
      const scene::TraceScope timing(settings.trace, "bin");
      lists->fill(first, last);
    }
    most_list_bytes = std::max<std::uint64_t>(most_list_bytes, lists->bytes());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(first, last, 1),
        [&](const auto& range) {
          Worker& worker = workers.local();
          for (std::size_t tile = range.begin(); tile != range.end(); ++tile)
            if (lists->entry_count(tile) > 0) worker.renderer.render(grid.rect(tile), lists->tile(tile), worker.pixels);
        },
        tbb::simple_partitioner());
    first = last;
  }

  statistics = {};
  statistics.tets_total = prepared.tet_count();
  const projection::CullCounts& culled = lists->counts();
  statistics.tets_invisible = culled.invisible;
  statistics.tets_outside_view = culled.outside_view;
  statistics.tets_between_pixels = culled.between_pixels;
  statistics.tets_projected = culled.projected;
  statistics.peak_buffer_bytes = vertices.capacity() * sizeof(projection::PixelVertex) + most_list_bytes;
  for (const Worker& worker : workers) {
    const TileCounts& counts = worker.renderer.counts();
    statistics.segments += counts.segments;
    statistics.max_segments_alive = std::max(statistics.max_segments_alive, counts.max_segments_alive);
    statistics.peak_buffer_bytes += counts.peak_bytes;
    statistics.exact_sign_tests += counts.raster.exact_sign_tests;
    statistics.tiles_split += counts.tiles_split;
  }
  statistics.instruction_set = projection::instruction_set();
  statistics.integrator = integrator.name();
  return image;
}

Renderer::Renderer(const scene::TetMesh& mesh, const RenderSettings& settings)
    : state_(std::make_unique<State>(mesh, settings)) {}

Renderer::~Renderer() = default;

scene::Image Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                              const scene::TransferFunction& transfer_function, FrameStatistics* statistics) {
  FrameStatistics unwanted;
  return state_->arena.execute(
      [&] { return state_->render(camera, size, transfer_function, statistics != nullptr ? *statistics : unwanted); });
}

}  // namespace tessera::frame
