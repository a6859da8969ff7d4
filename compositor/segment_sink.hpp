// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "compositor/fragment_sink.hpp"
#include "projection/matter_light.hpp"
#include "scene/lattice.hpp"

namespace tessera::compositor {

/// Sends every segment unchanged. Nothing is integrated, so the sink cannot determine whether a pixel is opaque.
template <class Encoding>
class RawSink : public FragmentSink<Encoding> {
 public:
  using typename FragmentSink<Encoding>::Deliver;
  using typename FragmentSink<Encoding>::Store;
  using typename FragmentSink<Encoding>::Depth;

  void start(const scene::PixelRect& rect) final;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) final;
  bool take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) final;
  [[nodiscard]] const typename Encoding::Open& open() const final { return open_; }
  [[nodiscard]] bool any_open() const final { return true; }
  void finish() final {}

 protected:
  using FragmentSink<Encoding>::FragmentSink;

 private:
  /// Appends the records of segments before `final_depth` and removes these segments; returns their number.
  virtual std::uint64_t write(Store& store, Depth final_depth, exchange::PartWriter& writer) = 0;
  [[nodiscard]] virtual double planar(Depth depth) const = 0;

  typename Encoding::Open open_{};
};

/// Implements Exchange::segments: sends every ray segment in the encoding's records (exchange/wire.hpp).
template <class Encoding>
class SegmentSink;

/// Sends segments as chains of touching segments.
template <>
class SegmentSink<DoubleEncoding> final : public RawSink<DoubleEncoding> {
 public:
  /// `global_tet[t]`: index in the whole mesh of this process's tet t, ascending; empty: the index is t. Must outlive
  /// the sink. `normals` are sent with the segments; null: no normals are sent. Cell data have no normals.
  SegmentSink(bool cell_data, std::span<const std::uint64_t> global_tet, Deliver deliver,
              const projection::CellNormals* normals = nullptr)
      : RawSink(cell_data            ? exchange::RecordKind::chains_of_cells
                : normals != nullptr ? exchange::RecordKind::lit_chains
                                     : exchange::RecordKind::chains,
                std::move(deliver)),
        cell_data_(cell_data),
        global_tet_(global_tet),
        normals_(cell_data ? nullptr : normals) {}

 private:
  std::uint64_t write(Store& lists, double final_depth, exchange::PartWriter& writer) override;
  [[nodiscard]] double planar(double depth) const override { return depth; }

  bool cell_data_;
  std::span<const std::uint64_t> global_tet_;
  const projection::CellNormals* normals_;
};

/// Always sends all segments of the store, unsorted, because the compositor sorts them.
template <>
class SegmentSink<LatticeEncoding> final : public RawSink<LatticeEncoding> {
 public:
  /// `lit`: the windows contain the lights of segments, which are sent along.
  SegmentSink(const scene::Lattice& lattice, Deliver deliver, bool lit = false)
      : RawSink(lit ? exchange::RecordKind::lit_lattice : exchange::RecordKind::lattice, std::move(deliver)),
        lattice_(lattice) {}

 private:
  std::uint64_t write(Store& windows, std::int64_t final_step, exchange::PartWriter& writer) override;
  [[nodiscard]] double planar(std::int64_t step) const override { return lattice_.depth(static_cast<double>(step)); }

  scene::Lattice lattice_;
};

/// Implements Exchange::segments for the scanline rasterizer: sends the 4-tuples of Juliachs et al. 2007, 4.2, in the
/// order of their cells.
class TupleSink final : public RawSink<DoubleEncoding> {
 public:
  /// `longest_edge` is that of the whole mesh, in world units.
  TupleSink(float longest_edge, Deliver deliver)
      : RawSink(exchange::RecordKind::tuples, std::move(deliver)), longest_edge_(longest_edge) {}

 private:
  std::uint64_t write(Store& lists, double final_depth, exchange::PartWriter& writer) override;
  [[nodiscard]] double planar(double depth) const override { return depth; }

  float longest_edge_;
};

}  // namespace tessera::compositor
