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

/// Two images that show which process rendered which part of a grid's image, and the predicted cost (Moloney 2008,
/// Figures 1.2, 4.1, 4.4).
struct BalancePictures {
  /// The dimmed image on black, with the outlines of the visible bricks. Each pixel of a line has the colour of the
  /// process that rendered the pixel, and white lines separate the rectangles of the processes. With sort-last, each
  /// brick has the colour of the process whose part of the volume contains the brick, and white lines outline the
  /// parts.
  Image bricks;
  /// The cost of each pixel, from black (no work) through blue, red and yellow to white (the most expensive pixel),
  /// with the same white lines as in `bricks`. Opaque. With sort-last, the image contains the outlines of the parts
  /// instead, with colours from blue to white by the CPU time of the process, relative to the longest CPU time of any
  /// process.
  Image cost;
};

/// Renders one data set many times: a session prepares the data once, then renders one frame at a time. Several
/// sessions may run at the same time, also with the same data set. Each session has its own threads
/// (Settings::threads). A session prints nothing and does not change the state of the process.
///
/// On several ranks, the constructor, render() and the destructor are collective: every rank calls them in the same
/// order, with the same arguments except for sinks and stop tokens. A session of one process remains usable after an
/// exception. On several ranks, an error is thrown on all ranks. The session remains usable if the error was found
/// before anything was sent (in settings, views or transfer functions); after any other error it can only be destroyed.
class TESSERA_EXPORT Session {
 public:
  /// Throws Error(bad_input), which names the setting, if a setting is out of range or incompatible with another
  /// setting or with the data.
  explicit Session(Dataset dataset, const Settings& settings = {}, const Communicator& communicator = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// Renders one image, which has the same bits for any number of threads. `sink`, if any, receives tiles as soon as
  /// they are complete. The image is returned on the rank that assembles it. If a stop is requested on any rank, the
  /// function returns on all ranks, within the time for one batch of cells or one tile of rays, with
  /// RenderedFrame::stopped set; the session remains usable.
  ///
  /// Throws Error(bad_input) for an invalid camera or size and for a view that the settings do not support;
  /// Error(system_failure) if memory, or the limit Settings::memory_bytes, is exhausted; and the exceptions of the
  /// sink.
  RenderedFrame render(const View& view, const TransferFunction& transfer_function, const FrameSettings& settings = {},
                       Sink* sink = nullptr, const std::stop_token& stop = {});

  /// Renders a film. On several ranks, several frames are in progress at the same time
  /// (RankSettings::frames_in_flight). Each frame is passed to sink.frame() when it is complete. Returns, on every
  /// rank, the number of completed frames: all, unless a stop was requested.
  std::size_t render(std::span<const View> views, const TransferFunction& transfer_function,
                     const FrameSettings& settings, Sink& sink, const std::stop_token& stop = {});

  /// Whether this rank assembles the images: on this rank the sink receives tiles, and render() returns images.
  [[nodiscard]] bool assembles() const;

  /// The largest error that is promised, as a difference of linear RGBA from exact arithmetic. With the integrator
  /// `exact` it is 2e-5 for meshes and 1e-5 for grids; with `automatic` it is the requested accuracy. None for the
  /// other integrators, for the scanline rasterizer and for GlMethod::fragment.
  [[nodiscard]] std::optional<double> promised_error() const;

  /// Checks `count` pixels of a finished image against a double-precision reference. A third of the pixels is chosen at
  /// random, the others where the image is least certain. Not collective. The data set must be whole on this rank or
  /// opened from files, which are then read again.
  [[nodiscard]] Verification verify(const RenderedFrame& frame, const View& view,
                                    const TransferFunction& transfer_function, std::size_t count) const;

  /// Returns the images of BalancePictures for a grid's last frame. The frame must have been rendered with
  /// FrameSettings::keep_cost. Call this on the rank that assembles. Throws Error(bad_input) for a mesh.
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
