// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/settings.hpp"
#include "tessera/sink.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/verification.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

/// Which process rendered what of a grid's image, and the predicted cost (Moloney 2008, Figures 1.2, 4.1, 4.4).
struct BalancePictures {
  /// The image, dimmed, on black, with the outlines of the visible bricks, each pixel of a line in the colour of the
  /// process that rendered it. White lines separate the rectangles of processes. With sort-last each brick has the
  /// colour of the process whose part of the volume contains it, and white lines outline the parts.
  Image bricks;
  /// The cost of each pixel: from black (no work) over blue, red and yellow to white at the most expensive pixel, with
  /// the same white lines. Opaque. With sort-last the outlines of parts, from blue to white by the CPU time of the
  /// process relative to the most expensive one.
  Image cost;
};

/// Renders one data set many times: prepares once, then renders one frame at a time. Several sessions may run at once,
/// also on one data set. Each session has its own threads (Settings::threads); it prints nothing and does not change
/// the state of the process.
///
/// On several ranks constructor, render() and destructor are collective: every rank calls them in the same order, with
/// the same arguments except for sinks and stop tokens. An exception of a session of one process leaves it usable. On
/// several ranks an error is thrown on all of them. It leaves the session usable if it is found before anything is sent
/// (settings, views, transfer functions); after any other error the session can only be destroyed.
class TESSERA_EXPORT Session {
 public:
  /// Throws Error(bad_input) naming the setting that is out of range or incompatible with another one or with the data.
  explicit Session(Dataset dataset, const Settings& settings = {}, const Communicator& communicator = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Renders one image, with the same bits for any number of threads. `sink`, if any, receives tiles as they finish;
  /// the image is returned on the rank that assembles. If a stop is requested on any rank, it returns on all ranks
  /// within one batch of cells or one tile of rays, with RenderedFrame::stopped; the session remains usable.
  ///
  /// Throws Error(bad_input) for an invalid camera or size, or a view that the settings do not support;
  /// Error(system_failure) if memory or the budget is exhausted; and whatever the sink throws.
  RenderedFrame render(const View& view, const TransferFunction& transfer_function, const FrameSettings& settings = {},
                       Sink* sink = nullptr, const std::stop_token& stop = {});

  /// Renders a film: on several ranks frames overlap (RankSettings::frames_in_flight). Each frame is passed to
  /// sink.frame() when it is complete. Returns, on every rank, how many were completed: all, unless stopped.
  std::size_t render(std::span<const View> views, const TransferFunction& transfer_function,
                     const FrameSettings& settings, Sink& sink, const std::stop_token& stop = {});

  /// Whether this rank assembles the images: its sink receives tiles, and it returns images.
  [[nodiscard]] bool assembles() const;

  /// The largest error that is promised, in linear RGBA against exact arithmetic: 2e-5 for meshes and 1e-5 for grids
  /// with `exact`; the requested accuracy with `automatic`; none for the other methods, the scanline rasterizer and
  /// GlMethod::fragment.
  [[nodiscard]] std::optional<double> promised_error() const;

  /// Checks `count` pixels of a finished image against a double-precision reference: a third at random, the rest where
  /// the image is least certain. Not collective; the data set must be whole on this rank, or opened from files, which
  /// are then read again.
  [[nodiscard]] Verification verify(const RenderedFrame& frame, const View& view,
                                    const TransferFunction& transfer_function, std::size_t count) const;

  /// For a grid's last frame, rendered with FrameSettings::keep_cost, on the rank that assembles: see BalancePictures.
  /// Throws Error(bad_input) for a mesh.
  [[nodiscard]] BalancePictures balance_pictures(const RenderedFrame& frame, const View& view,
                                                 const TransferFunction& transfer_function) const;

  [[nodiscard]] const Dataset& dataset() const;
  [[nodiscard]] const Settings& settings() const;

  class State;  ///< incomplete for callers

 private:
  explicit Session(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace v0_1
}  // namespace tessera
