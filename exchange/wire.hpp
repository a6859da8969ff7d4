// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "exchange/message.hpp"
#include "scene/camera.hpp"
#include "scene/frame_counters.hpp"

/// Data from projectors to compositors: the structures of messages `begin`, `parts` and `end` (message.hpp), and the
/// records of a part. Little endian, no padding.
///
/// For each frame, a projector sends one begin to each compositor, then the parts of its tiles in tile order. The
/// begins enable a compositor to determine which parts of a tile are missing. Finally, the projector sends one end to
/// one compositor, end_goes_to(), which passes the sums on.
///
/// Records of a part, by kind:
///   runs       one RunRecord each
///   chains, chains_of_cells
///              ChainHeader and `links` ChainLinks each: segments of one pixel that touch end to end. Each link begins
///              at the depth and scalar where the previous link ends. So 24 bytes per segment describe it completely in
///              double precision, and the compositor's image has the same bits as that of a single process. For cell
///              data, the scalar is the same at both ends of a link, and is not shared with the next link.
///   lit_chains the same as chains, with a LinkNormal after each ChainLink: the compositor computes the lighting.
///   lattice    LatticeHeader and `segments` LatticeSegments each: segments of one pixel in any order, on the frame's
///              integer lattice, 16 bytes each (projection/lattice/segment_windows.hpp: front, back, scalars). The
///              compositor's image has the same bits as that of a single process. If a segment begins at a surface in
///              the volume, its front scalar is a mark, like that of a segment of length zero in chains
///              (projection/surface_crossings.hpp).
///   lit_lattice  the same as lattice, with a SegmentLight after each LatticeSegment
///   lattice_runs  RunsHeader, `runs` LatticeRuns and `segments` LatticeSegments each: runs of one pixel. A run that
///                 consists of one segment is sent as this segment (16 bytes), which the compositor integrates.
///   tuples     one TupleRecord each (compositor/tuple_record.hpp), in the order of their cells: Juliachs et al. 2007,
///              4.1
///   cells      one CellRecord each (projection/cell_record.hpp). Cells are not fragments: the compositor's device
///              rasterizes them. They precede the projector's other parts of the tile.
///   pixels     the finished pixels of the tile (packed_pixels.hpp), from a projector that has all cells of the tile:
///              one part
namespace tessera::exchange {

enum class RecordKind : std::uint8_t {
  runs = 1,
  chains = 2,
  chains_of_cells = 3,
  tuples = 4,
  lattice = 5,
  lattice_runs = 6,
  lit_chains = 7,
  cells = 8,
  pixels = 9,
  lit_lattice = 10
};

struct FrameBegin {
  double longest_ray;   ///< upper bound of the world length of a ray inside the whole mesh
  std::uint64_t tiles;  ///< number of bits that follow, one per tile
  float longest_edge;   ///< longest edge of the whole mesh, world units: the unit of a tuple's length; 0 without tuples
  std::uint32_t stopped = 0;  ///< 1: the projector was stopped: it has visible cells in this frame, but sends no parts
  std::uint64_t on_lattice = 0;  ///< 1: the frame's segments are on the lattice that box and range determine
  scene::Box box{};              ///< of the whole mesh
  std::array<double, 2> scalar_range{};
};
static_assert(sizeof(FrameBegin) == 96);

struct PartHeader {
  std::uint32_t tile;
  RecordKind kind;
  std::uint8_t last;  ///< 1: this projector's last part of the tile; 2: the last part, and the tile is incomplete
                      ///< because the projector was stopped
  std::uint8_t ascending = 0;  ///< lattice_runs: 1: each pixel has one header, and pixel numbers ascend
  std::uint8_t segments = 0;   ///< in an ascending part: 1: some of its runs are single segments
  std::uint64_t bytes;
  double final_depth;  ///< planar depth; all of this projector's fragments of the tile before this depth have been sent
  std::uint64_t fragments;  ///< runs, links, tuples or cells in the part
};
static_assert(sizeof(PartHeader) == 32);

/// Touching segments of a pixel, composited. No segment of another process can be between them.
struct RunRecord {
  double front;            ///< planar depth where extinction becomes positive; without extinction, where light does
  float thickness;         ///< back - front
  float red, green, blue;  ///< linear light that leaves the front, not attenuated by what is in front of it
  float opacity;        ///< stored instead of the transmittance: for an opacity of 1e-8, 1 - 1e-8 would be rounded to 1
  std::uint32_t pixel;  ///< row by row in the tile
};
static_assert(sizeof(RunRecord) == 32);

struct ChainHeader {
  std::uint32_t pixel, links;
  double front, scalar_front;  ///< depth and scalar of the first link's front; `scalar_front` is unused for cell data
};
static_assert(sizeof(ChainHeader) == 24);

struct ChainLink {
  double back, scalar;  ///< the exit's planar depth and scalar; cell data: the cell's scalar
  std::uint64_t tet;    ///< index in the whole mesh: the last part of the depth order's key
};
static_assert(sizeof(ChainLink) == 24);

/// The normal of a link's tet, of length 1, or 0 where the field has no gradient.
struct LinkNormal {
  float x, y, z;
};
static_assert(sizeof(LinkNormal) == 12);

/// Segments of one pixel on the lattice.
struct LatticeHeader {
  std::uint32_t pixel, segments;
};
static_assert(sizeof(LatticeHeader) == 8);

/// Runs of one pixel on the lattice.
struct RunsHeader {
  std::uint32_t pixel;
  std::uint16_t runs, segments;
};
static_assert(sizeof(RunsHeader) == 8);

/// The same as RunRecord, but with depths in steps of the lattice.
struct LatticeRun {
  std::int32_t front, back;
  float red, green, blue, opacity;
};
static_assert(sizeof(LatticeRun) == 24);

/// Counters of a frame, summed over projectors and compositors by the assembling rank.
struct FrameEnd {
  scene::FrameCounters counters;
  std::uint64_t on_lattice = 0;      ///< 1: the projector's segments are on the integer lattice
  std::uint64_t failed_devices = 0;  ///< number of compositors whose device failed and that continued on the CPU
  /// Number of projectors and compositors that left something out because they were stopped.
  std::uint64_t stopped = 0;
  std::uint64_t overlapping = 0;  ///< number of compositors that received runs which overlap
};
static_assert(sizeof(FrameEnd) == sizeof(scene::FrameCounters) + 32);
/// The sum of two processes' counters.
FrameEnd sum(const FrameEnd& a, const FrameEnd& b);

/// Returns the compositor, of `compositors`, to which a projector sends its end. Each compositor receives the ends of
/// its share of the projectors; if every projector sent ends to all compositors, there would be N P messages.
inline int end_goes_to(int projector, int compositors) { return projector % compositors; }

/// Immutable records, in their own memory or in that of the message that contains them.
class Records {
 public:
  Records() = default;
  Records(Bytes bytes)  // NOLINT(google-explicit-constructor): records are bytes
      : memory_(std::make_shared<const Bytes>(std::move(bytes))), bytes_(*memory_) {}
  Records(std::shared_ptr<const Bytes> message, std::span<const std::byte> bytes)
      : memory_(std::move(message)), bytes_(bytes) {}
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::shared_ptr<const Bytes> memory_;
  std::span<const std::byte> bytes_;
};

/// The fragments of a tile that one projector has, or some of them.
struct TilePart {
  std::uint32_t tile = 0;
  RecordKind kind = RecordKind::runs;
  bool last = false;
  bool stopped = false;  ///< this is the last part, and the tile is incomplete
  double final_depth = 0;
  std::uint64_t fragments = 0;
  Records records{};
  bool ascending = false, segments = false;  ///< as in PartHeader
  int projector = 0;                         ///< at the compositor: number of the sending projector, 0 .. N-1
  double start_depth = 0;  ///< at the compositor: the depth to which the projector's previous part was complete
};

}  // namespace tessera::exchange
