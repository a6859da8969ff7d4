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

/// Answers to requests, except for the frames of clients (docs/SERVER.md).
namespace tessera::server {

/// Progress of the film or image that is being made. May be used from any thread.
class LongProgress {
 public:
  void set(std::optional<double> fraction);
  [[nodiscard]] std::optional<double> get() const;

 private:
  mutable std::mutex mutex_;
  std::optional<double> fraction_;
};

/// Context of answers. Only the rendering thread may use `stage` and `reader`.
struct ApiContext {
  SceneReader& reader;
  Stage& stage;
  int threads;
  LongProgress &film, &picture;
  Precedence& precedence;
};

/// The result of a turn: the answer, or none if the work is not finished.
struct ApiResult {
  std::optional<Response> response{};
  bool waits_for_data = false;
  bool is_long = false;  ///< the remaining work takes long; with one rank it does not need the rendering thread
};

/// A request that is answered in turns on the rendering thread. After a turn that sets is_long, the work may continue
/// on another thread.
class ApiWork {
 public:
  virtual ~ApiWork() = default;
  ApiWork() = default;
  ApiWork(const ApiWork&) = delete;
  ApiWork& operator=(const ApiWork&) = delete;
  /// Does one turn. Errors of the request are not thrown, but part of the answer. On several ranks, errors that end the
  /// run are thrown.
  virtual ApiResult turn() = 0;
};
std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, std::stop_token stop);

/// Returns an answer if the request needs neither data nor waiting: progress, unknown paths and methods. May be called
/// from any thread.
std::optional<Response> answer_at_once(const Request& request, const ApiContext& context);

// The answers to requests with these bodies, for which the data must be available.

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
/// Whether colours depend on the logarithm of the value, as specified by the state or, if it does not, when the server
/// was started.
bool is_logarithmic(const ApiContext& context, const OpenScene& open);

// Work that takes long.

std::unique_ptr<ApiWork> make_picture_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                           std::stop_token stop);
std::unique_ptr<ApiWork> make_verify_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                          std::stop_token stop);
std::unique_ptr<ApiWork> make_check_work(const OpenScene& open);

/// The film requested by a body (api_film.cpp). Throws Error(bad_input).
struct FilmPlan {
  explicit FilmPlan(const Json& body);
  /// The camera of frame `number`. `first` is the camera of the scene.
  [[nodiscard]] Camera camera(std::int64_t number, const Camera& first) const;

  std::string format = "mp4";
  double rate = 25;
  std::vector<Camera> views;  ///< empty: an orbit
  std::int64_t frames = 0;
};
std::unique_ptr<ApiWork> make_film_work(const ApiContext& context, const OpenScene& open, FilmPlan plan,
                                        std::stop_token stop);

/// JSON with the "formats" of the films that this server can make, and the "problem" if some cannot be made, or null.
Json films_json();

Response json_response(const Json& json);
/// The answer to a request whose work was stopped.
Response stopped_response();

/// The answer for an exception: 400 for errors of the request. Rethrows an exception that ends the run.
Response response_to(const std::exception_ptr& thrown, const ApiContext& context);

/// A camera in the form of camera files.
Json json_of(const Camera& camera);

}  // namespace tessera::server
