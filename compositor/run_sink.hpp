#pragma once

#include <vector>

#include "compositor/fragment_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/pixel_space.hpp"

namespace tessera::compositor {

/// `--exchange runs`: segments of a pixel that touch end to end become one fragment. Cells never intersect, so no other
/// process has anything inside a run, and compositing it here is exact; a convex part of a mesh sends one fragment a
/// pixel whatever its number of cells.
///
/// Runs touch if one's back is the other's front to the bit: neighbours compute a shared face from the same numbers.
/// Runs that carry neither light nor optical depth are not sent, and a run begins where it first becomes visible.
/// Pixels that this process's own cells make opaque are closed, as in TilePixels.
class RunSink final : public FragmentSink {
 public:
  RunSink(const projection::PixelSpace& space, const integrals::SegmentIntegrator& integrator, double max_color,
          double longest_ray, scene::Emission emission, std::uint64_t bytes_between_cuts, Deliver deliver);

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void start(const scene::PixelRect& rect) override;
  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override;
  bool take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                      double final_depth) override;
  [[nodiscard]] bool open(std::size_t pixel) const override { return open_[pixel] != 0; }
  [[nodiscard]] std::size_t open_count() const override { return open_count_; }
  void finish() override { close_runs(); }

 private:
  /// The run that a pixel is in.
  struct Run {
    double front, back;
    double red, green, blue, transmittance, optical_depth;
    bool begun = false;  ///< false: no segment yet
    [[nodiscard]] bool visible() const { return optical_depth > 0 || red != 0 || green != 0 || blue != 0; }
  };
  void merge(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth);
  void close(std::size_t pixel);
  void close_runs();
  void integrate(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth);

  const projection::PixelSpace* space_;
  const integrals::SegmentIntegrator* integrator_;
  double left_out_per_transmittance_, termination_error_;
  std::uint64_t bytes_between_cuts_;
  bool in_order_ = true;               ///< false once segments were taken unordered: then no pixel of the tile closes
  std::uint64_t bytes_since_cut_ = 0;  ///< of the tile
  std::vector<Run> runs_;
  std::vector<double> transmittance_, length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  integrals::SegmentBatch batch_;
};

}  // namespace tessera::compositor
