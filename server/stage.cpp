// SPDX-License-Identifier: BSD-3-Clause
#include "server/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/stage_times.hpp"
#include "tessera/coarse_preview.hpp"

namespace tessera::server {
namespace {

constexpr std::size_t most_data_sets = 8, most_sessions = 3, most_functions = 16;

std::uint64_t bytes_of(const Dataset& data) {
  if (data.is_grid()) {
    const GridIndex samples = data.grid_geometry().samples();
    return 8 * static_cast<std::uint64_t>(samples[0] * samples[1] * samples[2]);  // an upper bound, since mapped files
                                                                                  // need no memory
  }
  const MeshArrays arrays = data.mesh_arrays();
  return 8 * std::uint64_t{arrays.points.size() + arrays.scalars.size()} + 20 * data.tet_count();
}

const char* stage_words(ReadProgress::Stage stage) {
  switch (stage) {
    case ReadProgress::Stage::copying:
      return "copying";
    case ReadProgress::Stage::filling:
      return "filling";
    default:
      return "reading";
  }
}

/// Renders frames in a separate session.
class OwnFrames final : public SceneFrames {
 public:
  OwnFrames(std::shared_ptr<HeldData> held, Settings settings, LoadedTransferFunction function)
      : SceneFrames(std::move(function)), held_(std::move(held)), settings_(std::move(settings)) {}
  RenderedFrame render(const View& view, const FrameSettings& settings, Sink* sink,
                       const std::stop_token& stop) override {
    return session().render(view, function().function, settings, sink, stop);
  }
  Session& session() override {
    if (!session_) session_.emplace(held_->data, settings_);
    return *session_;
  }

 private:
  std::shared_ptr<HeldData> held_;
  Settings settings_;
  std::optional<Session> session_;
};

/// Renders frames by the stage, together with the other ranks.
class StageFrames final : public SceneFrames {
 public:
  StageFrames(Stage& stage, Json state, std::shared_ptr<const Scene> scene, LoadedTransferFunction function)
      : SceneFrames(std::move(function)), stage_(stage), state_(std::move(state)), scene_(std::move(scene)) {}
  RenderedFrame render(const View& view, const FrameSettings& settings, Sink* sink,
                       const std::stop_token& stop) override {
    held_ = stage_.data(state_, scene_);  // the other ranks may have dropped the data since the last frame
    return stage_.render(state_, *scene_, *held_, view, settings, sink, stop);
  }
  Session& session() override { return stage_.session(state_, *scene_, *held_); }

 private:
  Stage& stage_;
  Json state_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<HeldData> held_;
};

}  // namespace

Stage::Stage(SceneReader& reader, Job& job, std::uint64_t memory_bytes, std::function<void()> came,
             std::function<void(const Reading&)> progress)
    : reader_(reader), job_(job), memory_bytes_(memory_bytes), came_(std::move(came)), progress_(std::move(progress)) {}

Stage::~Stage() {
  stop_making_.request_stop();
  if (making_thread_.joinable()) making_thread_.join();
  if (reading_thread_.joinable()) reading_thread_.join();
}

std::shared_ptr<HeldData> Stage::find(const Scene& scene) {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (std::ranges::find_first_of(entry->keys, scene.data_keys()) == entry->keys.end()) continue;
    entries_.splice(entries_.begin(), entries_, entry);
    return entry->held;
  }
  return nullptr;
}

void Stage::keep(const Scene& scene, Dataset data) {
  Entry entry;
  entry.keys = scene.keys_of(data);
  const std::uint64_t bytes = bytes_of(data);
  entry.held = std::make_shared<HeldData>(std::move(data));
  entry.held->bytes = bytes;
  entries_.push_front(std::move(entry));
  if (job_.rank() != 0) return;  // the first rank decides which data are dropped
  std::uint64_t sum = 0;
  std::size_t count = 0;
  for (auto at = entries_.begin(); at != entries_.end();) {
    sum += at->held->bytes;
    if (++count == 1 || (count <= most_data_sets && sum <= memory_bytes_)) {
      ++at;
      continue;
    }
    const std::string key = at->keys.front();
    ++at;
    send_order({{"do", "drop"}, {"key", key}});
    drop(key);
  }
}

void Stage::drop(const std::string& key) {
  const auto gone = std::ranges::find_if(entries_, [&](const Entry& entry) { return entry.keys.front() == key; });
  if (gone == entries_.end()) return;
  std::erase_if(sessions_,
                [&](const KeptSession& kept) { return kept.session->dataset().is_copy_of(gone->held->data); });
  entries_.erase(gone);
}

std::shared_ptr<HeldData> Stage::data(const Json& state, const std::shared_ptr<const Scene>& scene) {
  std::optional<Arrived> arrived;
  {
    const std::lock_guard lock(mutex_);
    if (!reading_) arrived.swap(arrived_);
  }
  if (arrived) {
    reading_thread_.join();
    if (arrived->data)
      keep(*arrived->scene, std::move(*arrived->data));
    else
      failed_.insert_or_assign(arrived->scene->data_keys().front(), *arrived->error);
  }
  if (auto held = find(*scene)) return held;
  if (const auto failed = failed_.find(scene->data_keys().front()); failed != failed_.end()) {
    const Error error = failed->second;
    failed_.erase(failed);  // the file may have been corrected when it is requested again
    throw error;
  }
  if (ranks() > 1) {
    read_together(state, *scene);
    return find(*scene);
  }
  if (!reading()) read_in_background(scene);
  return nullptr;
}

void Stage::read_in_background(std::shared_ptr<const Scene> scene) {
  {
    const std::lock_guard lock(mutex_);
    reading_ = Reading{"reading " + reader_.input_name(), std::nullopt};
  }
  progress_(*reading());
  reading_thread_ = std::thread([this, scene = std::move(scene)] {
    Arrived arrived{scene, std::nullopt, std::nullopt};
    const auto on_progress = [this](const ReadProgress& progress) {
      Reading now{std::string(stage_words(progress.stage)) + " " + reader_.input_name(), progress.done};
      if (progress.stage == ReadProgress::Stage::filling) now.fraction.reset();
      {
        const std::lock_guard lock(mutex_);
        reading_ = now;
      }
      progress_(now);
    };
    try {
      arrived.data = scene->open(Communicator(), on_progress);
    } catch (...) {
      arrived.error = error_of(std::current_exception());
    }
    {
      const std::lock_guard lock(mutex_);
      arrived_ = std::move(arrived);
      reading_.reset();
    }
    came_();
  });
}

Dataset Stage::open_together(const Scene& scene) {
  std::optional<Dataset> data;
  job_.attempt([&](const Communicator& ranks) { data = scene.open(ranks, {}); });
  return std::move(*data);
}

void Stage::read_together(const Json& state, const Scene& scene) {
  {
    const std::lock_guard lock(mutex_);
    reading_ = Reading{"reading " + reader_.input_name(), std::nullopt};
  }
  progress_(*reading());
  const auto end = [this] {
    const std::lock_guard lock(mutex_);
    reading_.reset();
  };
  try {
    send_order({{"do", "open"}, {"state", state}});
    keep(scene, open_together(scene));
  } catch (...) {
    end();
    throw;
  }
  end();
  came_();
}

std::optional<Reading> Stage::reading() {
  const std::lock_guard lock(mutex_);
  return reading_;
}

const LoadedTransferFunction& Stage::function(HeldData& held, const Scene& scene) {
  const auto found = held.functions.find(scene.look_key());
  if (found != held.functions.end()) return found->second;
  LoadedTransferFunction function = scene.function(held.data);
  if (held.functions.size() >= most_functions) held.functions.clear();
  return held.functions.emplace(scene.look_key(), std::move(function)).first->second;
}

RenderedFrame Stage::render_preview(const Scene& scene, HeldData& held, const View& view, Sink* sink,
                                    const std::stop_token& stop) {
  const LoadedTransferFunction& loaded = function(held, scene);
  const std::string key = scene.settings_key() + " preview";
  if (held.preview_key != key || !held.preview_session) {
    Settings settings = scene.settings(held.data, loaded);
    settings.surfaces.boundary.clear();
    settings.surfaces.triangles.clear();
    settings.integrator = {};
    settings.integrator.accuracy = 1e-2;
    // Sampling takes a third of the time, but does not support surfaces and shading.
    if (settings.surfaces.iso.empty() && !settings.grid.shading && !settings.mesh.shading) {
      settings.integrator.kind = IntegratorKind::sampled;
      settings.grid.step = 2;
    }
    if (settings.mesh.shading) settings.grid.shading = settings.mesh.shading;
    settings.mesh = {};
    held.preview_session.reset();
    held.preview_session = std::make_unique<Session>(*held.preview, settings);
    held.preview_key = key;
  }
  return held.preview_session->render(view, loaded.function, {}, sink, stop);
}

void Stage::make_preview_together(const Json& state, HeldData& held) {
  held.preview_tried = true;
  const bool is_first = job_.rank() == 0;
  if (held.data.is_grid() && !is_first) return;  // every rank has all samples of a grid
  send_order({{"do", "preview"}, {"state", state}});
  try {
    std::optional<Dataset> made = coarse_preview(held.data, {}, {}, job_.communicator());
    if (is_first) held.preview = std::move(made);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input) throw;  // bad_input only means that there is no preview
  }
}

bool Stage::has_preview(const Json& state, const std::shared_ptr<HeldData>& held) {
  if (held->preview) return true;
  if (ranks() > 1) {
    if (!held->preview_tried) make_preview_together(state, *held);
    return held->preview.has_value();
  }
  {
    const std::lock_guard lock(mutex_);
    if (making_ != nullptr) return false;
    if (made_) {
      made_->held->preview = std::move(made_->data);
      made_.reset();
      if (held->preview) return true;
    }
    if (held->preview_tried) return false;
    making_ = held.get();
  }
  held->preview_tried = true;
  if (making_thread_.joinable()) making_thread_.join();  // the previous thread, which has finished
  making_thread_ = std::thread([this, held, stop = stop_making_.get_token()] {
    std::optional<Dataset> data;
    try {
      data = coarse_preview(held->data, {}, stop);
    } catch (...) {  // after an exception there is no preview
      data.reset();
    }
    const std::lock_guard lock(mutex_);
    making_ = nullptr;
    made_ = Made{held, std::move(data)};
  });
  return false;
}

Settings Stage::session_settings(const Scene& scene, HeldData& held) {
  Settings settings = scene.settings(held.data, function(held, scene));
  // A single process has one additional session, for long work.
  const std::size_t most = ranks() > 1 ? 1 : most_sessions + 1;
  if (held.data.is_grid()) settings.memory_bytes = std::max(settings.memory_bytes / most, std::uint64_t{1} << 20);
  return settings;
}

std::unique_ptr<SceneFrames> Stage::frames(const Json& state, const std::shared_ptr<const Scene>& scene,
                                           const std::shared_ptr<HeldData>& held, ImageSize size) {
  check_size(size);
  const LoadedTransferFunction& loaded = function(*held, *scene);
  if (ranks() > 1) return std::make_unique<StageFrames>(*this, state, scene, loaded);
  return std::make_unique<OwnFrames>(held, session_settings(*scene, *held), loaded);
}

Session& Stage::session(const Json& /*state*/, const Scene& scene, HeldData& held) {
  const LoadedTransferFunction& loaded = function(held, scene);
  Settings settings = session_settings(scene, held);
  const std::string key = scene.settings_key() + (loaded.shaded ? " shaded" : "");
  for (auto kept = sessions_.begin(); kept != sessions_.end(); ++kept) {
    if (kept->key != key || !kept->session->dataset().is_copy_of(held.data)) continue;
    sessions_.splice(sessions_.begin(), sessions_, kept);
    return *sessions_.front().session;
  }
  // Sessions of several ranks share the job's messages, so only one session exists at a time.
  const std::size_t most = ranks() > 1 ? 1 : most_sessions;
  while (sessions_.size() >= most) sessions_.pop_back();
  auto trace = std::make_unique<Trace>();
  settings.trace = trace.get();
  auto session = std::make_unique<Session>(held.data, settings, job_.communicator());
  sessions_.push_front({key, std::move(trace), std::move(session)});
  return *sessions_.front().session;
}

std::map<std::string, double> Stage::stage_times(double frame_ms) {
  if (sessions_.empty()) return {};
  return tessera::server::stage_times(sessions_.front().trace->take_spans(), frame_ms);
}

void Stage::check_size(ImageSize size) const {
  constexpr int longest_side = 16384;
  constexpr std::uint64_t bytes_of_pixel = 24;  // bytes for a rendered and encoded pixel
  if (size.width > longest_side || size.height > longest_side)
    throw bad_input(fmt::format(
        "--size: {}x{} has more than {} pixels per side; request a smaller image, or render it from the command line",
        size.width, size.height, longest_side));
  const auto width = static_cast<std::uint64_t>(size.width), height = static_cast<std::uint64_t>(size.height);
  if (width * height * bytes_of_pixel > memory_bytes_)
    throw bad_input(
        fmt::format("--size: {}x{} takes more memory than the server has for images; request a smaller image, or start "
                    "the server with a larger --memory",
                    size.width, size.height));
}

RenderedFrame Stage::render(const Json& state, const Scene& scene, HeldData& held, const View& view,
                            const FrameSettings& settings, Sink* sink, const std::stop_token& stop) {
  check_size(view.size);
  if (ranks() > 1)
    send_order({{"do", "render"},
                {"state", state},
                {"width", view.size.width},
                {"height", view.size.height},
                {"uncertainty", settings.keep_uncertainty}});
  try {
    Session& used = session(state, scene, held);
    static_cast<void>(sessions_.front().trace->take_spans());  // removes the spans of frames whose times were not
                                                               // requested
    return used.render(view, function(held, scene).function, settings, sink, stop);
  } catch (...) {
    if (ranks() > 1) sessions_.clear();  // sessions may be unusable after an error
    throw;
  }
}

RayProbe Stage::probe(const Json& state, const Scene& scene, HeldData& held, const View& view, PixelIndex pixel,
                      std::size_t samples) {
  send_order({{"do", "probe"}, {"state", state}, {"x", pixel.x}, {"y", pixel.y}, {"samples", samples}});
  const LoadedTransferFunction& loaded = function(held, scene);
  return tessera::probe(held.data, view, loaded.function, pixel, samples, scene.settings(held.data, loaded),
                        job_.communicator());
}

void Stage::send_order(const Json& order) {
  if (ranks() == 1 || job_.rank() != 0) return;
  const std::string text = order.dump();
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  job_.broadcast(0, std::move(bytes));
}

void Stage::end() {
  send_order({{"do", "end"}});
  synchronize_ranks();
}

void Stage::synchronize_ranks() {
  for (int rank = 1; rank < ranks(); ++rank) job_.broadcast(rank, {});
}

void Stage::execute(const Json& order) {
  if (order.at("do") == "drop") return drop(order.at("key").get<std::string>());
  const Json& state = order.at("state");
  const auto scene = reader_.scene(state);
  if (order.at("do") == "open") {
    keep(*scene, open_together(*scene));
    return;
  }
  const auto held = find(*scene);
  if (!held)
    throw Error(ErrorCode::system_failure, "server", "this rank has different data from the first rank", "report this");
  if (order.at("do") == "preview") return make_preview_together(state, *held);
  View view = scene->view(held->data);
  if (order.at("do") == "probe") {
    probe(state, *scene, *held, view, {order.at("x").get<int>(), order.at("y").get<int>()},
          order.at("samples").get<std::size_t>());
    return;
  }
  view.size = {order.at("width").get<int>(), order.at("height").get<int>()};
  FrameSettings settings;
  settings.keep_uncertainty = order.at("uncertainty").get<bool>();
  render(state, *scene, *held, view, settings, nullptr, {});
}

void Stage::follow() {
  while (true) {
    const std::vector<std::byte> bytes = job_.broadcast(0, {});
    std::string text(bytes.size(), '\0');
    std::memcpy(text.data(), bytes.data(), bytes.size());
    const Json order = Json::parse(text);
    if (order.at("do") == "end") return synchronize_ranks();
    try {
      execute(order);
    } catch (const Error& error) {
      // All ranks receive the same errors if data cannot be opened or the input is wrong. The first rank reports these
      // errors to its client.
      if (error.code() != ErrorCode::bad_input && order.at("do") != "open") throw;
    }
  }
}

}  // namespace tessera::server
