#include "compositor/run_sink.hpp"

#include <cmath>
#include <limits>

namespace tessera::compositor {
RunSink::RunSink(const projection::PixelSpace& space, const integrals::SegmentIntegrator& integrator, double max_color,
                 double longest_ray, scene::Emission emission, std::uint64_t bytes_between_cuts, Deliver deliver)
    : FragmentSink(exchange::RecordKind::runs, std::move(deliver)),
      space_(&space),
      integrator_(&integrator),
      left_out_per_transmittance_(integrals::opacity_weight(max_color, longest_ray, emission)),
      termination_error_(integrator.termination_error()),
      bytes_between_cuts_(bytes_between_cuts) {}

void RunSink::begin_tile(std::size_t tile, const scene::PixelRect& rect) {
  FragmentSink::begin_tile(tile, rect);
  in_order_ = true;
  bytes_since_cut_ = 0;
}

void RunSink::start(const scene::PixelRect& rect) {
  FragmentSink::start(rect);
  const auto n = static_cast<std::size_t>(rect.area());
  runs_.assign(n, Run{});
  transmittance_.assign(n, 1.0);
  open_.assign(n, 1);
  open_count_ = n;
  length_per_depth_.resize(n);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) length_per_depth_[i++] = space_->length_per_depth(x + 0.5, y + 0.5);
}

void RunSink::integrate(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth) {
  batch_.reserve(segments.size);
  batch_.size = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    for (const auto& entry : lists.pixel(p)) {
      const std::uint32_t i = entry.segment;
      if (!(entry.depth < end_depth)) break;
      batch_.length[batch_.size] = (segments.back[i] - segments.front[i]) * length_per_depth_[p];
      batch_.scalar_front[batch_.size] = segments.scalar_front[i];
      batch_.scalar_back[batch_.size] = segments.scalar_back[i];
      ++batch_.size;
    }
  }
  integrator_->integrate(batch_);
}

void RunSink::close(std::size_t pixel) {
  Run& run = runs_[pixel];
  if (run.begun && run.visible()) {
    exchange::append(
        records(), exchange::RunRecord{run.front, static_cast<float>(run.back - run.front), static_cast<float>(run.red),
                                       static_cast<float>(run.green), static_cast<float>(run.blue),
                                       static_cast<float>(-std::expm1(-run.optical_depth)), tile_pixel(pixel)});
    count(1);
    bytes_since_cut_ += sizeof(exchange::RunRecord);
  }
  run.begun = false;
}

void RunSink::close_runs() {
  for (std::size_t p = 0; p < runs_.size(); ++p) close(p);
}

void RunSink::merge(const projection::RaySegments& segments, const sorting::PixelLists& lists, double end_depth) {
  integrate(segments, lists, end_depth);
  std::size_t next = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    Run& run = runs_[p];
    bool open = true;
    for (const auto& entry : lists.pixel(p)) {
      const std::uint32_t i = entry.segment;
      if (!(entry.depth < end_depth)) break;
      const std::size_t k = next++;
      if (!open) continue;
      // Light without optical depth (independent emission) does not share a fragment with what absorbs behind it: the
      // fragment's front is where absorption begins.
      const bool absorbs = batch_.optical_depth[k] > 0;
      if (run.begun && (run.back != segments.front[i] || (absorbs && run.optical_depth == 0 && run.visible())))
        close(p);
      if (!run.begun) run = {segments.front[i], 0, 0, 0, 0, 1, 0, true};
      if (!run.visible()) {
        const double at =
            absorbs ? integrator_->first_visible(segments.scalar_front[i], segments.scalar_back[i]).value_or(0) : 0;
        run.front = segments.front[i] + (segments.back[i] - segments.front[i]) * at;
      }
      run.back = segments.back[i];
      run.red += run.transmittance * batch_.red[k];
      run.green += run.transmittance * batch_.green[k];
      run.blue += run.transmittance * batch_.blue[k];
      run.optical_depth += batch_.optical_depth[k];
      run.transmittance *= batch_.transmittance[k];
      transmittance_[p] *= batch_.transmittance[k];
      open = !in_order_ || transmittance_[p] * left_out_per_transmittance_ >= termination_error_;
    }
    if (!open) {
      close(p);
      open_[p] = 0;
      --open_count_;
    }
  }
}

void RunSink::take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) {
  merge(segments, lists, final_depth);
  if (bytes_since_cut_ >= bytes_between_cuts_) {
    close_runs();
    complete_to(final_depth);
    bytes_since_cut_ = 0;
  }
  send_if_full();
}

bool RunSink::take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                             double final_depth) {
  in_order_ = false;
  merge(segments, lists, std::numeric_limits<double>::infinity());
  close_runs();
  complete_to(final_depth);
  bytes_since_cut_ = 0;
  send_if_full();
  return true;
}

}  // namespace tessera::compositor
