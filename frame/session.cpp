#include "tessera/session.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "frame/communicator.hpp"
#include "frame/peel.hpp"
#include "frame/session_state.hpp"
#include "frame/uncut_mesh.hpp"
#include "frame/verify.hpp"
#include "scene/error.hpp"

namespace tessera {
namespace {

void check_view(const View& view) {
  try {
    validate(view.camera);
  } catch (const Error& error) {
    throw Error(error.code(), std::string("view: ") + error.what());
  }
  validate(view.size);
}

/// Gives a film of one frame to whoever asked for it alone.
class OneFrame final : public Sink {
 public:
  explicit OneFrame(Sink* tiles) : tiles_(tiles) {}
  [[nodiscard]] bool wants_tiles() const override { return tiles_ != nullptr && tiles_->wants_tiles(); }
  void tile(const Tile& tile) override { tiles_->tile(tile); }
  void frame(RenderedFrame&& frame) override { frame_ = std::move(frame); }
  Image spare_image(ImageSize size) override { return tiles_ != nullptr ? tiles_->spare_image(size) : Image(); }
  RenderedFrame take() { return std::move(frame_); }

 private:
  Sink* tiles_;
  RenderedFrame frame_;
};

Verification public_form(const frame::Verified& verified) {
  const reference::Verification& v = verified.picture;
  const auto reason = [](const std::optional<reference::Suspicion>& why) -> std::string {
    return why ? reference::name_of(*why) : "random";
  };
  const auto tally = [](std::string name, const reference::Tally& t) {
    return Verification::Tally{std::move(name), t.pixels, t.max_error, t.over_bound, t.excused};
  };
  Verification result;
  const reference::Judgement& j = v.judgement;
  result.pixels_checked = j.pixels_checked, result.over_bound = j.over_bound, result.excused = j.excused;
  result.max_error = j.max_error, result.max_error_not_excused = j.max_error_not_excused;
  result.rms_error = j.rms_error;
  result.worst_x = j.worst_x, result.worst_y = j.worst_y;
  result.worst_value = j.worst_value, result.worst_reference = j.worst_reference;
  result.worst_reason = reason(v.worst);
  result.tallies.push_back(tally("random", v.random));
  for (std::size_t kind = 0; kind < reference::suspicions; ++kind)
    if (v.chosen[kind].pixels > 0)
      result.tallies.push_back(tally(reference::name_of(static_cast<reference::Suspicion>(kind)), v.chosen[kind]));
  result.bound = v.bound;
  result.met = v.met() && verified.layers.met;
  result.layer_bound = verified.layers.bound, result.layers_met = verified.layers.met;
  for (const reference::Tally& layer : verified.layers.layers)
    result.layers.push_back(tally(fmt::format("layer {}", result.layers.size() + 1), layer));
  return result;
}

std::unique_ptr<Session::State> make_state(Dataset dataset, const Settings& settings,
                                           std::shared_ptr<exchange::Transport> transport) {
  if (dataset.is_grid()) return frame::grid_by_rays(std::move(dataset), settings, std::move(transport));
  if (transport->size() == 1 && settings.mesh.device.backends.empty())
    return frame::mesh_alone(std::move(dataset), settings);
  return frame::mesh_on_ranks(std::move(dataset), settings, std::move(transport));
}

}  // namespace

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::Session(Dataset dataset, const Settings& settings, const Communicator& communicator)
    : Session(make_state(std::move(dataset), settings, communicator.state().connect())) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

RenderedFrame Session::render(const View& view, const TransferFunction& transfer_function,
                              const FrameSettings& settings, Sink* sink, const std::stop_token& stop) {
  OneFrame one(sink);
  render(std::span(&view, 1), transfer_function, settings, one, stop);
  return one.take();
}

std::size_t Session::render(std::span<const View> views, const TransferFunction& transfer_function,
                            const FrameSettings& settings, Sink& sink, const std::stop_token& stop) {
  if (transfer_function.knots().empty())
    throw scene::bad_input("transfer function: it has no knots; give at least one, or load a preset");
  for (const View& view : views) {
    check_view(view);
    if (settings.peel) frame::check_peel(*settings.peel, view.size, this->settings().memory_bytes);
  }
  return state_->render(views, transfer_function, settings, sink, stop);
}

bool Session::assembles() const { return state_->assembles(); }

std::optional<double> Session::promised_error() const {
  return dataset().is_grid() ? frame::promised_error(frame::grid_settings(settings()))
                             : frame::promised_error(frame::mesh_settings(settings()));
}

Verification Session::verify(const RenderedFrame& frame, const View& view, const TransferFunction& transfer_function,
                             std::size_t count) const {
  check_view(view);
  if (frame.image.size != view.size)
    throw scene::bad_input("verify: the frame is not of this view's size; give the view it was rendered with");
  const frame::Layers layers{frame.layers, frame.peel};
  const Dataset::State& data = dataset().state();
  if (dataset().is_grid()) {
    volume::RenderSettings grid = frame::grid_settings(settings());
    grid.clip = data.clip;
    return public_form(frame::verify_all(frame.image, layers, *data.samples, view.camera, transfer_function, grid,
                                         frame.uncertainty, count));
  }
  const frame::RenderSettings settings = frame::mesh_settings(this->settings());
  return public_form(
      frame::verify_all(frame.image, layers, frame::uncut_mesh(data), view.camera, transfer_function, settings, count));
}

BalancePictures Session::State::balance_pictures(const RenderedFrame&, const View&, const TransferFunction&) const {
  throw scene::bad_input("balance: pictures are of grids, and the data set is a mesh; leave them out");
}

BalancePictures Session::balance_pictures(const RenderedFrame& frame, const View& view,
                                          const TransferFunction& transfer_function) const {
  return state_->balance_pictures(frame, view, transfer_function);
}

const Dataset& Session::dataset() const { return state_->dataset(); }
const Settings& Session::settings() const { return state_->settings(); }
}  // namespace tessera
