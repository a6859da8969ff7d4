// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/communicator.hpp"
#include "api/queries/verify.hpp"
#include "api/selected_dataset.hpp"
#include "api/session_state.hpp"
#include "frame/mesh/peel.hpp"
#include "scene/directions.hpp"
#include "scene/error.hpp"
#include "scene/pixel_view.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

/// Returns the view with its magnification limited: a parallel scale of at least 1e-60 of the largest coordinate of the
/// data relative to the eye, or a view angle of at least 1e-60 degrees. This is far below the resolution of positions,
/// so that the image does not change, and it keeps products of pixel coordinates within the range of double.
View within_range(View view, const Box& box) {
  constexpr double least = 1e-60;
  Camera& camera = view.camera;
  if (camera.projection == ProjectionKind::perspective) {
    camera.view_angle = std::max(camera.view_angle, least);
  } else if (!box.empty()) {
    const double reach =
        std::max(scene::largest(box.low - camera.position), scene::largest(box.high - camera.position));
    camera.parallel_scale = std::max(camera.parallel_scale, least * reach);
  }
  return view;
}

/// Whether products of pixel coordinates are finite everywhere in a box. The coordinates are linear in the position, so
/// that testing the corners is sufficient.
bool has_coordinates(const View& view, const Box& box) {
  const scene::PixelView seen(view.camera, view.size);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                       (corner & 4) != 0 ? box.high.z : box.low.z);
    const scene::PixelPlace place = seen.project(p);
    // Products have up to three coordinates or two depths as factors.
    if (!(std::max({std::abs(place.x), std::abs(place.y), std::abs(place.w)}) < 1e100)) return false;
    if (!(std::abs(place.depth) < 1e150)) return false;
  }
  return true;
}

void check_view(const View& view) {
  try {
    validate(view.camera);
  } catch (const Error& error) {
    throw Error(error.code(), std::string("view: ") + error.what());
  }
  validate(view.size);
}

void check_reach(const View& view, const Box& bounds) {
  if (!bounds.empty() && !has_coordinates(view, bounds))
    throw scene::bad_input(
        "view: data and camera are too far apart for positions in the image to be computed; move the camera nearer");
}

/// Returns the single frame of a film of one frame.
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

Verification public_form(const api::Verified& verified) {
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

DataKind kind_of(const Dataset& data) { return data.is_grid() ? DataKind::grid : DataKind::mesh; }

void check_data(const Settings& settings, const Dataset& data) {
  if (!settings.surfaces.iso.empty() && data.association() == Association::cell)
    throw scene::bad_input(fmt::format(
        "`iso`: the field has one value per cell, so it has no iso-surfaces; use {}a `field` with values at points",
        data.is_mesh() ? "`smooth`, or " : ""));
  if (data.is_grid() && data.grid_geometry().rectilinear() && volume::in_steps(settings.integrator.kind))
    throw scene::bad_input("`integrator`: a rectilinear grid is not rendered in steps; use auto or exact");
}

std::unique_ptr<Session::State> make_state(Dataset dataset, const Settings& settings,
                                           std::shared_ptr<exchange::Transport> transport) {
  validate(settings, kind_of(dataset));
  check_data(settings, dataset);
  if (dataset.is_grid()) return api::grid_by_rays(std::move(dataset), settings, std::move(transport));
  if (transport->size() == 1 && settings.mesh.device.backends.empty())
    return api::mesh_alone(std::move(dataset), settings);
  return api::mesh_on_ranks(std::move(dataset), settings, std::move(transport));
}

}  // namespace

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::Session(Dataset dataset, const Settings& settings, const Communicator& communicator)
    : Session(make_state(std::move(dataset), settings, StateAccess::of(communicator).connect())) {}

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
  validate(settings, this->settings(), kind_of(dataset()));
  std::vector<View> seen;
  seen.reserve(views.size());
  for (const View& view : views) {
    check_view(view);
    seen.push_back(within_range(view, dataset().bounds()));
    check_reach(seen.back(), dataset().bounds());
    if (settings.peel) frame::check_peel(*settings.peel, view.size, this->settings().memory_bytes);
  }
  return state_->render(seen, transfer_function, settings, sink, stop);
}

bool Session::assembles() const { return state_->assembles(); }

std::optional<double> Session::promised_error() const { return api::promised_error(settings(), kind_of(dataset())); }

Verification Session::verify(const RenderedFrame& frame, const View& view, const TransferFunction& transfer_function,
                             std::size_t count) const {
  check_view(view);
  if (frame.image.size != view.size)
    throw scene::bad_input(
        "verify: the frame's size differs from this view's; give the view with which it was rendered");
  const api::Layers layers{frame.layers, frame.peel};
  const Dataset::State& data = StateAccess::of(dataset());
  if (dataset().is_grid())
    return public_form(api::verify_all(frame.image, layers, *data.samples, view.camera, transfer_function,
                                       {settings(), data.clip}, frame.uncertainty, count));
  return public_form(
      api::verify_all(frame.image, layers, api::uncut_mesh(data), view.camera, transfer_function, settings(), count));
}

BalancePictures Session::State::balance_pictures(const RenderedFrame&, const View&, const TransferFunction&) const {
  throw scene::bad_input("balance: it is drawn only for grids, but the data set is a mesh; leave it out");
}

BalancePictures Session::balance_pictures(const RenderedFrame& frame, const View& view,
                                          const TransferFunction& transfer_function) const {
  return state_->balance_pictures(frame, view, transfer_function);
}

const Dataset& Session::dataset() const { return state_->dataset(); }
const Settings& Session::settings() const { return state_->settings(); }
}  // namespace v0_1
}  // namespace tessera
