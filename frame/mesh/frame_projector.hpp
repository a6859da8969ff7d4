// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/task_arena.h>

#include <functional>
#include <memory>
#include <vector>

#include "compositor/gl/cell_sink.hpp"
#include "compositor/tile_sink.hpp"
#include "frame/mesh/render.hpp"
#include "projection/large_array.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/prepared_mesh.hpp"
#include "projection/surface_faces.hpp"
#include "projection/tile_lists.hpp"
#include "scene/frame_watch.hpp"
#include "scene/surface_set.hpp"
#include "scene/team.hpp"
#include "sorting/encodings.hpp"

namespace tessera::frame {

/// Projects a process's tets into the ray segments of every tile, on all its threads: the half of a frame that knows
/// the mesh. What becomes of the segments is the sinks' business.
class FrameProjector {
 public:
  /// The mesh must outlive this object; the settings are valid.
  FrameProjector(const scene::TetMeshView& mesh, const Settings& settings);
  /// Of a mesh that has been prepared; `box` is its scene::bounds().
  FrameProjector(std::shared_ptr<const projection::PreparedMesh> mesh, const scene::Box& box, const Settings& settings);

  struct Task {
    const projection::PixelSpace* space;
    projection::TileGrid grid;
    const scene::TransferFunction* function;
    const scene::SurfaceSet* surfaces = nullptr;        ///< in the volume; null or empty: none
    std::span<const projection::SurfaceFaces> faces{};  ///< of those of triangles; then there is no lattice
    std::int32_t frame = -1;                            ///< for the trace
    float longest_edge = 0;        ///< scanline: of the whole data set, world units; 0: of this mesh
    double longest_ray = 0;        ///< bounds a ray's world length in the whole mesh; 0: diagonal()
    std::uint64_t kept_bytes = 0;  ///< of the memory budget, for what becomes of the segments
    /// A sink for one thread; tiles go to it one after the other, and each thread takes tiles in ascending order.
    std::function<std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>>()> make_sink;
    /// If set, tiles are rendered on this lattice and go to sinks of make_lattice_sink; else in double precision.
    const scene::Lattice* lattice = nullptr;
    std::function<std::unique_ptr<compositor::TileSink<sorting::LatticeEncoding>>()> make_lattice_sink;
    /// If set, a sink for one thread that takes the cells of tiles which a device can rasterize; the others' segments
    /// go on to the sinks above. There are no surfaces then.
    std::function<std::unique_ptr<compositor::CellSink>()> make_cell_sink;
    /// Asked all along whether to stop; then project() throws scene::FrameStopped. Null: nobody looks on.
    scene::FrameWatch* watch = nullptr;
    /// The picture that sinks write to, so that `watch` hears of its tiles; null: they go elsewhere.
    const scene::Image* image = nullptr;
    /// Done once before the first tile, by one thread while others look at the mesh. May be empty.
    std::function<void()> beside;
    /// Called once before the first tile: which tiles have cells or triangles and will be given to a sink of this
    /// process, but for those that pass() is called for. May be empty.
    std::function<void(const std::vector<bool>& has_any)> announce;
    /// Those with whom this process makes the frame: they have one mesh in shared memory and do the same task, without
    /// `faces` and `image`, each its share of the passes and some of the tiles. Null: alone.
    scene::Team* team = nullptr;
    /// Which member should make tile `tile` if that is as well as any other; -1: no matter which. Empty: none.
    std::function<int(std::size_t tile)> preferred;
    /// Called for each announced tile that turns out to be another member's, before the next tile is begun.
    std::function<void(std::size_t tile)> pass;
    /// Called before this process waits for its team while parts of tiles may be on their way. May be empty.
    std::function<void()> before_waiting;
  };

  /// Fills all of the statistics but the names. Throws Error(bad_input) for a view that the rasterizer cannot do.
  FrameStatistics project(const Task& task);

  /// The mesh's scene::bounds().
  [[nodiscard]] const scene::Box& box() const { return box_; }
  /// Length of the diagonal of the mesh's box, world units: no ray inside is longer.
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  FrameStatistics project_in_arena(const Task& task);
  std::uint64_t render_bands(const Task& task, projection::TileLists& lists, std::uint64_t held,
                             const std::function<void(std::size_t, std::size_t)>& render) const;
  void project_vertices(const Task& task, const std::stop_token& stop);
  void place_on_lattice(const Task& task, const std::stop_token& stop);

  Settings settings_;
  tbb::task_arena arena_;
  std::shared_ptr<const projection::PreparedMesh> prepared_;
  scene::Box box_;
  double diagonal_ = 0;
  float longest_edge_ = 0;  ///< scanline only
  projection::LargeArray<projection::PixelVertex> vertices_;
  projection::LargeArray<projection::LatticeVertex> lattice_vertices_;
  projection::TileListBuffers list_buffers_;
};

}  // namespace tessera::frame
