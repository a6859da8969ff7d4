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

/// How cells of a mesh become ray segments.
enum class Rasterizer {
  planes,    ///< exact hits, double precision: the default
  scanline,  ///< Juliachs et al. 2007, 4.1-4.2 as printed: float32, no tie rule, segments ordered by z_back alone;
             ///< orthographic only
  device     ///< as planes, by the OpenGL devices that composite: for GlMethod::compute, on every compositor. Cells
             ///< that reach behind the eye or cross the clipping range or a step of the transfer function, and
             ///< frames whose light devices do not integrate, are left to the CPU
};

/// What projectors send to compositors (meshes on several ranks).
enum class Exchange {
  runs,      ///< segments that touch, composited; of a projector that has all cells, pixels. 2e-6 from `segments`,
             ///< which take their place where cells of several ranks overlap (FrameStatistics::overlapping)
  segments,  ///< raw ray segments, as Juliachs et al. 2007: the bits of a single process whatever the job's shape, on
             ///< machines of one instruction set (scanline: up to the order of equal keys, of which the paper has many)
};

/// Which of several processes projects which cell of a mesh.
enum class PartitionKind {
  file,    ///< contiguous ranges in file order, by count
  curve,   ///< contiguous stretches of a Hilbert curve through the tets' centroids, by count: compact parts
  random,  ///< each tet by a hash of its index: balanced at any view, no locality at all
};

struct Partition {
  PartitionKind kind = PartitionKind::curve;
  std::uint64_t seed = 1;  ///< of `random`
};

/// How the picture of a grid is split between processes (Moloney 2008, chapter 4): `accurate`, `backface` and
/// `splatting` are the thesis's cost maps, from bricks that show.
enum class Balance {
  learned,    ///< by what tiles of the frame before took, or where views differ much by pilot rays
  accurate,   ///< by each ray's way through the bricks
  backface,   ///< by the back faces of the bricks
  splatting,  ///< by spheres as wide as the bricks
  previous,   ///< by the CPU times of the frame before, each spread evenly over its rectangle; to compare with
  even        ///< equal rectangles of the volume's bounding box
};

/// What each of several processes has of a grid's frame (Moloney 2008, 2.3).
enum class Distribution {
  sort_first,  ///< a rectangle of the picture, and all of the volume along its rays
  sort_last    ///< a part of the volume, and the whole picture of it; pictures are composited front to back
};

/// How sort-last's processes give each other the pixels that they composite (Moloney 2008, 5.2.2 and A.5).
enum class DirectSend {
  asynchronous,  ///< packet by packet, composited as they come: Algorithm 1
  synchronous    ///< all pixels of a pair of processes at once, pair after pair; to compare with
};

/// What the brick cache throws out first (Moloney 2008, 3.3).
enum class CachePolicy {
  lru,       ///< the brick that has not been used for longest
  proximity  ///< the brick that is farthest from the view frustum and from that of the next view
};

/// How much memory a brick at the volume's high end takes (Moloney 2008, Table 6.2).
enum class EdgeBricks { variable, fixed };

/// Where ray segments of meshes are sorted and composited.
enum class Backend {
  cpu,
  automatic,  ///< a GPU through EGL, if one answers; else the CPU
  osmesa,     ///< OpenGL by Mesa in software, in this process
  egl         ///< OpenGL by a device without a surface: a GPU, or Mesa's software device
};

/// How an OpenGL device composites.
enum class GlMethod {
  compute,   ///< compute shaders on storage buffers
  fragment,  ///< as Juliachs et al. 2007, 4.3: scanline by scanline in textures; no error is promised
};

/// Of compositors that work on OpenGL devices. A process alone is one compositor.
struct DeviceSettings {
  std::vector<Backend> backends{};  ///< one of all compositors, or one each, in their order; none: the CPU
  GlMethod method = GlMethod::compute;
  bool half = true;                 ///< fragment: a framebuffer of 16-bit floats, as the paper's; false: 32-bit
  std::optional<int> egl_device{};  ///< egl: by EGL's own number; none: the first hardware device, else the first
  bool by_local_rank = false;       ///< egl: ranks of one machine take its devices in turn
};

/// Of meshes alone.
struct MeshSettings {
  Rasterizer rasterizer = Rasterizer::planes;
  int tile_size = 32;  ///< pixels a side, 1 to 1024; changes no bit of the picture
  DeviceSettings device;
  std::optional<Shading> shading;  ///< of point data, by the planes rasterizer, on the CPU, in double precision:
                                   ///< slower; emission in proportion to absorption
};

/// Of regular and rectilinear grids alone.
struct GridSettings {
  double step = 0.5;               ///< sampled, preintegrated: in voxels (cube root of a mean voxel's volume), > 0
  std::optional<Shading> shading;  ///< with exact and automatic, emission in proportion to absorption
  int brick_size = 32;             ///< voxels a side, 2 or more; bricks share their border samples
  EdgeBricks edge_bricks = EdgeBricks::variable;
  CachePolicy cache = CachePolicy::lru;
  int preload_limit = 0;  ///< proximity: bricks that the next view will need, loaded ahead, at most, a frame
};

/// Of jobs of several ranks.
struct RankSettings {
  /// Meshes: how many ranks project and composite. N + P ranks: the first N project, the others composite; max(N, P)
  /// ranks: both start at rank 0 and share. One number given: the other takes what is left. None: every rank does both.
  std::optional<int> projectors, compositors;
  std::optional<Exchange> exchange;  ///< meshes; nothing: see exchange_of()
  Partition partition;
  int frames_in_flight = 2;     ///< pictures of a list on their way at once, at least 1: the next ones are begun before
                                ///< one is put together
  std::uint64_t tile_seed = 1;  ///< of the map from tiles to compositors
  Distribution distribution = Distribution::sort_first;  ///< grids
  DirectSend direct_send = DirectSend::asynchronous;     ///< grids, sort_last
  Balance balance = Balance::learned;                    ///< grids
  /// Grids: of the cost map, map pixels an image pixel along each axis; `learned` splits by 0.25 at most.
  double balance_resolution = 0.5;
  std::vector<double> balance_weights{};  ///< grids: how much of the work each rank should get; empty: equal
  /// Grids: in place of weights, ranks whose threads took more CPU time than the mean in the frames before get less of
  /// the next one; equal parts in the first frame.
  bool balance_measured = false;
};

struct Settings;

/// What projectors send: RankSettings::exchange, or where that says nothing runs, but segments with the scanline
/// rasterizer (whose segments do not touch), with deep pictures (whose samples are cut within segments), with a device
/// (which would find runs composited already) and where Integrator::accuracy has no room for what runs err.
TESSERA_EXPORT Exchange exchange_of(const Settings& settings, bool deep);

/// Which ranks project and which composite a mesh. The first compositor assembles the pictures.
struct TESSERA_EXPORT Roles {
  std::vector<int> projectors, compositors;
  [[nodiscard]] bool projects(int rank) const;
  [[nodiscard]] bool composites(int rank) const;
  [[nodiscard]] int assembler() const { return compositors.front(); }
};

/// The roles of so many ranks by RankSettings::projectors and compositors, N and P of them. N + P ranks: ranks 0 .. N-1
/// project, the others composite. max(N, P) ranks: both start at rank 0 and share. With one number given the other
/// takes what is left, or shares if nothing is; with none every rank does both. Throws Error(bad_input) for numbers
/// that fit neither way.
TESSERA_EXPORT Roles assign_roles(int ranks, std::optional<int> projectors, std::optional<int> compositors);

/// How a session renders: one vocabulary for meshes and grids, one process and many. Of what changes the picture there
/// are the surfaces, the integrator, the emission, the shading, the rasterizer and the grid's step; nothing else
/// changes it by more than the accuracy asked.
struct Settings {
  /// Meshes: all kinds. Grids: exact, sampled and preintegrated by GridSettings::step, automatic.
  Integrator integrator;
  Emission emission = Emission::absorption;
  Surfaces surfaces;                        ///< meshes: by the planes rasterizer, on the CPU; grids: not in steps
  Mechanisms use;                           ///< what saves work
  int threads = 0;                          ///< of each process, 0 to 1024; 0: all cores
  std::uint64_t memory_bytes = 4ull << 30;  ///< of each process: frame buffers beside a mesh, bricks of a grid
  MeshSettings mesh;
  GridSettings grid;
  RankSettings ranks;
  /// Where the session's times go; null: nowhere. It must outlive the session. Of a mesh on several ranks, or on a
  /// device, spans say for which role the rank worked and number the frames from 0 (of sessions over one Job, one after
  /// the other, on from the last one's); other spans have the number that Trace::set_frame() gave.
  Trace* trace = nullptr;
};

/// Opacity peeling (Moloney 2008, 5.3; Rezk-Salama and Kolb 2006): every ray is cut where its opacity, counted from the
/// last cut on, reaches the threshold.
struct Peel {
  double threshold = 0.95;  ///< above 0, below 1
  int layers = 4;           ///< at most so many, the last of which ends with the ray; 1 to 64
};

/// Of one frame.
struct FrameSettings {
  /// The deep picture of the same frame too: flattened it is the image; cut anywhere in depth by OpenEXR's rules its
  /// error is below `deep_accuracy` (linear RGBA, 1e-6 to 1).
  bool deep = false;
  double deep_accuracy = 1e-3;
  /// Grids: what verify() looks at first, see RenderedFrame::uncertainty.
  bool keep_uncertainty = false;
  /// Grids: what Session::balance_pictures() draws.
  bool keep_cost = false;
  /// The picture in layers too: RenderedFrame::layers.
  std::optional<Peel> peel{};
  /// Whether light is asked for by its depth.
  [[nodiscard]] bool by_depth() const { return deep || peel.has_value(); }
};

/// What is rendered.
enum class DataKind { mesh, grid };

/// Throws Error(bad_input) for settings that are out of range, or that do not go together for this kind of data. A
/// Session checks its own, and what it asks of several ranks besides; nothing else does.
TESSERA_EXPORT void validate(const Settings& settings, DataKind data);

/// The same of a frame by these settings, but for the number of layers that memory holds.
TESSERA_EXPORT void validate(const FrameSettings& frame, const Settings& settings, DataKind data);

}  // namespace v0_1
}  // namespace tessera
