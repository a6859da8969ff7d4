// SPDX-License-Identifier: BSD-3-Clause
#include "server/renderer.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "server/api.hpp"
#include "server/finished_picture.hpp"
#include "server/frame_message.hpp"
#include "tessera/error.hpp"
#include "tessera/version.hpp"

namespace tessera::server {
namespace {

constexpr int protocol_version = 1;

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

std::string reading_text(const Reading& reading) {
  Json text = {{"type", "reading"}, {"stage", reading.stage}, {"fraction", nullptr}};
  if (reading.fraction) text["fraction"] = *reading.fraction;
  return text_of(text);
}

/// Receives a frame's tiles: reports the progress of long frames to the client, and stops a frame that a newer state
/// should not wait for.
class FrameProgress final : public Sink {
 public:
  FrameProgress(const FrameOrder& order, WorkQueue& queue, ImageSize size)
      : order_(order), queue_(queue), pixels_(1.0 * size.width * size.height) {}

  void tile(const Tile& tile) override {
    done_ += tile.rect.area();
    const auto now = Clock::now();
    if (order_.level == Level::moving && queue_.overdue(order_)) {
      std::stop_source stop = order_.stop;
      stop.request_stop();
    }
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(500);
    order_.channel->send_text(text_of({{"type", "progress"},
                                       {"number", order_.number},
                                       {"level", level_name(order_.level)},
                                       {"fraction", std::min(1.0, done_ / pixels_)}}));
  }

 private:
  const FrameOrder& order_;
  WorkQueue& queue_;
  double pixels_, done_ = 0;
  Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
};

/// The work for a request until the request is answered.
class ApiTask final : public Task, public std::enable_shared_from_this<ApiTask> {
 public:
  /// `long_queue` is the queue for long work; if it is null, long work remains on the same queue.
  ApiTask(Request request, const std::stop_token& gone, Service::Reply reply, const ApiContext& context,
          WorkQueue* long_queue)
      : work_(make_api_work(std::move(request), context, stop_.get_token())),
        reply_(std::move(reply)),
        long_queue_(long_queue),
        on_gone_(gone, [this] { stop(); }) {}

  Turn turn() override {
    if (stop_.stop_requested()) return answer(stopped_response());
    ApiResult result = work_->turn();
    if (result.response) return answer(*result.response);
    if (result.is_long && long_queue_ != nullptr) {
      std::exchange(long_queue_, nullptr)->add(shared_from_this());  // the task may have its turn at once
      return Turn::done;
    }
    return result.waits_for_data ? Turn::waits_for_data : Turn::again;
  }
  void abandon() override {
    if (reply_) answer(error_response(503, "The server is ending or overloaded."));
  }
  void stop() override { stop_.request_stop(); }

 private:
  Turn answer(const Response& response) {
    std::exchange(reply_, nullptr)(response);
    return Turn::done;
  }

  std::stop_source stop_;
  std::unique_ptr<ApiWork> work_;
  Service::Reply reply_;
  WorkQueue* long_queue_;
  std::stop_callback<std::function<void()>> on_gone_;
};

/// A thread that does long work until the queue ends.
class LongThread {
 public:
  explicit LongThread(WorkQueue& queue)
      : queue_(queue),
        more_workers_(tbb::global_control::max_allowed_parallelism,
                      2 * static_cast<std::size_t>(tbb::info::default_concurrency())),
        thread_([&queue] {
          while (auto work = queue.next()) {
            auto& task = std::get<std::shared_ptr<Task>>(*work);
            const Task::Turn turn = task->turn();
            queue.finish(std::move(task), turn);
          }
        }) {}
  ~LongThread() {
    queue_.end();
    thread_.join();
  }
  LongThread(const LongThread&) = delete;
  LongThread& operator=(const LongThread&) = delete;

 private:
  WorkQueue& queue_;
  // Workers that wait in Precedence::pass() do nothing else, so the same number of additional workers exists for views.
  tbb::global_control more_workers_;
  std::thread thread_;
};

}  // namespace

Response error_response(int status, const std::string& sentence) {
  return {status, "application/json", std::make_shared<const std::string>(text_of({{"error", sentence}}))};
}

Renderer::Renderer(SceneReader& reader, Job& job, const RendererSettings& settings)
    : reader_(reader),
      settings_(settings),
      queue_(settings.latency_ms),
      long_queue_(settings.latency_ms),
      stage_(
          reader, job, settings.memory_bytes, [this] { data_arrived(); },
          [this](const Reading& reading) { report_reading(reading); }) {}

Renderer::~Renderer() = default;

void Renderer::data_arrived() {
  if (!first_arrived_.exchange(true)) queue_.send_to_all(R"({"type":"data"})");
  queue_.send_to_waiting(R"({"type":"data"})");
  queue_.wake();
}

void Renderer::report_reading(const Reading& reading) {
  const auto now = Clock::now();
  if (ms_between(reading_reported_, now) < 200) return;
  reading_reported_ = now;
  first_arrived_ ? queue_.send_to_waiting(reading_text(reading)) : queue_.send_to_all(reading_text(reading));
}

void Renderer::answer(Request request, std::stop_token gone, Reply reply) {
  const ApiContext context{reader_, stage_, settings_.threads, film_, picture_, precedence_};
  if (auto response = answer_at_once(request, context)) return reply(std::move(*response));
  // The other ranks follow a single thread of the first rank.
  WorkQueue* const long_queue = stage_.ranks() == 1 ? &long_queue_ : nullptr;
  queue_.add(std::make_shared<ApiTask>(std::move(request), gone, std::move(reply), context, long_queue));
}

ClientId Renderer::join(std::shared_ptr<Channel> channel) {
  channel->send_text(text_of({{"type", "welcome"},
                              {"version", protocol_version},
                              {"tessera", version()},
                              {"latency", settings_.latency_ms},
                              {"base", reader_.base()},
                              {"ready", first_arrived_.load()}}));
  if (const auto reading = stage_.reading()) channel->send_text(reading_text(*reading));
  return queue_.join(channel);
}

void Renderer::message(ClientId client, const std::string& text) {
  try {
    Message message = parse_message(text);
    if (auto* state = std::get_if<StateMessage>(&message)) return queue_.set_state(client, std::move(*state));
    if (const auto* ack = std::get_if<AckMessage>(&message)) return queue_.acknowledge(client, ack->frame);
    queue_.pause(client);
  } catch (...) {
    queue_.send(client, text_of({{"type", "error"}, {"error", error_of(std::current_exception()).what()}}));
  }
}

void Renderer::leave(ClientId client) { queue_.leave(client); }

void Renderer::read_first() {
  try {
    const Json base = reader_.base();
    stage_.data(base, reader_.scene(base));
  } catch (const Error&) {  // the error is reported to the first client that requests the data
    first_arrived_ = true;
  }
}

void Renderer::run() {
  std::optional<LongThread> long_thread;
  if (stage_.ranks() == 1) long_thread.emplace(long_queue_);
  read_first();
  while (auto work = queue_.next()) {
    if (long_thread) precedence_.begin_short(Clock::now());
    if (auto* order = std::get_if<FrameOrder>(&*work)) {
      queue_.finish(*order, render(*order));
    } else {
      auto& task = std::get<std::shared_ptr<Task>>(*work);
      const Task::Turn turn = task->turn();
      queue_.finish(std::move(task), turn);
    }
    if (long_thread) precedence_.end_short(Clock::now());
  }
  long_thread.reset();
  stage_.end();
}

void Renderer::end() {
  queue_.end();
  long_queue_.end();
}

void Renderer::announce_end(const std::string& reason) {
  queue_.send_to_all(text_of({{"type", "ended"}, {"error", reason}}));
}

FrameOutcome Renderer::render(const FrameOrder& order) {
  FrameOutcome outcome;
  try {
    return make_frame(order);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    if (stage_.ranks() > 1 && error.code() != ErrorCode::bad_input) throw;  // these errors end the run
    order.channel->send_text(
        text_of({{"type", "error"}, {"number", order.number}, {"error", reader_.worded(error.what())}}));
  }
  return outcome;
}

FrameOutcome Renderer::make_frame(const FrameOrder& order) {
  FrameOutcome outcome;
  outcome.level = order.level;
  const Json exact = order.level == Level::moving ? Json() : reader_.exact(order.state);
  if (order.level == Level::automatic && exact == order.state) outcome.level = Level::exact;
  const Json& state = outcome.level == Level::exact ? exact : order.state;
  const auto scene = reader_.scene(state);
  const auto held = stage_.data(state, scene);
  if (!held) {
    if (const auto reading = stage_.reading()) order.channel->send_text(reading_text(*reading));
    outcome.kind = FrameOutcome::Kind::waits_for_data;
    return outcome;
  }
  View view = scene->view(held->data);
  if (order.level == Level::moving) view.size = shrunk(view.size, shrinks.at(order.shrink));
  const LoadedTransferFunction& loaded = stage_.function(*held, *scene);
  FrameProgress progress(order, queue_, view.size);
  const bool preview = order.level == Level::moving && order.preview && stage_.has_preview(state, held);
  RenderedFrame rendered = preview ? stage_.render_preview(*scene, *held, view, &progress, order.stop.get_token())
                                   : stage_.render(state, *scene, *held, view, {}, &progress, order.stop.get_token());
  if (rendered.stopped || order.stop.stop_requested()) {
    outcome.kind = FrameOutcome::Kind::stopped;
    return outcome;
  }
  const auto rendered_at = Clock::now();
  const PictureFormat format = order.level == Level::moving ? PictureFormat::jpeg : PictureFormat::png;
  // The page enlarges smaller images and would also enlarge the annotation, whose text has a minimum size.
  const SharedBytes bytes = order.level == Level::moving ? bare_picture(rendered.image, format, *scene)
                                                         : finished_picture(std::move(rendered.image), format, *scene,
                                                                            view, held->data, loaded.function);
  const auto range = held->data.range();
  Json header = {
      {"type", "frame"},
      {"frame", ++frames_},
      {"number", order.number},
      {"level", level_name(outcome.level)},
      {"preview", preview},
      {"width", view.size.width},
      {"height", view.size.height},
      {"mime", media_type(format)},
      {"milliseconds", rendered.statistics.milliseconds},
      {"encode_ms", ms_between(rendered_at, Clock::now())},
      {"promised_error", nullptr},
      {"final", outcome.level == Level::exact},
      {"stages", preview ? std::map<std::string, double>{} : stage_.stage_times(rendered.statistics.milliseconds)},
      {"field", held->data.field_name()},
      {"range", range},
      {"warnings", loaded.warnings}};
  if (const auto promised = preview ? std::nullopt : stage_.session(state, *scene, *held).promised_error())
    header["promised_error"] = *promised;
  queue_.begin_sending(order, frames_);
  order.channel->send_frame(frame_head(header), bytes);
  outcome.kind = FrameOutcome::Kind::sent;
  outcome.render_ms = rendered.statistics.milliseconds;
  return outcome;
}

}  // namespace tessera::server
