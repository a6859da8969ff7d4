#pragma once

#include <vector>

#include "compositor/fragment_sink.hpp"

namespace tessera::compositor {

/// `--exchange segments`: every ray segment as it is, in chains of those that touch (wire.hpp).
class SegmentSink final : public FragmentSink {
 public:
  /// `global_tet[t]`: index in the whole mesh of this process's tet t, ascending; empty: t itself. Must outlive the
  /// sink.
  SegmentSink(bool cell_data, std::span<const std::uint64_t> global_tet, Deliver deliver)
      : FragmentSink(cell_data ? exchange::RecordKind::chains_of_cells : exchange::RecordKind::chains,
                     std::move(deliver)),
        cell_data_(cell_data),
        global_tet_(global_tet) {}

  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override;
  bool take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                      double final_depth) override;
  /// Nothing is integrated here, so no pixel is known to be opaque.
  [[nodiscard]] bool open(std::size_t) const override { return true; }
  [[nodiscard]] std::size_t open_count() const override { return static_cast<std::size_t>(rect().area()); }
  void finish() override {}

 private:
  void write(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth);

  bool cell_data_;
  std::span<const std::uint64_t> global_tet_;
};

/// `--exchange segments` of the `scanline` rasterizer: the paper's 4-tuples, in the order of their cells, as they are.
class TupleSink final : public FragmentSink {
 public:
  /// `longest_edge`: of the whole mesh, world units.
  TupleSink(float longest_edge, Deliver deliver)
      : FragmentSink(exchange::RecordKind::tuples, std::move(deliver)), longest_edge_(longest_edge) {}

  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override;
  bool take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                      double final_depth) override;
  [[nodiscard]] bool open(std::size_t) const override { return true; }
  [[nodiscard]] std::size_t open_count() const override { return static_cast<std::size_t>(rect().area()); }
  void finish() override {}

 private:
  void write(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth);

  float longest_edge_;
};

}  // namespace tessera::compositor
