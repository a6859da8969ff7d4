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

/// Answers to requests, other than the frames of clients (docs/SERVER.md).
namespace tessera::server {

/// Progress of the film or image that is being made; may be used from all threads.
class LongProgress {
 public:
  void set(std::optional<double> fraction);
  [[nodiscard]] std::optional<double> get() const;

 private:
  mutable std::mutex mutex_;
  std::optional<double> fraction_;
};

/// Context of answers. `stage` and `reader` belong to the rendering thread.
struct ApiContext {
  SceneReader& reader;
  Stage& stage;
  int threads;
  LongProgress &film, &picture;
  Precedence& precedence;
};

/// The result of a turn: the answer, or none yet.
struct ApiResult {
  std::optional<Response> response{};
  bool waits_for_data = false;
  bool is_long = false;  ///< the rest takes long, and needs nothing from the rendering thread if there is one rank
};

/// A request that is answered in turns on the rendering thread; long work may continue on another thread after the turn
/// that sets is_long.
class ApiWork {
 public:
  virtual ~ApiWork() = default;
  ApiWork() = default;
  ApiWork(const ApiWork&) = delete;
  ApiWork& operator=(const ApiWork&) = delete;
  /// Does not throw errors of the request; on several ranks throws errors that end the run.
  virtual ApiResult turn() = 0;
};
std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, std::stop_token stop);

/// Answers, from any thread, that need neither data nor waiting: progress, unknown paths and methods.
std::optional<Response> answer_at_once(const Request& request, const ApiContext& context);

// The answers, each for a body, once the data are available.

/// A scene with its data.
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
/// Whether colours depend on the logarithm: as in the state, otherwise as the server was started.
bool is_logarithmic(const ApiContext& context, const OpenScene& open);

// Long work.

std::unique_ptr<ApiWork> make_picture_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                           std::stop_token stop);
std::unique_ptr<ApiWork> make_verify_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                          std::stop_token stop);
std::unique_ptr<ApiWork> make_check_work(const OpenScene& open);

/// The film requested by a body (api_film.cpp). Throws Error(bad_input).
struct FilmPlan {
  explicit FilmPlan(const Json& body);
  /// The camera of frame `number`; `first` is the scene's.
  [[nodiscard]] Camera camera(std::int64_t number, const Camera& first) const;

  std::string format = "mp4";
  double rate = 25;
  std::vector<Camera> views;  ///< empty: an orbit
  std::int64_t frames = 0;
};
std::unique_ptr<ApiWork> make_film_work(const ApiContext& context, const OpenScene& open, FilmPlan plan,
                                        std::stop_token stop);

/// The films that this server can make: "formats", and the "problem" with missing ones, or null.
Json films_json();

Response json_response(const Json& json);
/// The answer for work that was stopped.
Response stopped_response();

/// The answer for an exception: 400 for errors of the request. Rethrows it if it ends the run.
Response response_to(const std::exception_ptr& thrown, const ApiContext& context);

/// A camera in the form of camera files.
Json json_of(const Camera& camera);

}  // namespace tessera::server
