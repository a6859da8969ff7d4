// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/api.hpp"
#include "server/frame_message.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"
#include "tessera/film_file.hpp"

namespace tessera::server {
namespace {

constexpr std::int64_t most_frames = 10'000, most_views = 1000;
constexpr std::array<std::string_view, 3> film_formats = {"mp4", "webm", "gif"};

/// Interpolates between two directions along the great circle. Opposite directions do not define one: the result
/// changes from one to the other in the middle.
glm::dvec3 turned(const glm::dvec3& from, const glm::dvec3& to, double t) {
  const double lengths = glm::length(from) * glm::length(to);
  if (!(lengths > 0)) return t < 0.5 ? from : to;
  const double cosine = std::clamp(glm::dot(from, to) / lengths, -1.0, 1.0), angle = std::acos(cosine);
  const double length = std::exp((1 - t) * std::log(glm::length(from)) + t * std::log(glm::length(to)));
  if (angle < 1e-9) return glm::normalize(from) * length;
  if (angle > M_PI - 1e-9) return glm::normalize(t < 0.5 ? from : to) * length;
  return (std::sin((1 - t) * angle) * glm::normalize(from) + std::sin(t * angle) * glm::normalize(to)) *
         (length / std::sin(angle));
}

/// Interpolates between two cameras: distances and scales by ratio, directions by angle.
Camera between(const Camera& from, const Camera& to, double t) {
  if (t <= 0) return from;
  if (t >= 1) return to;
  Camera camera = t < 0.5 ? from : to;
  camera.focal_point = (1 - t) * from.focal_point + t * to.focal_point;
  camera.position = camera.focal_point + turned(from.position - from.focal_point, to.position - to.focal_point, t);
  camera.view_up = turned(from.view_up, to.view_up, t);
  camera.parallel_scale = std::exp((1 - t) * std::log(from.parallel_scale) + t * std::log(to.parallel_scale));
  camera.view_angle = (1 - t) * from.view_angle + t * to.view_angle;
  return camera;
}

std::vector<Camera> views_of(const Json& body) {
  const Json& listed = body.at("views");
  if (!listed.is_array() || listed.empty() || static_cast<std::int64_t>(listed.size()) > most_views)
    throw bad_input(fmt::format("views: is not a list of 1 to {} cameras; send one", most_views));
  std::vector<Camera> views;
  for (const CameraFile& view : parse_cameras(listed.dump(), "views")) views.push_back(view.camera);
  return views;
}

class FilmWork final : public ApiWork {
 public:
  FilmWork(const ApiContext& context, const OpenScene& open, FilmPlan plan, std::stop_token stop)
      : context_(context),
        scene_(open.scene),
        held_(open.held),
        plan_(std::move(plan)),
        first_(open.scene->view(open.held->data)),
        frames_(context.stage.frames(open.state, open.scene, open.held, first_.size)),
        stop_(std::move(stop)),
        name_(std::filesystem::temp_directory_path() / ("tessera-film." + plan_.format)) {}
  ~FilmWork() override { context_.film.set(std::nullopt); }

  ApiResult turn() override {
    try {
      return make_frame();
    } catch (const Error& error) {
      // The names of the temporary directory and file have no meaning for a client.
      if (!error.subject().starts_with(name_.native())) throw;
      throw Error(error.code(), "film", error.problem(),
                  "see that ffmpeg works on the server's machine (Debian: apt install ffmpeg)");
    }
  }

 private:
  ApiResult make_frame() {
    // The film's file has no name in the directory, so nothing remains of the file, however this process ends.
    if (!film_) film_.emplace(name_, first_.size, FilmFileOptions{scene_->image_options(), plan_.rate});
    const View view{plan_.camera(made_, first_.camera), first_.size};
    YieldingSink sink(context_.precedence, stop_, [](const Tile& /*tile*/) {});
    RenderedFrame rendered = frames_->render(view, {}, &sink, stop_);
    if (rendered.stopped) return {stopped_response()};
    if (scene_->explains()) scene_->explain(rendered.image, view, held_->data, frames_->function().function);
    film_->add(rendered.image);
    context_.film.set(1.0 * static_cast<double>(++made_) / static_cast<double>(plan_.frames));
    if (made_ < plan_.frames) return {};
    Response response{200, plan_.format == "gif" ? "image/gif" : "video/" + plan_.format,
                      std::make_shared<const std::string>(film_->take())};
    response.file_name = "film." + plan_.format;
    context_.film.set(std::nullopt);  // must precede the delivery of the film to any client
    return {std::move(response)};
  }

  ApiContext context_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<HeldData> held_;
  FilmPlan plan_;
  std::int64_t made_ = 0;
  View first_;
  std::unique_ptr<SceneFrames> frames_;
  std::stop_token stop_;
  std::filesystem::path name_;
  std::optional<FilmFile> film_;
};

}  // namespace

Json films_json() {
  Json made = Json::array(), problem;
  for (const std::string_view format : film_formats) {
    try {
      check_film_file(std::filesystem::temp_directory_path() / fmt::format("tessera-film.{}", format));
      made.push_back(std::string(format));
    } catch (const std::exception& thrown) {
      const auto* const error = dynamic_cast<const Error*>(&thrown);
      problem = error != nullptr ? error->problem() : thrown.what();
    }
  }
  return {{"formats", std::move(made)}, {"problem", std::move(problem)}};
}

FilmPlan::FilmPlan(const Json& body) {
  if (const auto found = body.find("format"); found != body.end())
    format = found->is_string() ? found->get<std::string>() : "";
  if (std::ranges::find(film_formats, format) == film_formats.end())
    throw bad_input("format: is not a film format; use mp4, webm or gif");
  if (const auto found = body.find("rate"); found != body.end()) {
    rate = found->is_number() ? found->get<double>() : 0;
    if (!(rate >= least_film_rate && rate <= most_film_rate))
      throw bad_input(fmt::format("rate: is not a number of frames per second from {} to {}; send such a number",
                                  least_film_rate, most_film_rate));
  }
  if (body.contains("views") == body.contains("orbit"))
    throw bad_input(
        "film: it needs either an orbit or views; send either orbit (a number of frames) or views (a list of cameras)");
  if (body.contains("views")) {
    views = views_of(body);
    frames = whole_number(body, "frames", static_cast<std::int64_t>(views.size()), 1, most_frames);
  } else {
    frames = whole_number(body, "orbit", 0, 1, most_frames);
  }
}

Camera FilmPlan::camera(std::int64_t number, const Camera& first) const {
  const auto at = static_cast<double>(number), count = static_cast<double>(frames);
  if (views.empty()) return orbit(first, at / count);
  if (views.size() == 1 || frames == 1) return views.front();
  const double place = at / (count - 1) * static_cast<double>(views.size() - 1);
  const auto from = std::min(static_cast<std::size_t>(place), views.size() - 2);
  return between(views[from], views[from + 1], place - static_cast<double>(from));
}

std::unique_ptr<ApiWork> make_film_work(const ApiContext& context, const OpenScene& open, FilmPlan plan,
                                        std::stop_token stop) {
  return std::make_unique<FilmWork>(context, open, std::move(plan), std::move(stop));
}

}  // namespace tessera::server
