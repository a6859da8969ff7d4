#include "server/api.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "server/access.hpp"
#include "server/finished_picture.hpp"
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

Response json_response(const Json& json) {
  return {200, "application/json", std::make_shared<const std::string>(text_of(json))};
}

/// Of a GET, the body that a POST would have.
Json body_of(const Request& request) {
  if (request.method == "POST") return parse_body(request.body);
  Json body = Json::object();
  if (const auto state = query_value(request.query, "state")) body["state"] = parse_body(*state);
  if (const auto format = query_value(request.query, "format")) body["format"] = *format;
  return body;
}

PictureFormat picture_format(const Json& body) {
  const auto found = body.find("format");
  const std::string word = found == body.end() ? "png" : found->is_string() ? found->get<std::string>() : "";
  if (word == "png") return PictureFormat::png;
  if (word == "exr") return PictureFormat::exr;
  if (word == "jpg") return PictureFormat::jpeg;
  throw bad_input("format: is none of a picture; use png, exr or jpg");
}

/// A picture as `tessera render` writes it. Nothing if nobody waits for it any more.
Response picture_answer(const ApiContext& context, const OpenScene& open, PictureFormat format,
                        const std::stop_token& gone) {
  const View view = open.scene->view(open.held->data);
  RenderedFrame rendered = context.stage.render(open.state, *open.scene, *open.held, view, {}, nullptr, gone);
  if (rendered.stopped) return error_response(500, "Nobody waits for the picture.");
  const auto& function = context.stage.function(*open.held, *open.scene).function;
  Response response{200, media_type(format),
                    finished_picture(std::move(rendered.image), format, *open.scene, view, open.held->data, function)};
  response.file_name = format == PictureFormat::png   ? "picture.png"
                       : format == PictureFormat::exr ? "picture.exr"
                                                      : "picture.jpg";
  return response;
}

class PlainWork final : public ApiWork {
 public:
  PlainWork(Request request, const ApiContext& context, std::stop_token gone)
      : request_(std::move(request)), context_(context), gone_(std::move(gone)) {}

  ApiResult turn() override {
    try {
      return film_ ? film_->turn() : answer();
    } catch (...) {
      return {response_to(std::current_exception(), context_)};
    }
  }

 private:
  ApiResult answer() {
    if (!body_) body_ = body_of(request_);
    const std::string& path = request_.path;
    if (path == "film") {
      film_ = make_film_work(*body_, context_, gone_);
      return film_->turn();
    }
    const bool is_of_base = !body_->contains("state") && (path == "api/data" || path == "api/check");
    if (is_of_base) (*body_)["state"] = context_.reader.base();
    const Json& state = state_of(*body_);
    if (path == "api/command") return {json_response({{"command", context_.reader.command(state)}})};
    OpenScene open{state, context_.reader.scene(state), nullptr};
    open.held = context_.stage.data(state, open.scene);
    if (!open.held) return wait();
    if (path == "picture") return {picture_answer(context_, open, picture_format(*body_), gone_)};
    return {json_response(json_answer(open))};
  }

  Json json_answer(const OpenScene& open) {
    const std::string& path = request_.path;
    if (path == "api/data") return data_answer(context_, open);
    if (path == "api/histogram") return histogram_answer(context_, open, *body_);
    if (path == "api/function") return function_answer(context_, open);
    if (path == "api/camera") return camera_answer(open, *body_);
    if (path == "api/probe") return probe_answer(context_, open, *body_);
    if (path == "api/verify") return verify_answer(context_, open, *body_);
    return check_answer(open);
  }

  /// Who asks what data there is hears that it is being read; others wait.
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
  std::stop_token gone_;
  std::optional<Json> body_;
  std::unique_ptr<ApiWork> film_;
};

}  // namespace

void FilmProgress::set(std::optional<double> fraction) {
  const std::lock_guard lock(mutex_);
  fraction_ = fraction;
}

std::optional<double> FilmProgress::get() const {
  const std::lock_guard lock(mutex_);
  return fraction_;
}

std::unique_ptr<ApiWork> make_api_work(Request request, const ApiContext& context, const std::stop_token& gone) {
  return std::make_unique<PlainWork>(std::move(request), context, gone);
}

std::optional<Response> answer_at_once(const Request& request, const ApiContext& context) {
  const auto* const route =
      std::find_if(routes.begin(), routes.end(), [&](const Route& r) { return r.path == request.path; });
  if (route == routes.end())
    return error_response(404, "There is nothing at this address; docs/SERVER.md has what there is.");
  const bool is_get = request.method == "GET", is_post = request.method == "POST";
  if ((!is_get && !is_post) || (is_get && !route->get) || (is_post && !route->post))
    return error_response(405, fmt::format("Ask for {} by {}.", route->path, route->get ? "GET" : "POST"));
  if (request.path != "api/progress") return std::nullopt;
  const auto film = context.progress.get();
  const auto reading = context.stage.reading();
  return json_response({{"film", film ? Json(*film) : Json()},
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
