// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tessera/export.hpp"
#include "tessera/mechanisms.hpp"
#include "tessera/optical_model.hpp"
#include "tessera/shading.hpp"
#include "tessera/surfaces.hpp"

namespace tessera {
inline namespace v0_1 {

class Trace;

/// How ray segments are computed from the cells of a mesh.
enum class Rasterizer {
  planes,    ///< exact hits in double precision; the default
  scanline,  ///< the method of Juliachs et al. 2007, 4.1-4.2, as published: float32, without a rule for ties, segments
             ///< ordered by z_back alone; orthographic views only
  device     ///< as `planes`, computed by the OpenGL devices that composite; requires GlMethod::compute on every
             ///< compositor. The CPU handles cells that reach behind the eye or cross the clipping range or a step of
             ///< the transfer function, and frames whose optical model the devices do not support
};

/// What projectors send to compositors (meshes on several ranks).
enum class Exchange {
  runs,      ///< runs of touching segments, already composited; a projector that has all cells sends whole pixels. The
             ///< image differs from that of `segments` by at most 2e-6. If cells of several ranks overlap, segments are
             ///< sent instead (FrameStatistics::overlapping)
  segments,  ///< raw ray segments, as in Juliachs et al. 2007. On machines of one instruction set the image has the
             ///< same bits as that of a single process, for any number of ranks and any roles (with `scanline` except
             ///< for the order of equal keys, which are frequent in the paper's method)
};

/// Which process projects which cell of a mesh.
enum class PartitionKind {
  file,    ///< contiguous ranges in file order, with equal numbers of cells
  curve,   ///< contiguous sections of a Hilbert curve through the tets' centroids, with equal numbers of tets: compact
           ///< parts
  random,  ///< each tet by a hash of its index: balanced for any view, without any locality
};

struct Partition {
  PartitionKind kind = PartitionKind::curve;
  std::uint64_t seed = 1;  ///< for `random`
};

/// How the image of a grid is split between processes (Moloney 2008, chapter 4). The values `accurate`, `backface` and
/// `splatting` are the cost maps of that thesis, computed from the visible bricks.
enum class Balance {
  learned,    ///< by the times of the previous frame's tiles or, if the views differ much, by pilot rays
  accurate,   ///< by the length of each ray inside the bricks
  backface,   ///< by the back faces of the bricks, with interpolated weights of the corners
  splatting,  ///< by spheres as wide as the bricks
  previous,   ///< by the CPU times of the previous frame, each distributed evenly over the rectangle of its process;
              ///< for comparison
  even        ///< equal rectangles of the volume's bounding box
};

/// What each process contributes to a grid's frame (Moloney 2008, 2.3).
enum class Distribution {
  sort_first,  ///< a rectangle of the image, with all of the volume along its rays
  sort_last    ///< the whole image of a part of the volume; these images are composited front to back
};

/// How the processes of sort-last exchange the pixels that they composite (Moloney 2008, 5.2.2 and A.5).
enum class DirectSend {
  asynchronous,  ///< packets of pixels, composited as they arrive (Algorithm 1 of the thesis)
  synchronous  ///< pairs of processes take turns, and each pair exchanges all its pixels in one message; for comparison
};

/// What the brick cache evicts first (Moloney 2008, 3.3).
enum class CachePolicy {
  lru,       ///< the least recently used brick
  proximity  ///< the brick farthest from the view frustums of the current and the next view
};

/// Memory of the bricks at the volume's high end along each axis: for the voxels that they contain (`variable`), or as
/// much as for all other bricks (`fixed`) (Moloney 2008, Table 6.2).
enum class EdgeBricks { variable, fixed };

/// Where ray segments of meshes are sorted and composited.
enum class Backend {
  cpu,
  automatic,  ///< a GPU, through EGL, if one is available; otherwise the CPU
  osmesa,     ///< OpenGL rendered by Mesa in software, in this process
  egl         ///< OpenGL on a device, without a window: a GPU or Mesa's software device
};

/// How an OpenGL device composites.
enum class GlMethod {
  compute,   ///< compute shaders on storage buffers
  fragment,  ///< as in Juliachs et al. 2007, 4.3: scanline by scanline in textures; without a promised error
};

/// Settings for compositors that use OpenGL devices. A single process is one compositor.
struct DeviceSettings {
  std::vector<Backend> backends{};  ///< one for all compositors, or one for each in the order of their ranks; empty:
                                    ///< the CPU
  GlMethod method = GlMethod::compute;
  bool half = true;                 ///< `fragment` only: framebuffer of 16-bit floats, as in the paper; false: 32-bit
                                    ///< floats
  std::optional<int> egl_device{};  ///< `egl` only: EGL's number of the device; none: the first hardware device or, if
                                    ///< there is none, the first device
  bool by_local_rank = false;       ///< `egl` only: the ranks of one machine are distributed over its devices in turn
};

/// Settings for meshes only.
struct MeshSettings {
  Rasterizer rasterizer = Rasterizer::planes;
  int tile_size = 32;  ///< pixels per side, 1 to 1024; does not change the image
  DeviceSettings device;
  std::optional<Shading> shading;  ///< only for point data, the rasterizer `planes`, the CPU and Emission::absorption;
                                   ///< computed in double precision, which is slower
};

/// Settings for regular and rectilinear grids only.
struct GridSettings {
  double step = 0.5;               ///< `sampled` and `preintegrated`: step length in voxels (the cube root of the mean
                                   ///< volume of a voxel), > 0
  std::optional<Shading> shading;  ///< only for the integrators `exact` and `automatic` and Emission::absorption
  int brick_size = 32;             ///< voxels per side, at least 2; adjacent bricks share border samples
  EdgeBricks edge_bricks = EdgeBricks::variable;
  CachePolicy cache = CachePolicy::lru;
  int preload_limit = 0;  ///< `proximity` only: largest number of bricks per frame that are loaded in advance for the
                          ///< next view
};

/// Settings for jobs of several ranks.
struct RankSettings {
  /// Meshes: number of ranks that project (N) and that composite (P). In a job of N + P ranks, the first N project and
  /// the others composite. In a job of max(N, P) ranks, both roles start at rank 0, so that some ranks have both. If
  /// only one number is given, the remaining ranks have the other role. If none is given, every rank has both roles.
  std::optional<int> projectors, compositors;
  std::optional<Exchange> exchange;  ///< meshes; none: see exchange_of()
  Partition partition;
  int frames_in_flight = 2;     ///< largest number of frames of a list in progress at the same time, at least 1:
                                ///< following frames begin before a frame is complete
  std::uint64_t tile_seed = 1;  ///< seed of the assignment of tiles to compositors
  Distribution distribution = Distribution::sort_first;  ///< grids
  DirectSend direct_send = DirectSend::asynchronous;     ///< grids, sort_last
  Balance balance = Balance::learned;                    ///< grids
  /// Grids: resolution of the cost map along each axis, in pixels of the map per pixel of the image. `learned` uses at
  /// most 0.25.
  double balance_resolution = 0.5;
  std::vector<double> balance_weights{};  ///< grids: the share of the work for each rank; empty: equal shares
  /// Grids: used instead of `balance_weights`. Ranks whose threads took more CPU time than the mean in the previous
  /// frames get a smaller part of the next frame. The first frame is split into equal parts.
  bool balance_measured = false;
};

struct Settings;

/// Returns what projectors send: RankSettings::exchange if it is set; otherwise runs, except in four cases whose
/// default is segments: with the scanline rasterizer (its segments do not touch), for deep images (their samples are
/// cut within segments), with a device (it would receive runs that are already composited), and if Integrator::accuracy
/// leaves no room for the error of runs.
TESSERA_EXPORT Exchange exchange_of(const Settings& settings, bool deep);

/// The ranks that project a mesh and the ranks that composite it. The first compositor assembles the images.
struct TESSERA_EXPORT Roles {
  std::vector<int> projectors, compositors;
  [[nodiscard]] bool projects(int rank) const;
  [[nodiscard]] bool composites(int rank) const;
  [[nodiscard]] int assembler() const { return compositors.front(); }
};

/// Returns the roles in a job of `ranks` ranks for RankSettings::projectors (N) and compositors (P). If the job has N +
/// P ranks, ranks 0 to N - 1 project and the others composite. If it has max(N, P) ranks, both roles start at rank 0,
/// so that some ranks have both. If only one number is given, the remaining ranks have the other role; if none remains,
/// all ranks have it. If no number is given, every rank has both roles. Throws Error(bad_input) for any other numbers.
TESSERA_EXPORT Roles assign_roles(int ranks, std::optional<int> projectors, std::optional<int> compositors);

/// How a session renders. The same structure is used for meshes and grids, and for one process and several. Only the
/// surfaces, the integrator, the emission, the shading, the rasterizer and the grid's step are meant to change the
/// image; nothing else changes it by more than the requested accuracy.
struct Settings {
  /// Meshes support all kinds. Grids support `exact`, `automatic`, and, with steps of GridSettings::step, `sampled` and
  /// `preintegrated`.
  Integrator integrator;
  Emission emission = Emission::absorption;
  Surfaces surfaces;                        ///< meshes: only with the rasterizer `planes` on the CPU; grids: only with
                                            ///< `exact` and `automatic`
  Mechanisms use;                           ///< optimizations in use
  int threads = 0;                          ///< threads of each process, 0 to 1024; 0: all cores
  std::uint64_t memory_bytes = 4ull << 30;  ///< limit for each process: frame buffers and bricks of a grid, but not the
                                            ///< mesh itself
  MeshSettings mesh;
  GridSettings grid;
  RankSettings ranks;
  /// Records the session's times; may be null. The trace must outlive the session. For a mesh on several ranks or on a
  /// device, spans have the role of the rank and the number of the frame, counted from 0; the numbers continue over
  /// consecutive sessions of one Job. All other spans have the number set by Trace::set_frame().
  Trace* trace = nullptr;
};

/// Opacity peeling (Moloney 2008, 5.3; Rezk-Salama and Kolb 2006): every ray is cut where its opacity, accumulated from
/// the previous cut, reaches the threshold.
struct Peel {
  double threshold = 0.95;  ///< above 0, below 1
  int layers = 4;           ///< largest number of layers, 1 to 64; the last one contains the rest of the ray
};

/// Settings for one frame.
struct FrameSettings {
  /// Also return the deep image of the frame. Flattened, it equals the image. If the deep image is cut at any depth by
  /// OpenEXR's rules, the error is below `deep_accuracy` (linear RGBA, 1e-6 to 1).
  bool deep = false;
  double deep_accuracy = 1e-3;
  /// Grids: return RenderedFrame::uncertainty, which verify() uses to choose the pixels that it checks first.
  bool keep_uncertainty = false;
  /// Grids: keep the data that Session::balance_pictures() draws.
  bool keep_cost = false;
  /// Also return the image in layers: RenderedFrame::layers.
  std::optional<Peel> peel{};
  /// Whether the frame requires the distribution of light over depth.
  [[nodiscard]] bool by_depth() const { return deep || peel.has_value(); }
};

/// The kind of data that is rendered.
enum class DataKind { mesh, grid };

/// Throws Error(bad_input) for settings that are out of range or incompatible for this kind of data. A Session
/// validates its settings in this way and also checks the requirements of jobs with several ranks, which this function
/// does not check.
TESSERA_EXPORT void validate(const Settings& settings, DataKind data);

/// Validates the settings of a frame of a session with these `settings`, except whether the layers fit in memory.
TESSERA_EXPORT void validate(const FrameSettings& frame, const Settings& settings, DataKind data);

}  // namespace v0_1
}  // namespace tessera
