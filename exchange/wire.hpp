// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "exchange/message.hpp"
#include "scene/frame_counters.hpp"
#include "scene/lattice.hpp"

/// What travels from projectors to compositors: the structures of messages `begin`, `parts` and `end` (message.hpp),
/// and the records of a part. Little endian, no padding.
///
/// A projector sends each compositor, frame after frame: one begin; the parts of its tiles in tile order, tile by tile.
/// So a compositor knows from the begins what a tile still lacks. Then it sends one end, to one compositor, which
/// passes its sums on: end_goes_to().
///
/// Records of a part:
///   runs       RunRecord each
///   chains, chains_of_cells
///              ChainHeader and `links` ChainLinks each: segments of one pixel that touch end to end. Where one ends
///              the next begins, at the same depth and scalar, so 24 bytes a segment carry all of it in double
///              precision: the compositor's picture has the bits of a single process's. Scalars of cell data are the
///              same at both ends of a link and are not shared with the next.
///   lit_chains the same as chains, with a LinkNormal behind each ChainLink: what light there is on the matter is of
///              the compositor's making.
///   lattice    LatticeHeader and `segments` LatticeSegments each: segments of one pixel in any order, on the frame's
///              integer lattice, 16 bytes each (projection/lattice/segment_windows.hpp: front, back, scalars): the
///              compositor's picture has the bits of a single process's. Where a segment begins at a surface in the
///              volume its front scalar is a mark, as in chains that of a segment of length zero is
///              (projection/surface_crossings.hpp).
///   lattice_runs  RunsHeader, `runs` LatticeRuns and `segments` LatticeSegments each: runs of one pixel. A run of one
///              segment is that segment, 16 bytes, integrated by the compositor.
///   tuples     TupleRecord each (compositor/tuple_record.hpp), in the order of their cells: Juliachs et al. 2007, 4.1
///   cells      CellRecord each (projection/cell_record.hpp), no fragments yet: for the compositor's device to
///              rasterize. They come before the projector's other parts of the tile.
///   pixels     the tile's finished pixels (packed_pixels.hpp), of a projector that has all of its cells: one part
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
  pixels = 9
};

struct FrameBegin {
  double longest_ray;         ///< bounds the world length of a ray inside the whole mesh
  std::uint64_t tiles;        ///< number of bits that follow
  float longest_edge;         ///< of the whole mesh, world units: the unit of a tuple's length; 0 without tuples
  std::uint32_t stopped = 0;  ///< 1: the projector has been stopped; of this frame come no parts, though cells show
  scene::Lattice lattice{};   ///< of lattice segments; all 0 without
};
static_assert(sizeof(FrameBegin) == 56);

struct PartHeader {
  std::uint32_t tile;
  RecordKind kind;
  std::uint8_t last;  ///< 1: this projector's last part of the tile; 2: the same, and some are missing: it was stopped
  std::uint8_t ascending = 0;  ///< lattice_runs: 1: each pixel has one header, and their numbers ascend
  std::uint8_t segments = 0;   ///< of an ascending part: 1: some of its runs are single segments
  std::uint64_t bytes;
  double final_depth;       ///< planar; all of this projector's fragments of the tile before it have been sent
  std::uint64_t fragments;  ///< runs, links, tuples or cells in the part
};
static_assert(sizeof(PartHeader) == 32);

/// Segments of a pixel that touch end to end, composited. Nothing of another process can lie inside.
struct RunRecord {
  double front;            ///< planar depth where extinction first becomes positive (or light, if there is none)
  float thickness;         ///< back - front
  float red, green, blue;  ///< linear light that leaves the front, not attenuated by what lies before it
  float opacity;           ///< not transmittance: 1 - 1e-8 would be 1
  std::uint32_t pixel;     ///< row by row in the tile
};
static_assert(sizeof(RunRecord) == 32);

struct ChainHeader {
  std::uint32_t pixel, links;
  double front, scalar_front;  ///< of the first link; scalar_front unused for cell data
};
static_assert(sizeof(ChainHeader) == 24);

struct ChainLink {
  double back, scalar;  ///< exit's planar depth and scalar; cell data: the cell's scalar
  std::uint64_t tet;    ///< index in the whole mesh: the last key of the depth order
};
static_assert(sizeof(ChainLink) == 24);

/// The normal of a link's tet, of length one, or 0: the field has no gradient there.
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

/// RunRecord with its depths in steps of the lattice.
struct LatticeRun {
  std::int32_t front, back;
  float red, green, blue, opacity;
};
static_assert(sizeof(LatticeRun) == 24);

/// What a frame took, put together over projectors and compositors by the assembling rank.
struct FrameEnd {
  scene::FrameCounters counters;
  std::uint64_t on_lattice = 0;      ///< 1: the projector's segments are on the integer lattice
  std::uint64_t failed_devices = 0;  ///< compositors whose device failed and that went on with the CPU
  std::uint64_t stopped = 0;         ///< projectors and compositors that left something out, being stopped
  std::uint64_t overlapping = 0;     ///< compositors that were sent runs which overlap
};
static_assert(sizeof(FrameEnd) == sizeof(scene::FrameCounters) + 32);
/// Two processes' counts put together.
FrameEnd sum(const FrameEnd& a, const FrameEnd& b);

/// Which of P compositors gets the end of a projector: each that of its share. With ends for all there would be N P
/// of them.
inline int end_goes_to(int projector, int compositors) { return projector % compositors; }

/// Records that nobody changes: in memory of their own, or in that of the message they came in.
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

/// One projector's fragments of a tile, or some of them.
struct TilePart {
  std::uint32_t tile = 0;
  RecordKind kind = RecordKind::runs;
  bool last = false;
  bool stopped = false;  ///< last, and some of the tile is missing
  double final_depth = 0;
  std::uint64_t fragments = 0;
  Records records{};
  bool ascending = false, segments = false;  ///< as in PartHeader
  int projector = 0;                         ///< at the compositor: whose part, 0 .. N-1
  double start_depth = 0;  ///< at the compositor: the projector's part before this one was complete to here
};

}  // namespace tessera::exchange
