// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/reports.hpp"
#include "server/api.hpp"
#include "server/finished_picture.hpp"
#include "server/messages.hpp"
#include "tessera/error.hpp"

namespace tessera::server {
namespace {

PictureFormat picture_format(const Json& body) {
  const auto found = body.find("format");
  const std::string word = found == body.end() ? "png" : found->is_string() ? found->get<std::string>() : "";
  if (word == "png") return PictureFormat::png;
  if (word == "exr") return PictureFormat::exr;
  if (word == "jpg") return PictureFormat::jpeg;
  throw bad_input("format: its value is not an image format; use png, exr or jpg");
}

/// Renders an image as `tessera render` writes it.
class PictureWork final : public ApiWork {
 public:
  PictureWork(const ApiContext& context, const OpenScene& open, const Json& body, std::stop_token stop)
      : context_(context),
        scene_(open.scene),
        held_(open.held),
        format_(picture_format(body)),
        view_(open.scene->view(open.held->data)),
        frames_(context.stage.frames(open.state, open.scene, open.held, view_.size)),
        stop_(std::move(stop)) {}
  ~PictureWork() override { context_.picture.set(std::nullopt); }

  ApiResult turn() override {
    const double pixels = 1.0 * view_.size.width * view_.size.height;
    double done = 0;
    YieldingSink sink(context_.precedence, stop_, [&](const Tile& tile) {
      done += static_cast<double>(tile.rect.area());
      context_.picture.set(std::min(1.0, done / pixels));
    });
    RenderedFrame rendered = frames_->render(view_, {}, &sink, stop_);
    if (rendered.stopped) return {stopped_response()};
    Response response{200, media_type(format_),
                      finished_picture(std::move(rendered.image), format_, *scene_, view_, held_->data,
                                       frames_->function().function)};
    response.file_name = format_ == PictureFormat::png   ? "picture.png"
                         : format_ == PictureFormat::exr ? "picture.exr"
                                                         : "picture.jpg";
    return {std::move(response)};
  }

 private:
  ApiContext context_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<HeldData> held_;
  PictureFormat format_;
  View view_;
  std::unique_ptr<SceneFrames> frames_;
  std::stop_token stop_;
};

class VerifyWork final : public ApiWork {
 public:
  VerifyWork(const ApiContext& context, const OpenScene& open, const Json& body, std::stop_token stop)
      : context_(context),
        held_(open.held),
        pixels_(static_cast<std::size_t>(whole_number(body, "pixels", 1000, 1, 100'000))),
        view_(open.scene->view(open.held->data)),
        frames_(context.stage.frames(open.state, open.scene, open.held, view_.size)),
        stop_(std::move(stop)) {}

  ApiResult turn() override {
    FrameSettings settings;
    settings.keep_uncertainty = held_->data.is_grid();
    YieldingSink sink(context_.precedence, stop_, [](const Tile& /*tile*/) {});
    const RenderedFrame rendered = frames_->render(view_, settings, &sink, stop_);
    if (rendered.stopped) return {stopped_response()};
    const Verification found = frames_->session().verify(rendered, view_, frames_->function().function, pixels_);
    return {json_response({{"pixels", found.pixels_checked},
                           {"largest_error", found.max_error_not_excused},
                           {"largest_error_of_all", found.max_error},
                           {"promised", found.bound ? Json(*found.bound) : Json()},
                           {"excused", found.excused},
                           {"over_bound", found.over_bound},
                           {"rms", found.rms_error},
                           {"met", found.met},
                           {"worst", {found.worst_x, found.worst_y}}})};
  }

 private:
  ApiContext context_;
  std::shared_ptr<HeldData> held_;
  std::size_t pixels_;
  View view_;
  std::unique_ptr<SceneFrames> frames_;
  std::stop_token stop_;
};

class CheckWork final : public ApiWork {
 public:
  explicit CheckWork(std::shared_ptr<HeldData> held) : held_(std::move(held)) {}
  ApiResult turn() override { return {json_response(Json::parse(analysis::check_json(held_->data.check()).dump()))}; }

 private:
  std::shared_ptr<HeldData> held_;
};

}  // namespace

std::unique_ptr<ApiWork> make_picture_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                           std::stop_token stop) {
  return std::make_unique<PictureWork>(context, open, body, std::move(stop));
}

std::unique_ptr<ApiWork> make_verify_work(const ApiContext& context, const OpenScene& open, const Json& body,
                                          std::stop_token stop) {
  return std::make_unique<VerifyWork>(context, open, body, std::move(stop));
}

std::unique_ptr<ApiWork> make_check_work(const OpenScene& open) { return std::make_unique<CheckWork>(open.held); }

}  // namespace tessera::server
