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

/// A frame to project.
struct FrameTask {
  const projection::PixelSpace* space;
  projection::TileGrid grid;
  const scene::TransferFunction* function;
  const scene::SurfaceSet* surfaces = nullptr;         ///< surfaces inside the volume; may be null or empty
  std::span<const projection::SurfaceFaces> faces{};   ///< triangle surfaces
  const scene::Lattice* lattice = nullptr;             ///< lattice on which to render; null: render in double precision
  std::span<const scene::MagnifiedRange> magnified{};  ///< ranges of the lattice's scalars
  /// On the lattice: lighting of the matter of point data; null: no lighting.
  const projection::MatterLight* light = nullptr;
  std::int32_t number = -1;  ///< frame number for the trace
  float longest_edge = 0;    ///< scanline: longest edge of the whole data set, world units; 0: that of this mesh
  double longest_ray = 0;    ///< upper bound of a ray's length in the whole mesh; 0: diagonal()
  scene::FrameWatch* watch = nullptr;  ///< project() throws scene::FrameStopped once the watch requests a stop
};

/// The sinks that receive the segments of a frame. A sink belongs to one thread, which passes tiles to the sink one
/// after the other; each thread takes its tiles in ascending order.
struct TileSinks {
  std::function<std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>>()> in_double;
  std::function<std::unique_ptr<compositor::TileSink<sorting::LatticeEncoding>>()> on_lattice{};
  /// If set, makes sinks for the cells of tiles that a device can rasterize; segments of other cells still go to the
  /// sinks above. May only be set for frames without surfaces.
  std::function<std::unique_ptr<compositor::CellSink>()> of_cells{};
  std::uint64_t kept_bytes = 0;         ///< bytes of the memory budget that the sinks need
  const scene::Image* image = nullptr;  ///< the image into which the sinks write, so that the watch sees finished
                                        ///< tiles; null: not an image here
  /// Runs once before the first tile, in parallel with the projection of vertices. May be empty.
  std::function<void()> prepare{};
  /// Called once before the first tile. `has_any` marks the tiles that have cells or triangles. Each marked tile will
  /// go to a sink of this process, unless TeamTask::skip() is called for it. May be empty.
  std::function<void(const std::vector<bool>& has_any)> announce{};
};

/// The processes that project a frame together. They have one mesh in shared memory and the same FrameTask, without
/// triangle surfaces. Their sinks do not write to an image. Each process does its share of the passes and renders some
/// of the tiles.
struct TeamTask {
  scene::Team* team = nullptr;  ///< null: a single process
  /// Returns the member that should own tile `tile` if the load permits; -1: no preference. Empty: no tile has a
  /// preference.
  std::function<int(std::size_t tile)> preferred{};
  /// Called for each announced tile that another member has taken, before this process begins its next tile.
  std::function<void(std::size_t tile)> skip{};
  /// Called before this process waits for its team while parts of tiles may be in transit. May be empty.
  std::function<void()> before_waiting{};
};

/// Projects a process's tets to the ray segments of every tile, on all its threads.
class FrameProjector {
 public:
  /// The mesh must outlive this object, and the settings must be valid.
  FrameProjector(const scene::TetMeshView& mesh, const Settings& settings);
  /// Uses a mesh that has already been prepared; `box` is the scene::bounds() of that mesh.
  FrameProjector(std::shared_ptr<const projection::PreparedMesh> mesh, const scene::Box& box, const Settings& settings);

  /// Projects one frame and returns its statistics, complete except for the names. Throws Error(bad_input) for a view
  /// that the rasterizer does not support.
  FrameStatistics project(const FrameTask& frame, const TileSinks& sinks, const TeamTask& team = {});

  /// The mesh's scene::bounds().
  [[nodiscard]] const scene::Box& box() const { return box_; }
  /// Length of the diagonal of the mesh's box, world units: an upper bound of the length of a ray inside the mesh.
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  [[nodiscard]] double longest_ray(const FrameTask& frame) const {
    return frame.longest_ray > 0 ? frame.longest_ray : diagonal_;
  }
  FrameStatistics project_in_arena(const FrameTask& frame, const TileSinks& sinks, const TeamTask& team);
  // The steps of project_in_arena(), in order.
  projection::ProjectedMesh transform(const FrameTask& frame, const TeamTask& team, const std::stop_token& stop);
  void place_on_lattice(const FrameTask& frame, const TeamTask& team, const std::stop_token& stop);
  struct Culled;
  [[nodiscard]] Culled cull(const FrameTask& frame, const projection::ProjectedMesh& projected, const TeamTask& team,
                            const std::stop_token& stop);
  [[nodiscard]] std::uint64_t render_bands(const FrameTask& frame, const TeamTask& team, projection::TileLists& lists,
                                           std::uint64_t held,
                                           const std::function<void(std::size_t, std::size_t)>& render) const;

  Settings settings_;
  tbb::task_arena arena_;
  std::shared_ptr<const projection::PreparedMesh> prepared_;
  scene::Box box_;
  double diagonal_ = 0;
  float longest_edge_ = 0;  ///< used only by the scanline rasterizer
  projection::LargeArray<projection::PixelVertex> vertices_;
  projection::LargeArray<projection::LatticeVertex> lattice_vertices_;
  projection::TileListBuffers list_buffers_;
};

}  // namespace tessera::frame
