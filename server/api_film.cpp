#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
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

/// A folder of its own, gone with this.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tessera-film-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(ErrorCode::system_failure, "film", "no temporary folder can be made", "make room, or set TMPDIR");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Between two directions, along the great circle; opposite ones have none, and are left at the first until half way.
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

/// Distances and scales go evenly by ratio, directions by angle.
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
    throw bad_input(fmt::format("views: is no list of 1 to {} cameras; send one", most_views));
  std::vector<Camera> views;
  for (const CameraFile& view : parse_cameras(listed.dump(), "views")) views.push_back(view.camera);
  return views;
}

class FilmWork final : public ApiWork {
 public:
  FilmWork(Json body, const ApiContext& context, std::stop_token gone)
      : body_(std::move(body)), context_(context), gone_(std::move(gone)) {
    const auto format = body_.find("format");
    if (format != body_.end()) format_ = format->is_string() ? format->get<std::string>() : "";
    if (std::ranges::find(film_formats, format_) == film_formats.end())
      throw bad_input("format: is none of a film; use mp4, webm or gif");
    if (const auto rate = body_.find("rate"); rate != body_.end()) {
      if (!rate->is_number() || !(rate->get<double>() > 0) || rate->get<double>() > 1000)
        throw bad_input("rate: is no number of frames a second above 0, at most 1000; send one");
      rate_ = rate->get<double>();
    }
    if (body_.contains("views") == body_.contains("orbit"))
      throw bad_input("film: it has an orbit or views, one of the two; send orbit, a number of frames, or views");
    if (body_.contains("views")) {
      views_ = views_of(body_);
      frames_ = whole_number(body_, "frames", static_cast<std::int64_t>(views_.size()), 1, most_frames);
    } else {
      frames_ = whole_number(body_, "orbit", 0, 1, most_frames);
    }
  }
  ~FilmWork() override { context_.progress.set(std::nullopt); }

  ApiResult turn() override {
    try {
      return make_frame();
    } catch (const Error& error) {
      // A client knows nothing of the scratch file, nor of names that would do instead.
      if (!error.subject().starts_with(scratch_.path().native())) throw;
      throw Error(error.code(), "film", error.problem(),
                  "see that ffmpeg works on the server's machine (Debian: apt install ffmpeg)");
    }
  }

 private:
  ApiResult make_frame() {
    const Json& state = state_of(body_);
    const OpenScene open{state, scene(state), context_.stage.data(state, scene(state))};
    if (!open.held) return {std::nullopt, true};
    const View first = open.scene->view(open.held->data);
    if (!film_) {
      const auto file = scratch_.path() / ("film." + format_);
      film_.emplace(file, first.size, FilmFileOptions{open.scene->image_options(), rate_});
    }
    const View view{camera(first.camera), first.size};
    RenderedFrame rendered = context_.stage.render(state, *open.scene, *open.held, view, {}, nullptr, gone_);
    if (rendered.stopped) return {error_response(500, "Nobody waits for the film.")};
    const auto& function = context_.stage.function(*open.held, *open.scene).function;
    if (open.scene->explains()) open.scene->explain(rendered.image, view, open.held->data, function);
    film_->add(rendered.image);
    context_.progress.set(1.0 * ++made_ / static_cast<double>(frames_));
    if (made_ < frames_) return {};
    film_->commit();
    context_.progress.set(std::nullopt);  // before anybody has the film
    std::ifstream file(scratch_.path() / ("film." + format_), std::ios::binary);
    auto bytes =
        std::make_shared<const std::string>(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    Response response{200, format_ == "gif" ? "image/gif" : "video/" + format_, std::move(bytes)};
    response.file_name = "film." + format_;
    return {std::move(response)};
  }

  std::shared_ptr<const Scene> scene(const Json& state) {
    if (!scene_) scene_ = context_.reader.scene(state);
    return scene_;
  }

  [[nodiscard]] Camera camera(const Camera& first) const {
    const auto at = static_cast<double>(made_), count = static_cast<double>(frames_);
    if (views_.empty()) return orbit(first, at / count);
    if (views_.size() == 1 || frames_ == 1) return views_.front();
    const double place = at / (count - 1) * static_cast<double>(views_.size() - 1);
    const auto from = std::min(static_cast<std::size_t>(place), views_.size() - 2);
    return between(views_[from], views_[from + 1], place - static_cast<double>(from));
  }

  Json body_;
  ApiContext context_;
  std::stop_token gone_;
  std::string format_ = "mp4";
  double rate_ = 25;
  std::vector<Camera> views_;
  std::int64_t frames_ = 0, made_ = 0;
  std::shared_ptr<const Scene> scene_;
  ScratchFolder scratch_;
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

std::unique_ptr<ApiWork> make_film_work(Json body, const ApiContext& context, const std::stop_token& gone) {
  return std::make_unique<FilmWork>(std::move(body), context, gone);
}

}  // namespace tessera::server
