// SPDX-License-Identifier: BSD-3-Clause
#include "server/api.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "server/access.hpp"
#include "server/frame_message.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"

namespace tessera::server {
namespace {

struct Route {
  std::string_view path;
  bool get, post;
};
constexpr std::array routes = {
    Route{"api/data", true, true},    Route{"api/histogram", false, true}, Route{"api/function", false, true},
    Route{"api/camera", false, true}, Route{"api/probe", false, true},     Route{"api/command", false, true},
    Route{"api/verify", false, true}, Route{"api/check", true, true},      Route{"api/progress", true, false},
    Route{"picture", true, true},     Route{"film", false, true}};

/// The body of a request; for GET, the body of the equivalent POST.
Json body_of(const Request& request) {
  if (request.method == "POST") return parse_body(request.body);
  Json body = Json::object();
  if (const auto state = query_value(request.query, "state")) body["state"] = parse_body(*state);
  if (const auto format = query_value(request.query, "format")) body["format"] = *format;
  return body;
}

class PlainWork final : public ApiWork {
 public:
  PlainWork(Request request, const ApiContext& context, std::stop_token stop)
      : request_(std::move(request)), context_(context), stop_(std::move(stop)) {}

  ApiResult turn() override {
    try {
      return long_ ? long_->turn() : answer();
    } catch (...) {
      return {response_to(std::current_exception(), context_)};
    }
  }

 private:
  ApiResult answer() {
    if (!body_) body_ = body_of(request_);
    const std::string& path = request_.path;
    if (path == "film" && !film_) film_.emplace(*body_);  // reports errors before data are read
    const bool is_of_base = !body_->contains("state") && (path == "api/data" || path == "api/check");
    if (is_of_base) (*body_)["state"] = context_.reader.base();
    const Json& state = state_of(*body_);
    if (path == "api/command") return {json_response({{"command", context_.reader.command(state)}})};
    OpenScene open{state, context_.reader.scene(state), nullptr};
    open.held = context_.stage.data(state, open.scene);
    if (!open.held) return wait();
    long_ = long_work(open);
    if (long_) return {.is_long = true};
    return {json_response(json_answer(open))};
  }

  std::unique_ptr<ApiWork> long_work(const OpenScene& open) {
    const std::string& path = request_.path;
    if (path == "picture") return make_picture_work(context_, open, *body_, stop_);
    if (path == "film") return make_film_work(context_, open, std::move(*film_), stop_);
    if (path == "api/verify") return make_verify_work(context_, open, *body_, stop_);
    if (path == "api/check") return make_check_work(open);
    return nullptr;
  }

  Json json_answer(const OpenScene& open) {
    const std::string& path = request_.path;
    if (path == "api/data") return data_answer(context_, open);
    if (path == "api/histogram") return histogram_answer(context_, open, *body_);
    if (path == "api/function") return function_answer(context_, open);
    if (path == "api/camera") return camera_answer(open, *body_);
    return probe_answer(context_, open, *body_);
  }

  /// While data are being read, a request for their description is answered with the progress; all other requests wait.
  ApiResult wait() {
    if (request_.path != "api/data") return {std::nullopt, true};
    Json text = {{"reading", true}, {"stage", "reading"}, {"fraction", nullptr}};
    if (const auto reading = context_.stage.reading()) {
      text["stage"] = reading->stage;
      if (reading->fraction) text["fraction"] = *reading->fraction;
    }
    Response response = json_response(text);
    response.status = 503;
    return {response};
  }

  Request request_;
  ApiContext context_;
  std::stop_token stop_;
  std::optional<Json> body_;
  std::optional<FilmPlan> film_;
  std::unique_ptr<ApiWork> long_;
};

}  // namespace

Response json_response(const Json& json) {
  return {200, "application/json", std::make_shared<const std::string>(text_of(json))};
}

Response stopped_response() {
  return error_response(503, "The request was stopped because the server is ending or no client is waiting for it.");
}

void LongProgress::set(std::optional<double> fraction) {
  const std::lock_guard lock(mutex_);
  fraction_ = fraction;
}

std::optional<double> LongProgress::get() const {
  const std::lock_guard lock(mutex_);
  return fraction_;
}

std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, std::stop_token stop) {
  return std::make_unique<PlainWork>(std::move(request), context, std::move(stop));
}

std::optional<Response> answer_at_once(const Request& request, const ApiContext& context) {
  const auto* const route =
      std::find_if(routes.begin(), routes.end(), [&](const Route& r) { return r.path == request.path; });
  if (route == routes.end())
    return error_response(404, "There is nothing at this address; docs/SERVER.md lists the addresses.");
  const bool is_get = request.method == "GET", is_post = request.method == "POST";
  if ((!is_get && !is_post) || (is_get && !route->get) || (is_post && !route->post))
    return error_response(405, fmt::format("Ask for {} by {}.", route->path, route->get ? "GET" : "POST"));
  if (request.path != "api/progress") return std::nullopt;
  const auto film = context.film.get(), picture = context.picture.get();
  const auto reading = context.stage.reading();
  return json_response({{"film", film ? Json(*film) : Json()},
                        {"picture", picture ? Json(*picture) : Json()},
                        {"reading", reading.has_value()},
                        {"stage", reading ? Json(reading->stage) : Json()},
                        {"fraction", reading && reading->fraction ? Json(*reading->fraction) : Json()}});
}

Response response_to(const std::exception_ptr& thrown, const ApiContext& context) {
  const Error error = error_of(thrown);
  if (error.code() == ErrorCode::bad_input) return error_response(400, context.reader.worded(error.what()));
  if (context.stage.ranks() > 1) std::rethrow_exception(thrown);
  return error_response(500, context.reader.worded(error.what()));
}

}  // namespace tessera::server
