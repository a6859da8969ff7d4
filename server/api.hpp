#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "server/scene_reader.hpp"
#include "server/service.hpp"
#include "server/stage.hpp"

/// What requests are answered with, beside the frames of clients (docs/SERVER.md).
namespace tessera::server {

/// How far the film is that is being made; of all threads.
class FilmProgress {
 public:
  void set(std::optional<double> fraction);
  [[nodiscard]] std::optional<double> get() const;

 private:
  mutable std::mutex mutex_;
  std::optional<double> fraction_;
};

/// What answers are made of. `stage` and `reader` are of the thread that renders.
struct ApiContext {
  SceneReader& reader;
  Stage& stage;
  int threads;
  FilmProgress& progress;
};

/// A turn's result: the answer, or none yet.
struct ApiResult {
  std::optional<Response> response;
  bool waits_for_data = false;
};

/// A request that is being answered, in turns, on the thread that renders.
class ApiWork {
 public:
  virtual ~ApiWork() = default;
  ApiWork() = default;
  ApiWork(const ApiWork&) = delete;
  ApiWork& operator=(const ApiWork&) = delete;
  /// Does not throw what a request is to blame for; on several ranks what ends the run.
  virtual ApiResult turn() = 0;
};
std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, const std::stop_token& gone);

/// From any thread: what needs no data, and no waiting: progress, unknown paths and methods.
std::optional<Response> answer_at_once(const Request& request, const ApiContext& context);

// The answers, each of a body, once the data is there.

/// A scene with its data at hand.
struct OpenScene {
  const Json& state;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<HeldData> held;
};
Json data_answer(const ApiContext& context, const OpenScene& open);
Json histogram_answer(const ApiContext& context, const OpenScene& open, const Json& body);
Json function_answer(const ApiContext& context, const OpenScene& open);
Json camera_answer(const OpenScene& open, const Json& body);
Json probe_answer(const ApiContext& context, const OpenScene& open, const Json& body);
Json verify_answer(const ApiContext& context, const OpenScene& open, const Json& body);
Json check_answer(const OpenScene& open);

/// What films can be made here: "formats", and the "problem" with those that are left out, or null.
Json films_json();
/// A film, by frames (api_film.cpp).
std::unique_ptr<ApiWork> make_film_work(Json body, const ApiContext& context, const std::stop_token& gone);

/// What an exception is to who asked: 400 for what the request is to blame for. Throws it again if it ends the run.
Response response_to(const std::exception_ptr& thrown, const ApiContext& context);

/// A camera as camera files have it.
Json json_of(const Camera& camera);

}  // namespace tessera::server
