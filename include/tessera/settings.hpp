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
  device     ///< as planes, on the OpenGL devices that composite: for GlMethod::compute, on every compositor. The
             ///< CPU handles cells that reach behind the eye or cross the clipping range or a step of the transfer
             ///< function, and frames whose light devices do not integrate
};

/// What projectors send to compositors (meshes on several ranks).
enum class Exchange {
  runs,      ///< touching segments, composited; pixels, from a projector that has all cells. Within 2e-6 of
             ///< `segments`, which replace them if cells of several ranks overlap (FrameStatistics::overlapping)
  segments,  ///< raw ray segments, as in Juliachs et al. 2007: the bits of a single process for any job layout on
             ///< machines of one instruction set (scanline: up to the order of equal keys, which the paper often has)
};

/// Which process projects which cell of a mesh.
enum class PartitionKind {
  file,    ///< contiguous ranges in file order, by count
  curve,   ///< contiguous stretches of a Hilbert curve through the tets' centroids, by count: compact parts
  random,  ///< each tet by a hash of its index: balanced at any view, no locality at all
};

struct Partition {
  PartitionKind kind = PartitionKind::curve;
  std::uint64_t seed = 1;  ///< for `random`
};

/// How the image of a grid is split between processes (Moloney 2008, chapter 4): `accurate`, `backface` and `splatting`
/// are the thesis's cost maps, computed from the visible bricks.
enum class Balance {
  learned,    ///< by the tile times of the frame before or, if views differ much, by pilot rays
  accurate,   ///< by each ray's path through the bricks
  backface,   ///< by the back faces of the bricks
  splatting,  ///< by spheres as wide as the bricks
  previous,   ///< by the CPU times of the frame before, each spread evenly over its rectangle; for comparison
  even        ///< equal rectangles of the volume's bounding box
};

/// What each process contributes to a grid's frame (Moloney 2008, 2.3).
enum class Distribution {
  sort_first,  ///< a rectangle of the image, and all of the volume along its rays
  sort_last    ///< a part of the volume, and its whole image; these images are composited front to back
};

/// How sort-last's processes exchange the pixels that they composite (Moloney 2008, 5.2.2 and A.5).
enum class DirectSend {
  asynchronous,  ///< packet by packet, composited as they arrive: Algorithm 1
  synchronous    ///< all pixels of a pair of processes at once, pair after pair; for comparison
};

/// What the brick cache evicts first (Moloney 2008, 3.3).
enum class CachePolicy {
  lru,       ///< the brick that was not used for the longest time
  proximity  ///< the brick that is farthest from the view frustum and from that of the next view
};

/// How much memory a brick at the volume's high end takes (Moloney 2008, Table 6.2).
enum class EdgeBricks { variable, fixed };

/// Where ray segments of meshes are sorted and composited.
enum class Backend {
  cpu,
  automatic,  ///< a GPU through EGL if one is available; otherwise the CPU
  osmesa,     ///< OpenGL by Mesa in software, in this process
  egl         ///< OpenGL by a device without a surface: a GPU, or Mesa's software device
};

/// How an OpenGL device composites.
enum class GlMethod {
  compute,   ///< compute shaders on storage buffers
  fragment,  ///< as Juliachs et al. 2007, 4.3: scanline by scanline in textures; no error is promised
};

/// For compositors that work on OpenGL devices. A single process is one compositor.
struct DeviceSettings {
  std::vector<Backend> backends{};  ///< one for all compositors, or one each, in their order; empty: the CPU
  GlMethod method = GlMethod::compute;
  bool half = true;                 ///< fragment: a framebuffer of 16-bit floats, as in the paper; false: 32-bit
  std::optional<int> egl_device{};  ///< egl: EGL's number of the device; none: the first hardware device, or the first
  bool by_local_rank = false;       ///< egl: the ranks of one machine use its devices in turn
};

/// For meshes only.
struct MeshSettings {
  Rasterizer rasterizer = Rasterizer::planes;
  int tile_size = 32;  ///< pixels per side, 1 to 1024; changes no bit of the image
  DeviceSettings device;
  std::optional<Shading> shading;  ///< of point data, by the planes rasterizer, on the CPU, in double precision:
                                   ///< slower; emission in proportion to absorption
};

/// For regular and rectilinear grids only.
struct GridSettings {
  double step = 0.5;               ///< sampled, preintegrated: in voxels (cube root of a mean voxel's volume), > 0
  std::optional<Shading> shading;  ///< with exact and automatic, emission in proportion to absorption
  int brick_size = 32;             ///< voxels per side, 2 or more; bricks share their border samples
  EdgeBricks edge_bricks = EdgeBricks::variable;
  CachePolicy cache = CachePolicy::lru;
  int preload_limit = 0;  ///< proximity: most bricks per frame that are loaded ahead for the next view
};

/// For jobs of several ranks.
struct RankSettings {
  /// Meshes: number of ranks that project and composite. N + P ranks: the first N project, the others composite; max(N,
  /// P) ranks: both start at rank 0 and share. With one number given, the other is that of the remaining ranks. None:
  /// every rank does both.
  std::optional<int> projectors, compositors;
  std::optional<Exchange> exchange;  ///< meshes; none: see exchange_of()
  Partition partition;
  int frames_in_flight = 2;     ///< most frames of a list in progress at once, at least 1: the next frames begin
                                ///< before one is complete
  std::uint64_t tile_seed = 1;  ///< for the map from tiles to compositors
  Distribution distribution = Distribution::sort_first;  ///< grids
  DirectSend direct_send = DirectSend::asynchronous;     ///< grids, sort_last
  Balance balance = Balance::learned;                    ///< grids
  /// Grids: map pixels per image pixel along each axis in the cost map; `learned` splits at 0.25 at most.
  double balance_resolution = 0.5;
  std::vector<double> balance_weights{};  ///< grids: share of the work that each rank should get; empty: equal
  /// Grids: instead of weights, ranks whose threads took more CPU time than the mean in the frames before get less of
  /// the next one; the first frame is split into equal parts.
  bool balance_measured = false;
};

struct Settings;

/// What projectors send: RankSettings::exchange if it is set, otherwise runs. The default is segments with the scanline
/// rasterizer (whose segments do not touch), with deep images (whose samples are cut within segments), with a device
/// (which would receive runs that are already composited) and if Integrator::accuracy leaves no room for the error of
/// runs.
TESSERA_EXPORT Exchange exchange_of(const Settings& settings, bool deep);

/// Which ranks project and which composite a mesh. The first compositor assembles the images.
struct TESSERA_EXPORT Roles {
  std::vector<int> projectors, compositors;
  [[nodiscard]] bool projects(int rank) const;
  [[nodiscard]] bool composites(int rank) const;
  [[nodiscard]] int assembler() const { return compositors.front(); }
};

/// The roles of `ranks` ranks by RankSettings::projectors (N) and compositors (P). N + P ranks: ranks 0 .. N-1 project,
/// the others composite. max(N, P) ranks: both start at rank 0 and share. With one number given, the remaining ranks
/// have the other role, or all share if none remains; with none given every rank does both. Throws Error(bad_input) for
/// numbers that fit neither way.
TESSERA_EXPORT Roles assign_roles(int ranks, std::optional<int> projectors, std::optional<int> compositors);

/// How a session renders: the same settings for meshes and grids, one process and many. Only the surfaces, the
/// integrator, the emission, the shading, the rasterizer and the grid's step are meant to change the image; nothing
/// else changes it by more than the requested accuracy.
struct Settings {
  /// Meshes: all kinds. Grids: exact, sampled and preintegrated by GridSettings::step, automatic.
  Integrator integrator;
  Emission emission = Emission::absorption;
  Surfaces surfaces;                        ///< meshes: by the planes rasterizer, on the CPU; grids: not in steps
  Mechanisms use;                           ///< optimizations in use
  int threads = 0;                          ///< of each process, 0 to 1024; 0: all cores
  std::uint64_t memory_bytes = 4ull << 30;  ///< of each process: frame buffers (not the mesh itself), bricks of a grid
  MeshSettings mesh;
  GridSettings grid;
  RankSettings ranks;
  /// Records the session's times; may be null. It must outlive the session. For a mesh on several ranks, or on a
  /// device, spans have the role of the rank and number the frames from 0 (in consecutive sessions over one Job the
  /// numbers continue); other spans have the number set by Trace::set_frame().
  Trace* trace = nullptr;
};

/// Opacity peeling (Moloney 2008, 5.3; Rezk-Salama and Kolb 2006): every ray is cut where its opacity, counted from the
/// previous cut, reaches the threshold.
struct Peel {
  double threshold = 0.95;  ///< above 0, below 1
  int layers = 4;           ///< most layers, the last of which ends with the ray; 1 to 64
};

/// For one frame.
struct FrameSettings {
  /// Also return the deep image of the frame: flattened it equals the image; cut anywhere in depth by OpenEXR's rules
  /// its error is below `deep_accuracy` (linear RGBA, 1e-6 to 1).
  bool deep = false;
  double deep_accuracy = 1e-3;
  /// Grids: what verify() checks first, see RenderedFrame::uncertainty.
  bool keep_uncertainty = false;
  /// Grids: keep what Session::balance_pictures() draws.
  bool keep_cost = false;
  /// Also return the image in layers: RenderedFrame::layers.
  std::optional<Peel> peel{};
  /// Whether the frame needs light by its depth.
  [[nodiscard]] bool by_depth() const { return deep || peel.has_value(); }
};

/// The kind of data that is rendered.
enum class DataKind { mesh, grid };

/// Throws Error(bad_input) for settings that are out of range or incompatible for this kind of data. A Session
/// validates its settings, and also checks its requirements on several ranks; nothing else does.
TESSERA_EXPORT void validate(const Settings& settings, DataKind data);

/// The same for a frame with these settings, except for the number of layers that fit in memory.
TESSERA_EXPORT void validate(const FrameSettings& frame, const Settings& settings, DataKind data);

}  // namespace v0_1
}  // namespace tessera
