#include "tessera/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "exchange/wire.hpp"
#include "frame/brick_memory.hpp"
#include "frame/communicator.hpp"
#include "frame/dataset.hpp"
#include "frame/deep_rows.hpp"
#include "frame/mesh_input.hpp"
#include "frame/run_error.hpp"
#include "frame/session_extras.hpp"
#include "frame/session_settings.hpp"
#include "frame/verify.hpp"
#include "io/mesh_reader.hpp"
#include "projection/partition.hpp"
#include "projection/segment_tuple.hpp"
#include "scene/error.hpp"

namespace tessera {
namespace {

using Clock = std::chrono::steady_clock;

FrameStatistics statistics_of(const frame::FrameStatistics& s, double milliseconds) {
  FrameStatistics statistics;
  statistics.mesh = s;
  statistics.on_lattice = s.on_lattice;
  statistics.instruction_set = s.instruction_set;
  statistics.integrator = s.integrator;
  statistics.composited_on = s.composited_on;
  statistics.milliseconds = milliseconds;
  return statistics;
}

FrameStatistics statistics_of(const frame::FinishedVolumeFrame& frame, const char* integrator) {
  FrameStatistics statistics;
  const volume::RenderStatistics& s = frame.statistics;
  statistics.grid = {s.rays,           s.voxels_visited,   s.samples,        s.pixels_again,
                     s.bricks_total,   s.bricks_invisible, s.brick_hits,     s.bricks_loaded,
                     s.bricks_evicted, s.bytes_loaded,     s.bytes_resident, s.peak_bytes,
                     s.blank_samples};
  statistics.instruction_set = s.instruction_set;
  statistics.integrator = integrator;
  statistics.milliseconds = frame.frame_ms;
  for (int process = 0; process < frame.split.processes(); ++process) {
    const volume::PixelRegion r = frame.split.region(process);
    statistics.rectangles.push_back({r.x0, r.y0, r.x1, r.y1});
  }
  statistics.samples = frame.samples;
  statistics.cpu_seconds = frame.cpu_seconds;
  return statistics;
}

const char* name_of(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::sampled:
      return "sampled";
    case IntegratorKind::preintegrated:
      return "preintegrated";
    default:
      return "exact";
  }
}

void check_view(const View& view) {
  validate(view.camera);
  validate(view.size);
}

/// Gives a film of one frame to whoever asked for it alone.
class OneFrame final : public Sink {
 public:
  explicit OneFrame(Sink* tiles) : tiles_(tiles) {}
  [[nodiscard]] bool wants_tiles() const override { return tiles_ != nullptr && tiles_->wants_tiles(); }
  void tile(const Tile& tile) override { tiles_->tile(tile); }
  void frame(RenderedFrame&& frame) override { frame_ = std::move(frame); }
  RenderedFrame take() { return std::move(frame_); }

 private:
  Sink* tiles_;
  RenderedFrame frame_;
};

/// A watch that tells `sink` of frame `number`.
scene::FrameWatch::Finished tiles_to(Sink& sink, std::size_t number) {
  if (!sink.wants_tiles()) return {};
  return [&sink, number](const PixelRect& rect, const Image& image) { sink.tile({number, rect, image}); };
}

RenderedFrame stopped_frame(std::size_t number) {
  RenderedFrame frame;
  frame.number = number;
  frame.stopped = true;
  return frame;
}

}  // namespace

/// How a kind of data is rendered by a number of processes.
class Session::State {
 public:
  State(Dataset dataset, const Settings& settings, const frame::SessionExtras& extras)
      : dataset_(std::move(dataset)), settings_(settings), bounded_(extras.bounded) {}
  virtual ~State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  virtual std::size_t render(std::span<const View> views, const TransferFunction& function,
                             const FrameSettings& settings, Sink& sink, const std::stop_token& stop) = 0;
  [[nodiscard]] virtual bool assembles() const { return true; }

  [[nodiscard]] const Dataset& dataset() const { return dataset_; }
  [[nodiscard]] const Settings& settings() const { return settings_; }
  [[nodiscard]] frame::RenderSettings mesh_settings() const {
    frame::RenderSettings settings = frame::mesh_settings(settings_);
    settings.bounded = bounded_;
    return settings;
  }

 protected:
  [[nodiscard]] const Dataset::State& data() const { return dataset_.state(); }

 private:
  Dataset dataset_;
  Settings settings_;
  bool bounded_;
};

namespace {

/// A mesh, by this process.
class MeshAlone final : public Session::State {
 public:
  MeshAlone(Dataset dataset, const Settings& settings, const frame::SessionExtras& extras)
      : State(std::move(dataset), settings, extras),
        renderer_(data().prepared(settings.threads, extras.projecting), data().facts, traced(settings, extras)) {
    frame::assign_roles(1, settings.ranks.projectors, settings.ranks.compositors);  // of one rank there are not more
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    renderer_.set_deep_accuracy(settings.deep_accuracy);
    for (std::size_t i = 0; i < views.size(); ++i) {
      RenderedFrame frame;
      frame.number = i;
      frame::FrameStatistics statistics;
      scene::FrameWatch watch(stop, tiles_to(sink, i));
      const auto start = Clock::now();
      try {
        frame.image = renderer_.render(views[i].camera, views[i].size, function, &statistics,
                                       settings.deep ? &frame.deep : nullptr, &watch);
      } catch (const scene::FrameStopped&) {
        sink.frame(stopped_frame(i));
        return i;
      }
      frame.statistics =
          statistics_of(statistics, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      sink.frame(std::move(frame));
    }
    return views.size();
  }

 private:
  static frame::RenderSettings traced(const Settings& settings, const frame::SessionExtras& extras) {
    frame::RenderSettings mesh = frame::mesh_settings(settings);
    mesh.trace = extras.projecting;
    return mesh;
  }

  frame::Renderer renderer_;
};

/// A mesh, by several processes.
class MeshOnRanks final : public Session::State {
 public:
  MeshOnRanks(Dataset dataset, const Settings& settings, std::shared_ptr<exchange::Transport> transport,
              const frame::SessionExtras& extras)
      : State(std::move(dataset), settings, extras),
        distributed_(frame::distributed_settings(settings, transport->size())),
        transport_(std::move(transport)) {
    distributed_.projecting = extras.projecting;
    distributed_.compositing = extras.compositing;
    distributed_.compositing_on = extras.compositing_on;
    distributed_.first_frame = extras.first_frame;
    const Dataset::State& state = data();
    if (distributed_.exchange == Exchange::segments && state.facts.tets > 0xffffffffull)
      throw scene::bad_input(
          fmt::format("`exchange` segments: {} tets are more than 2^32; use runs", state.facts.tets));
    const auto projects = [&](int rank) { return distributed_.roles.projects(rank); };
    if (state.ranks > 1 && state.ranks != transport_->size())
      throw scene::bad_input(fmt::format("{}: was opened by {} ranks, the session has {}; give both one communicator",
                                         state.source, state.ranks, transport_->size()));
    if (!projects(transport_->rank()) && state.ranks > 1 && !state.mesh.tets.empty())
      throw scene::bad_input(
          fmt::format("{}: rank {} has cells and does not project; give data set and session the same `projectors` and "
                      "`compositors`",
                      state.source, transport_->rank()));
    renderer_.emplace(*transport_, distributed_, [this](std::size_t) { return part(); });
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    renderer_->set_deep(settings.deep, settings.deep_accuracy);
    std::vector<frame::FrameJob> jobs;
    for (const View& view : views) jobs.push_back({view.camera, view.size, 0});
    std::size_t complete = 0;
    bool ended = false;
    frame::DistributedCallbacks callbacks;
    callbacks.frame = [&](frame::FinishedFrame finished) {
      if (ended) return;
      if (finished.stopped) {
        ended = true;
        sink.frame(stopped_frame(finished.frame));
        return;
      }
      ++complete;
      RenderedFrame frame;
      frame.number = finished.frame;
      frame.image = std::move(finished.image);
      frame.deep = std::move(finished.deep);
      frame.statistics = statistics_of(finished.statistics, finished.frame_ms);
      sink.frame(std::move(frame));
    };
    if (sink.wants_tiles())
      callbacks.tile = [&](std::size_t number, const PixelRect& rect, const Image& image) {
        sink.tile({number, rect, image});
      };
    std::exception_ptr thrown;
    try {
      renderer_->render(jobs, function, callbacks, stop);
    } catch (const scene::Error&) {
      throw;
    } catch (...) {
      thrown = std::current_exception();
    }
    exchange::Bytes bytes;
    exchange::append(bytes, static_cast<std::uint64_t>(complete));
    bytes = exchange::broadcast(*transport_, distributed_.roles.assembler(), std::move(bytes));
    if (thrown) std::rethrow_exception(thrown);
    complete = exchange::RecordReader(bytes).take<std::uint64_t>();
    if (!assembles() && complete < views.size()) sink.frame(stopped_frame(complete));
    return complete;
  }

  [[nodiscard]] bool assembles() const override { return transport_->rank() == distributed_.roles.assembler(); }

 private:
  /// What this rank projects: the part it was opened with, or its share of the whole that every rank has.
  frame::ProjectorMesh part() {
    const Dataset::State& state = data();
    frame::ProjectorMesh mesh;
    mesh.diagonal = frame::diagonal(state.facts.box);
    mesh.box = state.facts.box;
    mesh.scalar_range = state.facts.scalar_range;
    if (distributed_.render.rasterizer == Rasterizer::scanline) {
      mesh.longest_edge = projection::longest_edge(state.mesh);
      if (state.ranks > 1) mesh.longest_edge = longest_of_all(mesh.longest_edge);
    }
    const auto& projectors = distributed_.roles.projectors;
    const bool is_only_projector = projectors.size() == 1 && projectors.front() == transport_->rank();
    if (state.ranks > 1 || is_only_projector) {
      mesh.part = state.mesh;
      mesh.global_tet = state.global_tet;
      mesh.prepared = state.prepared(settings().threads, distributed_.projecting);
      return mesh;
    }
    const auto own = std::find(projectors.begin(), projectors.end(), transport_->rank());
    auto share = std::make_shared<scene::TetMesh>();
    share->association = state.mesh.association;
    if (own != projectors.end()) {
      const auto part_of =
          projection::parts_of_whole(state.mesh, settings().ranks.partition, static_cast<int>(projectors.size()));
      std::vector<std::uint32_t> mine;
      for (std::uint32_t tet = 0; tet < part_of.size(); ++tet)
        if (part_of[tet] == static_cast<std::uint32_t>(own - projectors.begin())) mine.push_back(tet);
      *share = scene::subset(state.mesh, mine);
      mesh.global_tet.assign(mine.begin(), mine.end());
    }
    frame::order_corners(*share, distributed_.render);
    mesh.part = *share;
    mesh.owner = std::move(share);
    return mesh;
  }

  float longest_of_all(float longest) {
    exchange::Bytes mine;
    exchange::append(mine, longest);
    for (const exchange::Bytes& other : exchange::gather_all(*transport_, std::move(mine)))
      longest = std::max(longest, exchange::RecordReader(other).take<float>());
    return longest;
  }

  frame::DistributedSettings distributed_;
  std::shared_ptr<exchange::Transport> transport_;
  std::optional<frame::DistributedRenderer> renderer_;
};

/// A grid, by any number of processes.
class GridByRays final : public Session::State {
 public:
  GridByRays(Dataset dataset, const Settings& settings, std::shared_ptr<exchange::Transport> transport,
             const frame::SessionExtras& extras)
      : State(std::move(dataset), settings, extras),
        transport_(std::move(transport)),
        trace_(extras.projecting),
        keeps_cost_(extras.keep_cost) {
    check();
    make_renderer({});
    make_sort_first();
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    if (settings.deep) check_deep();
    if (settings.keep_uncertainty != keeps_uncertainty_) {
      keeps_uncertainty_ = settings.keep_uncertainty;
      make_sort_first();
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
      make_renderer(views[i].size);
      bool stopped = false;
      try {
        stopped = !make(i, views[i], function, settings, sink, stop);
      } catch (const scene::Error& error) {
        transport_->fail(error);
        transport_->check();
        throw;
      }
      if (stopped) {
        sink.frame(stopped_frame(i));
        return i;
      }
    }
    return views.size();
  }

  [[nodiscard]] bool assembles() const override { return transport_->rank() == 0; }

  [[nodiscard]] frame::GridBalance balance(const TransferFunction& function) const {
    return {split_, cost_, renderer_->visible_bricks(function)};
  }

 private:
  void make_sort_first() {
    frame::SortFirstSettings sort_first = frame::sort_first_settings(settings());
    sort_first.keep_doubts = keeps_uncertainty_;
    sort_first.keep_cost = keeps_cost_;
    sort_first.trace = trace_;
    sort_first_.emplace(*transport_, std::move(sort_first));
  }

  void check() const {
    if (settings().mesh.rasterizer != Rasterizer::planes)
      throw scene::bad_input("`rasterizer`: is for meshes, and the data set is a grid; leave it out");
  }
  void check_deep() const {
    if (!frame::promised_error(frame::grid_settings(settings())))
      throw scene::bad_input(
          "deep picture: steps along rays give light other than that of their parts; set `integrator` automatic or "
          "exact");
    if (settings().grid.shading) throw scene::bad_input("deep picture: it is not shaded; leave `shading` out");
  }

  /// Bricks get what the budget leaves beside a picture of this size: the renderer is made once it is known.
  void make_renderer(std::optional<ImageSize> size) {
    volume::RenderSettings grid = frame::grid_settings(settings());
    if (!size) {
      // Only for its checks.
      volume::Renderer(*data().samples, grid, data().ranges);
      return;
    }
    if (renderer_) return;
    const scene::TraceScope timing(trace_, "prepare");
    grid.trace = trace_;
    grid.memory_bytes = frame::brick_memory(grid.memory_bytes, resident_ + data().ranges->bytes(), *size, grid.threads);
    renderer_.emplace(*data().samples, grid, data().ranges);
  }

  /// False if it was stopped.
  bool make(std::size_t number, const View& view, const TransferFunction& function, const FrameSettings& settings,
            Sink& sink, const std::stop_token& stop) {
    scene::FrameWatch watch(stop, tiles_to(sink, number));
    std::exception_ptr thrown;
    std::optional<frame::FinishedVolumeFrame> finished;
    try {
      // A trace's numbers are its caller's.
      const std::size_t traced = trace_ != nullptr ? static_cast<std::size_t>(std::max(trace_->frame(), 0)) : number;
      finished = sort_first_->render(*renderer_, function, {view.camera, view.size}, traced, &watch);
    } catch (const scene::Error&) {
      throw;
    } catch (...) {
      thrown = std::current_exception();
    }
    const bool stopped = agreed(thrown || (finished && finished->stopped));
    if (thrown) std::rethrow_exception(thrown);
    if (stopped) return false;
    std::optional<DeepImage> deep;
    if (settings.deep) {
      const scene::TraceScope timing(trace_, "project");
      deep = frame::deep_rows(
          *transport_, *data().samples, view.camera, view.size, function,
          {settings.deep_accuracy, this->settings().emission, this->settings().threads, this->settings().memory_bytes},
          static_cast<std::int32_t>(number));
    }
    RenderedFrame frame;
    frame.number = number;
    if (finished) {
      frame.statistics = statistics_of(*finished, name_of(this->settings().integrator.kind));
      frame.image = std::move(finished->image);
      frame.uncertainty = std::move(finished->doubts);
      split_ = std::move(finished->split);
      cost_ = std::move(finished->cost);
    }
    if (deep) {
      frame.deep = std::move(*deep);
      frame.statistics.mesh.deep_samples = frame.deep.samples.size();
    }
    sink.frame(std::move(frame));
    return true;
  }

  /// What rank 0 says, on all.
  bool agreed(bool mine) {
    if (transport_->size() == 1) return mine;
    return exchange::broadcast(*transport_, 0, {std::byte{mine}})[0] != std::byte{0};
  }

  std::shared_ptr<exchange::Transport> transport_;
  scene::Trace* trace_;
  const bool keeps_cost_;
  volume::ImageSplit split_;
  volume::CostMap cost_;
  const std::uint64_t resident_ = frame::resident_bytes();
  std::optional<volume::Renderer> renderer_;
  bool keeps_uncertainty_ = false;
  std::optional<frame::SortFirst> sort_first_;
};

Verification public_form(const reference::Verification& v) {
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
  result.met = v.met();
  return result;
}

}  // namespace

namespace {

std::unique_ptr<Session::State> make_state(Dataset dataset, const Settings& settings,
                                           std::shared_ptr<exchange::Transport> transport,
                                           const frame::SessionExtras& extras) {
  if (dataset.is_grid())
    return std::make_unique<GridByRays>(std::move(dataset), settings, std::move(transport), extras);
  if (transport->size() == 1 && extras.compositing_on.backends.empty())
    return std::make_unique<MeshAlone>(std::move(dataset), settings, extras);
  return std::make_unique<MeshOnRanks>(std::move(dataset), settings, std::move(transport), extras);
}

}  // namespace

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::Session(Dataset dataset, const Settings& settings, const Communicator& communicator)
    : Session(make_state(std::move(dataset), settings, communicator.state().connect(), {})) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

RenderedFrame Session::render(const View& view, const TransferFunction& transfer_function,
                              const FrameSettings& settings, Sink* sink, std::stop_token stop) {
  OneFrame one(sink);
  render(std::span(&view, 1), transfer_function, settings, one, std::move(stop));
  return one.take();
}

std::size_t Session::render(std::span<const View> views, const TransferFunction& transfer_function,
                            const FrameSettings& settings, Sink& sink, std::stop_token stop) {
  if (transfer_function.knots().empty())
    throw scene::bad_input("transfer function: it has no knots; give at least one, or load a preset");
  for (const View& view : views) check_view(view);
  return state_->render(views, transfer_function, settings, sink, stop);
}

bool Session::assembles() const { return state_->assembles(); }

std::optional<double> Session::promised_error() const {
  return dataset().is_grid() ? frame::promised_error(frame::grid_settings(settings()))
                             : frame::promised_error(state_->mesh_settings());
}

Verification Session::verify(const RenderedFrame& frame, const View& view, const TransferFunction& transfer_function,
                             std::size_t count) const {
  check_view(view);
  if (frame.image.size != view.size)
    throw scene::bad_input("verify: the frame is not of this view's size; give the view it was rendered with");
  const Dataset::State& data = dataset().state();
  if (dataset().is_grid())
    return public_form(frame::verify(frame.image, *data.samples, view.camera, transfer_function,
                                     frame::grid_settings(settings()), frame.uncertainty, count));
  const frame::RenderSettings settings = state_->mesh_settings();
  if (data.ranks == 1)
    return public_form(frame::verify(frame.image, data.mesh, view.camera, transfer_function, settings, count));
  if (data.files.empty())
    throw scene::bad_input("verify: this rank has a part of the mesh, and no file has the whole; verify on one rank");
  const io::MeshFile whole = frame::read_input(data.files, frame::mesh_options(data.options));
  return public_form(frame::verify(frame.image, whole.mesh, view.camera, transfer_function, settings, count));
}

const Dataset& Session::dataset() const { return state_->dataset(); }
const Settings& Session::settings() const { return state_->settings(); }

namespace frame {

Session make_session(Dataset dataset, const Settings& settings, exchange::Transport& transport,
                     const SessionExtras& extras) {
  return Session(make_state(std::move(dataset), settings, {std::shared_ptr<void>(), &transport}, extras));
}

GridBalance balance_of(const Session& session, const TransferFunction& function) {
  return dynamic_cast<const GridByRays&>(session.state()).balance(function);
}

}  // namespace frame

}  // namespace tessera
