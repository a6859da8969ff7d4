// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>

#include "api/dataset.hpp"
#include "exchange/transport.hpp"
#include "scene/frame_watch.hpp"
#include "tessera/session.hpp"
#include "tessera/settings.hpp"

namespace tessera {
inline namespace v0_1 {

/// Renders one kind of data with one or several processes.
class TESSERA_HIDDEN Session::State {
 public:
  State(Dataset dataset, const Settings& settings) : dataset_(std::move(dataset)), settings_(settings) {}
  virtual ~State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  virtual std::size_t render(std::span<const View> views, const TransferFunction& function,
                             const FrameSettings& settings, Sink& sink, const std::stop_token& stop) = 0;
  [[nodiscard]] virtual bool assembles() const { return true; }

  [[nodiscard]] const Dataset& dataset() const { return dataset_; }
  [[nodiscard]] const Settings& settings() const { return settings_; }
  /// Only for grids.
  [[nodiscard]] virtual BalancePictures balance_pictures(const RenderedFrame& frame, const View& view,
                                                         const TransferFunction& function) const;

 protected:
  [[nodiscard]] const Dataset::State& data() const { return StateAccess::of(dataset_); }

 private:
  Dataset dataset_;
  Settings settings_;
};

}  // namespace v0_1

namespace api {

/// Make the state for a mesh that is rendered by this process alone or by all ranks.
std::unique_ptr<Session::State> mesh_alone(Dataset dataset, const Settings& settings);
std::unique_ptr<Session::State> mesh_on_ranks(Dataset dataset, const Settings& settings,
                                              std::shared_ptr<exchange::Transport> transport);
/// Makes the state for a grid that is rendered by one or several ranks.
std::unique_ptr<Session::State> grid_by_rays(Dataset dataset, const Settings& settings,
                                             std::shared_ptr<exchange::Transport> transport);

/// An exception from the caller's sink. Unlike an error of the run, it stops a frame but leaves the session usable.
struct SinkFailure {
  std::exception_ptr cause;
};

template <class Call>
void call_sink(const Call& call) {
  try {
    call();
  } catch (...) {
    throw SinkFailure{std::current_exception()};
  }
}

/// Returns a callback that passes the tiles of frame `number` to `sink`. The callback throws SinkFailure if the sink
/// throws.
inline scene::FrameWatch::Finished tiles_to(Sink& sink, std::size_t number) {
  if (!sink.wants_tiles()) return {};
  return [&sink, number](const PixelRect& rect, const Image& image) {
    call_sink([&] { sink.tile({number, rect, image}); });
  };
}

inline RenderedFrame stopped_frame(std::size_t number) {
  RenderedFrame frame;
  frame.number = number;
  frame.stopped = true;
  return frame;
}

}  // namespace api
}  // namespace tessera
