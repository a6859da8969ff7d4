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

/// Who rendered what of a grid's picture, and what it was thought to cost (Moloney 2008, Figures 1.2, 4.1, 4.4).
struct BalancePictures {
  /// The picture, dimmed, on black, and over it the outlines of the bricks that the transfer function shows, each pixel
  /// of a line in the colour of the process that rendered it. White lines where rectangles of processes meet. Of
  /// sort-last each brick in the colour of the process in whose part of the volume it lies, and white lines round
  /// parts.
  Image bricks;
  /// The cost of each pixel: black where nothing is to be done, over blue, red and yellow to white at the dearest
  /// pixel; the same white lines. Opaque. Of sort-last the outlines of parts, from blue to white by the CPU time of the
  /// process over that of the dearest.
  Image cost;
};

/// Renders one data set many times. Prepares once; renders one frame at a time. Several sessions may run at once, on
/// one data set too. Threads are the session's own share of the process (Settings::threads); it prints nothing and
/// changes nothing of the process.
///
/// On several ranks constructor, render() and destructor are collective: every rank calls them in the same order, with
/// the same arguments but for sinks and stops. What a session of one process throws leaves it usable. On several ranks
/// an error is thrown on all of them, and leaves the session usable if it is found before anything is sent (settings,
/// views, transfer functions); after any other it can only be destroyed.
class TESSERA_EXPORT Session {
 public:
  /// Throws Error(bad_input) naming the setting that is out of range or does not go with another or with the data.
  explicit Session(Dataset dataset, const Settings& settings = {}, const Communicator& communicator = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  /// One picture, the same bits for any number of threads. `sink`, if any, is given tiles as they finish; the picture
  /// is what is returned, on the rank that assembles. Once `stop` is asked for, on any rank, it returns on all within
  /// one batch of cells or one tile of rays, with RenderedFrame::stopped, and the session can go on.
  ///
  /// Throws Error(bad_input) for an invalid camera or size, or a view that the settings cannot do;
  /// Error(system_failure) if memory or the budget run out; what the sink throws.
  RenderedFrame render(const View& view, const TransferFunction& transfer_function, const FrameSettings& settings = {},
                       Sink* sink = nullptr, const std::stop_token& stop = {});

  /// A film: on several ranks frames overlap (RankSettings::frames_in_flight). Each goes to sink.frame() as it is
  /// complete. Returns how many were completed, on every rank: all, unless stopped.
  std::size_t render(std::span<const View> views, const TransferFunction& transfer_function,
                     const FrameSettings& settings, Sink& sink, const std::stop_token& stop = {});

  /// Whether this rank assembles the pictures: is told of tiles and gets images.
  [[nodiscard]] bool assembles() const;

  /// The largest error that is promised, in linear RGBA against exact arithmetic: of meshes 2e-5 for exact, of grids
  /// 1e-5; what was asked for automatic; none for the other methods, the scanline
  /// rasterizer and GlMethod::fragment.
  [[nodiscard]] std::optional<double> promised_error() const;

  /// Checks `count` pixels of a finished picture against a double-precision reference: a third at random, the rest
  /// where the picture is least sure. Not collective; the data set must be whole on this rank, or opened from files,
  /// which are then read once more.
  [[nodiscard]] Verification verify(const RenderedFrame& frame, const View& view,
                                    const TransferFunction& transfer_function, std::size_t count) const;

  /// Of a grid's last frame, rendered with FrameSettings::keep_cost, on the rank that assembles: see BalancePictures.
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
