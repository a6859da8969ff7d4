// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "server/precedence.hpp"
#include "server/scene_reader.hpp"
#include "server/service.hpp"
#include "server/stage.hpp"

/// What requests are answered with, beside the frames of clients (docs/SERVER.md).
namespace tessera::server {

/// How far the film, or the picture, is that is being made; of all threads.
class LongProgress {
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
  LongProgress &film, &picture;
  Precedence& precedence;
};

/// A turn's result: the answer, or none yet.
struct ApiResult {
  std::optional<Response> response{};
  bool waits_for_data = false;
  bool is_long = false;  ///< what is left takes long, and needs nothing of the rendering thread if there is one rank
};

/// A request that is being answered, in turns, on the thread that renders; long ones perhaps on another one from the
/// turn on that said so.
class ApiWork {
 public:
  virtual ~ApiWork() = default;
  ApiWork() = default;
  ApiWork(const ApiWork&) = delete;
  ApiWork& operator=(const ApiWork&) = delete;
  /// Does not throw what a request is to blame for; on several ranks what ends the run.
  virtual ApiResult turn() = 0;
};
std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, std::stop_token stop);

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
/// Whether colors go by the logarithm: as the state has it, else as the server was started.
bool is_logarithmic(const ApiContext& context, const OpenScene& open);

// Work that takes long.

std::unique_ptr<ApiWork> make_picture_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                           std::stop_token stop);
std::unique_ptr<ApiWork> make_verify_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                          std::stop_token stop);
std::unique_ptr<ApiWork> make_check_work(const OpenScene& open);

/// What a body asks for of a film (api_film.cpp). Throws Error(bad_input).
struct FilmPlan {
  explicit FilmPlan(const Json& body);
  /// Of frame `number`; `first` is the scene's.
  [[nodiscard]] Camera camera(std::int64_t number, const Camera& first) const;

  std::string format = "mp4";
  double rate = 25;
  std::vector<Camera> views;  ///< empty: an orbit
  std::int64_t frames = 0;
};
std::unique_ptr<ApiWork> make_film_work(const ApiContext& context, const OpenScene& open, FilmPlan plan,
                                        std::stop_token stop);

/// What films can be made here: "formats", and the "problem" with those that are left out, or null.
Json films_json();

Response json_response(const Json& json);
/// Of work that was asked to stop.
Response stopped_response();

/// What an exception is to who asked: 400 for what the request is to blame for. Throws it again if it ends the run.
Response response_to(const std::exception_ptr& thrown, const ApiContext& context);

/// A camera as camera files have it.
Json json_of(const Camera& camera);

}  // namespace tessera::server
