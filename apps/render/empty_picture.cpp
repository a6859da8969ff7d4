// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/empty_picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <utility>

#include "apps/trial_cells.hpp"

namespace tessera::apps {
namespace {

constexpr const char* no_volume =
    "its cells have no volume that a pixel could show; give a mesh whose cells have volume";

bool emits(const RenderOptions& options) { return options.settings.emission == Emission::independent; }

/// Rounds a number up to at most two digits.
double rounded_up(double number) {
  if (!(number > 0) || !std::isfinite(number)) return 1;
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - 1);
  return std::ceil(number / unit * (1 - 1e-9)) * unit;
}

/// Sends one rank's value to all ranks.
template <class Value>
Value of_rank(Job& job, int rank, Value value) {
  std::vector<std::byte> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  bytes = job.broadcast(rank, std::move(bytes));
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// Tries views and sizes similar to a frame's, on all ranks in the same order.
class Tries {
 public:
  Tries(const FinishedRun& run, const FilmFrame& frame)
      : run_(run), frame_(frame), cells_(run.data, run.function, emits(run.options)) {}

  [[nodiscard]] bool shows(const FilmFrame& frame, const ViewRequest& view, const glm::dvec3& scale = glm::dvec3(1)) {
    const Box box{run_.box.low * scale, run_.box.high * scale};
    const Camera camera = frame.view(box, run_.options.projection, view, run_.axes);
    return sum(cells_.pixels(camera, frame.size, scale)) >= TrialCells::enough(frame.size);
  }
  [[nodiscard]] bool shows(const Camera& camera) {
    return sum(cells_.pixels(camera, frame_.size)) >= TrialCells::enough(frame_.size);
  }

  /// Tries larger `--size` values, up to usual image sizes.
  void try_sizes(std::vector<std::string>& remedies) {
    constexpr int largest = 8192;
    const ImageSize size = frame_.size;
    for (const int times : {2, 3, 4, 6, 8, 12, 16, 24, 32}) {
      FilmFrame larger = frame_;
      if (std::max(size.width, size.height) > largest / times) return;
      larger.size = {size.width * times, size.height * times};
      if (!shows(larger, run_.options.view)) continue;
      remedies.push_back(fmt::format("--size {}x{}", larger.size.width, larger.size.height));
      return;
    }
  }

  void try_zooms(std::vector<std::string>& remedies) {
    for (int times = 2; times <= 1 << 20; times *= 2) {
      ViewRequest nearer = run_.options.view;
      nearer.zoom *= times;
      if (!shows(frame_, nearer)) continue;
      remedies.push_back(fmt::format("--zoom {:g}", nearer.zoom));
      return;
    }
  }

  /// Tries `--scale` if the box is thin and the view depends on it.
  void try_scale(std::vector<std::string>& remedies) {
    const glm::dvec3 side = run_.box.high - run_.box.low;
    const double longest = std::max({side.x, side.y, side.z});
    if (frame_.camera && !run_.options.view.fit) return;
    glm::dvec3 scale(1);
    for (int axis = 0; axis < 3; ++axis)
      if (side[axis] > 0 && side[axis] * 20 < longest) scale[axis] = rounded_up(longest / 8 / side[axis]);
    if (scale == glm::dvec3(1) || !shows(frame_, run_.options.view, scale)) return;
    const glm::dvec3 all = scale * run_.data.axis_scale();
    remedies.push_back(fmt::format("--scale {:.3g},{:.3g},{:.3g}", all.x, all.y, all.z));
  }

  /// Adds a camera in front of the largest cell, which always shows something.
  void add_camera(std::vector<std::string>& remedies) {
    const TrialCells::Cell cell = largest();
    if (!(cell.radius > 0)) return;
    const Camera camera = frame_.view(run_.box, run_.options.projection, run_.options.view, run_.axes);
    const ViewBasis basis = view_basis(camera);
    const glm::dvec3 c = cell.centre, eye = c - basis.forward * (diagonal(run_.box) + cell.radius);
    remedies.push_back(fmt::format(
        "--camera '{{\"position\": [{:.9g}, {:.9g}, {:.9g}], \"focal_point\": [{:.9g}, {:.9g}, {:.9g}], \"view_up\": "
        "[{:.6g}, {:.6g}, {:.6g}], \"parallel_scale\": {:.3g}}}'",
        eye.x, eye.y, eye.z, c.x, c.y, c.z, basis.up.x, basis.up.y, basis.up.z, 4 * cell.radius));
  }

  void try_framing(std::vector<std::string>& remedies) {
    const ViewRequest& asked = run_.options.view;
    if (frame_.camera) {
      if (frame_.camera->clipping_range) {
        Camera unclipped = frame_.view(run_.box, run_.options.projection, asked, run_.axes);
        unclipped.clipping_range.reset();
        if (shows(unclipped)) remedies.emplace_back("a camera without its clipping_range");
      }
      ViewRequest fitted = asked;
      fitted.fit = true;
      if (shows(frame_, fitted)) remedies.emplace_back("--fit");
    }
    if (asked.zoom > 1) {
      ViewRequest farther = asked;
      farther.zoom = 1;
      if (shows(frame_, farther)) remedies.emplace_back("a view without --zoom");
    }
    if (!remedies.empty() || !frame_.camera) return;
    FilmFrame framed = frame_;
    framed.camera.reset();
    if (shows(framed, {})) remedies.emplace_back("a view without --camera");
  }

  [[nodiscard]] bool is_in_view() {
    const Camera camera = frame_.view(run_.box, run_.options.projection, run_.options.view, run_.axes);
    return sum(cells_.is_in_view(camera, frame_.size) ? 1 : 0) > 0;
  }

 private:
  [[nodiscard]] std::uint64_t sum(std::uint64_t own) {
    std::uint64_t all = 0;
    for (int rank = 0; rank < run_.job.size(); ++rank) all += of_rank(run_.job, rank, own);
    return all;
  }
  [[nodiscard]] TrialCells::Cell largest() {
    TrialCells::Cell most;
    const TrialCells::Cell own = cells_.largest();
    for (int rank = 0; rank < run_.job.size(); ++rank)
      if (const auto cell = of_rank(run_.job, rank, own); cell.radius > most.radius) most = cell;
    return most;
  }

  const FinishedRun& run_;
  const FilmFrame& frame_;
  TrialCells cells_;
};

std::string words_of(const std::vector<std::string>& remedies) {
  if (remedies.empty()) return no_volume;
  return fmt::format("{} shows something", fmt::join(remedies, " or "));
}

std::string advice_on_clear(const std::array<double, 2>& range, const FinishedRun& run) {
  const auto knots = run.function.knots();
  const std::string why = fmt::format(
      "the transfer function is transparent over all values of the field, {:.6g} to {:.6g}", range[0], range[1]);
  if (knots.empty() || !run.function.visible(knots.front().value, knots.back().value, emits(run.options)))
    return why + "; give it opacity";
  return fmt::format("{}; --range {:.6g},{:.6g} stretches the transfer function over these values", why, range[0],
                     range[1]);
}

/// Whether a ray inside visible values, as long as a ten-thousandth of the box, would give more than zero in single
/// precision.
bool would_show(const Dataset& data, const TransferFunction& function, const RenderOptions& options) {
  const double most = emits(options) ? function.max_color() : function.max_extinction();
  return most * diagonal(data.bounds()) > 1e-2;
}

std::string advice_on_faint(const MostOfPixels& most_seen, const FinishedRun& run) {
  if (emits(run.options))
    return fmt::format("no pixel is brighter than {:.2g}; give the transfer function brighter colours",
                       most_seen.light);
  if (most_seen.alpha == 0 && run.data.mesh_counts().cells_zero_volume > 0) return no_volume;
  const double thickest = diagonal(run.box) * run.function.max_extinction();  // smaller values are zero in single
                                                                              // precision
  const double most = most_seen.alpha > 0 ? most_seen.alpha : std::max(thickest, 1e-300);
  return fmt::format("no pixel is more opaque than {:.2g}; --opacity-scale {:g} shows something", most_seen.alpha,
                     rounded_up(run.options.function.opacity_scale * 0.7 / most));
}

}  // namespace

MostOfPixels most_of(const Image& image) {
  MostOfPixels most;
  for (std::size_t i = 0; i < image.rgba.size() && most.shows_nothing(); i += 4) {
    most.light = std::max({most.light, image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    most.alpha = std::max(most.alpha, image.rgba[i + 3]);
  }
  return most;
}

EmptyReason reason_of_empty(const RenderedFrame& frame, const Dataset& data, const TransferFunction& function,
                            const RenderOptions& options) {
  const MostOfPixels most = most_of(frame.image);
  if (frame.image.rgba.empty() || !most.shows_nothing()) return EmptyReason::none;
  const auto [low, high] = data.range();
  if (!function.visible(low, high, emits(options))) return EmptyReason::clear;
  const bool has_nothing = most.alpha == 0 && most.light == 0;
  if (data.is_grid()) {
    const GridCounters& grid = frame.statistics.grid;
    if (grid.bricks_total > 0 && grid.bricks_invisible == grid.bricks_total) return EmptyReason::blank;
    if (grid.rays == 0) return EmptyReason::outside;  // or between pixels: only the box has been tested so far
    if (grid.voxels_visited == 0) return EmptyReason::missed;
    if (has_nothing && data.blank_samples() > 0) return EmptyReason::blank;
    return has_nothing && would_show(data, function, options) ? EmptyReason::missed : EmptyReason::faint;
  }
  const FrameCounters& mesh = frame.statistics.mesh;
  if (mesh.tets_total > 0 && mesh.tets_invisible == mesh.tets_total) return EmptyReason::clear;
  if (mesh.tets_projected + mesh.tets_between_pixels == 0) return EmptyReason::outside;
  if (mesh.segments == 0) return EmptyReason::between;
  const bool has_volume = data.mesh_counts().cells_zero_volume == 0;
  return has_nothing && has_volume && would_show(data, function, options) ? EmptyReason::missed : EmptyReason::faint;
}

void EmptyPictures::examine(std::size_t frame, const RenderedFrame& rendered, const Dataset& data,
                            const TransferFunction& function, const RenderOptions& options) {
  const EmptyReason reason = reason_of_empty(rendered, data, function, options);
  if (reason == EmptyReason::none) return;
  if (first_.reason == EmptyReason::none) {
    first_ = {reason, reason == EmptyReason::clear, frame, 0, most_of(rendered.image), data.range()};
    first_.is_clear = !function.visible(data.range()[0], data.range()[1], emits(options));
  }
  ++first_.count;
}

std::string EmptyPictures::warning(const FinishedRun& run) const {
  const First first = of_rank(run.job, run.writer, first_);
  if (first.reason == EmptyReason::none) return "";
  const FilmFrame& frame = run.frames[first.frame];
  const bool has_surfaces = !run.options.settings.surfaces.empty() || !run.options.block_surfaces.empty();
  if (first.is_clear && !has_surfaces && frame.step == run.frames.front().step) return "";
  const std::string which = run.frames.size() == 1 ? "the image is empty"
                            : first.count == 1     ? fmt::format("the image of frame {} is empty", first.frame + 1)
                                                   : fmt::format("{} of {} images are empty, that of frame {} because",
                                                                 first.count, run.frames.size(), first.frame + 1);
  return fmt::format("{}: {}", which,
                     frame.step == run.step || first.reason == EmptyReason::clear
                         ? advice(first, run)
                         : "render that step alone to get advice on what shows something");
}

std::string EmptyPictures::advice(const First& first, const FinishedRun& run) {
  EmptyReason reason = first.reason;
  if (reason == EmptyReason::clear) return advice_on_clear(first.range, run);
  if (reason == EmptyReason::faint) return advice_on_faint(first.most, run);
  if (reason == EmptyReason::blank)
    return run.options.read.selection.threshold
               ? "no voxel that the transfer function shows has all its values in --threshold; leave it out, or give a "
                 "wider range"
               : "no voxel that the transfer function shows has a number at each of its corners; choose another "
                 "--field";
  if (reason == EmptyReason::missed) {
    const bool is_part = run.frames[first.frame].camera || run.options.view.zoom > 1;
    return fmt::format(
        "no ray meets a value that the transfer function shows; {}, or give --range {:.6g},{:.6g}, which stretches it "
        "over the field's values",
        is_part ? "leave --zoom and --camera out to see the whole" : "give a larger --size", first.range[0],
        first.range[1]);
  }
  Tries tries(run, run.frames[first.frame]);
  std::vector<std::string> remedies;
  // For grids only rays are counted, and for meshes tets outside the view are counted as projected unless they are
  // culled. So the view is tested.
  const bool in_view = tries.is_in_view();
  if (reason == EmptyReason::between && !in_view) reason = EmptyReason::outside;
  if (reason == EmptyReason::outside && run.data.is_grid() && in_view) reason = EmptyReason::between;
  if (reason == EmptyReason::outside) {
    tries.try_framing(remedies);
    if (remedies.empty()) tries.add_camera(remedies);
    return "nothing that the transfer function shows is in the view; " + words_of(remedies);
  }
  tries.try_sizes(remedies);
  tries.try_zooms(remedies);
  tries.try_scale(remedies);
  if (remedies.empty()) tries.add_camera(remedies);
  return "all data in the view is so thin that it is between the centres of pixels; " + words_of(remedies);
}

}  // namespace tessera::apps
