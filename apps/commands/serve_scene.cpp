// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/serve_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <list>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/options/series_choice.hpp"
#include "apps/render/frame_annotation.hpp"
#include "apps/render/progress.hpp"
#include "tessera/error.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/program/state_words.hpp"
#include "tessera/view.hpp"

namespace tessera::apps {
namespace {

/// Returns the options with this trait as one text. Values are quoted, so that different words always give different
/// texts.
std::string key_of(const OptionWords& words, Trait trait) {
  server::Json key = server::Json::object();
  for (const OptionRow* row : option_rows(trait))
    if (words.given(row->key())) key[std::string(row->key())] = words.words(row->key());
  return key.dump(-1, ' ', false, server::Json::error_handler_t::replace);
}

/// The words without the options that have this trait.
OptionWords without(OptionWords words, Trait trait) {
  for (const OptionRow* row : option_rows(trait)) words.set(row->key(), std::vector<std::string>());
  return words;
}

/// The field in the form of `--field`.
std::string field_word_of(const Dataset& data) {
  const std::string& name = data.field_name();
  const std::string bare = name.substr(0, name.rfind(':'));
  std::size_t alike = 0;
  for (const FieldInfo& field : data.fields())
    alike += static_cast<std::size_t>(field.name == name || field.name == bare);
  if (alike < 2) return name;
  return (data.association() == Association::cell ? "cell:" : "point:") + name;
}

bool preset_is_named(const std::string& function) {
  const std::vector<std::string> names = preset_names();
  return std::ranges::find(names, function.substr(0, function.find(':'))) != names.end();
}

/// The values of all options except camera and size, and values derived from them.
struct ParsedWords {
  RenderOptions options;
  FilmFrame frame;
  std::string data, field, look, settings;  ///< keys
  bool shape = false;
  std::string accuracy;
  std::shared_ptr<const LoadedTransferFunction> series_function{};     ///< function for all steps; null: each step has
                                                                       ///< its own
  mutable std::optional<std::pair<std::string, Surfaces>> surfaces{};  ///< surfaces including those of blocks, and the
                                                                       ///< field for which they were read
};

/// Returns the key of the data that are read. The key contains the given `field`, which may differ from the option's,
/// and, if `linear`, does not contain the accuracy, which has no effect without higher-order cells.
std::string data_key(const ParsedWords& parsed, const std::string& field, bool shape, bool linear) {
  return fmt::format("{} {} {} {}", parsed.data,
                     server::Json(field).dump(-1, ' ', false, server::Json::error_handler_t::replace), shape,
                     linear ? "linear" : parsed.accuracy);
}

class RenderScene final : public server::Scene {
 public:
  RenderScene(std::shared_ptr<const ParsedWords> parsed, const std::optional<Camera>& camera, ImageSize size)
      : parsed_(std::move(parsed)), frame_(parsed_->frame), size_(size) {
    frame_.camera = camera;
    frame_.size = size;
    for (const bool linear : {false, true}) keys_.push_back(data_key(*parsed_, parsed_->field, parsed_->shape, linear));
  }

  [[nodiscard]] const std::vector<std::string>& data_keys() const override { return keys_; }
  [[nodiscard]] std::vector<std::string> keys_of(const Dataset& data) const override {
    std::vector<std::string> keys;
    const bool is_linear = data.is_grid() || data.higher_order_cells().divided == 0;
    const auto add = [&](const std::string& field, bool shape) {
      keys.push_back(data_key(*parsed_, field, shape, false));
      if (is_linear) keys.push_back(data_key(*parsed_, field, shape, true));
    };
    add(parsed_->field, parsed_->shape);
    if (data.shows_shape()) return keys;
    const std::string name = field_word(data);
    const char* const side = data.association() == Association::cell ? "cell:" : "point:";
    add(name, false);
    if (!name.starts_with(side)) add(side + name, false);
    // If no field is named, the same field is chosen with and without a transfer function. Exceptions are labels and
    // constants: without a function, the shape is shown instead.
    if (parsed_->field.empty() && parsed_->shape) add("", false);
    return keys;
  }
  [[nodiscard]] const std::string& look_key() const override { return parsed_->look; }
  [[nodiscard]] const std::string& settings_key() const override { return parsed_->settings; }

  [[nodiscard]] std::string field_word(const Dataset& data) const override { return field_word_of(data); }

  [[nodiscard]] Dataset open(const Communicator& communicator, const ReadProgressFunction& progress) const override {
    ReadOptions read = options().read;
    if (frame_.data.in_file) read.time_step = frame_.data.in_file;
    read.progress = progress;
    frame_.require_still_there();
    return open_for_accuracy(
        options(), read,
        [&](const ReadOptions& with) {
          return Dataset::open(frame_.data.files, with, communicator, options().settings.ranks);
        },
        [&](const Dataset& data) { return function(data).function; }, [&](const Dataset& data) { return view(data); },
        communicator);
  }

  [[nodiscard]] LoadedTransferFunction function(const Dataset& data) const override {
    return parsed_->series_function ? *parsed_->series_function : transfer_function_of(data, options());
  }

  [[nodiscard]] Settings settings(const Dataset& data, const LoadedTransferFunction& function) const override {
    Settings settings = options().settings;
    if (!options().block_surfaces.empty() || data.axis_scale() != glm::dvec3(1))
      settings.surfaces = block_surfaces(data);
    if (shades_by_default(function, options())) settings.grid.shading.emplace();
    return settings;
  }

  [[nodiscard]] View view(const Dataset& data) const override {
    return {frame_.view(data.bounds(), options().projection, options().view, data.body_axes()), size_};
  }
  [[nodiscard]] ImageFileOptions image_options() const override { return options().image; }
  [[nodiscard]] bool explains() const override { return options().annotation.annotation.has_value(); }
  void explain(Image& image, const View& view, const Dataset& data, const TransferFunction& function) const override {
    draw_annotation(image, {frame_, view.camera, data, function, options()});
  }

 private:
  [[nodiscard]] const RenderOptions& options() const { return parsed_->options; }

  /// The surfaces, including those of blocks, for the field of `data`. The surfaces for the last field are kept.
  [[nodiscard]] const Surfaces& block_surfaces(const Dataset& data) const {
    std::string field = field_word(data);
    if (!parsed_->surfaces || parsed_->surfaces->first != field) {
      ReadOptions read = options().read;
      if (frame_.data.in_file) read.time_step = frame_.data.in_file;
      parsed_->surfaces.emplace(std::move(field), with_block_surfaces(options().settings.surfaces,
                                                                      found_blocks(options().block_surfaces, data),
                                                                      data, frame_.data.files, std::move(read)));
    }
    return parsed_->surfaces->second;
  }

  std::shared_ptr<const ParsedWords> parsed_;
  FilmFrame frame_;
  ImageSize size_;
  std::vector<std::string> keys_;
};

/// The choices that `render` would make for all steps of a series.
struct SeriesStart {
  std::string field;
  std::vector<std::string> names;  ///< names of the field
  std::array<double, 2> range{};
  std::shared_ptr<const LoadedTransferFunction> function;  ///< null if options specify its values
  std::string look;                                        ///< key of the options on which `function` is based
};

class RenderSceneReader final : public server::SceneReader {
 public:
  explicit RenderSceneReader(const OptionWords& words)
      : input_(words.word("input")), is_grid_(draws_grids(words, first_input(words))) {
    for (const OptionRow* row : option_rows(Trait::serve))
      if (row->is(Trait::render) && !row->is(Trait::positional)) base_.set(row->key(), words.words(row->key()));
    if (!is_time_series(input_)) return;
    for (const TimeStep& step : read_time_series(input_)) times_.push_back(step.time);
    shows_all_ = !base_.given("time-step");
    base_.set_default("time-step", "0");
  }

  /// Chooses field and colours of a series as `render` does for all its steps. If the first step cannot be read, the
  /// scene that opens this step reports the error. Collective.
  void choose_for_all_steps(Job& job) {
    if (!shows_all_) return;
    const auto parsed = parse(base_);
    const RenderOptions& options = parsed->options;
    if (!depends_on_steps(times_.size(), options)) return;
    const std::vector<TimeStep> series = read_time_series(input_);
    StatusLine line(shows_progress(false) && job.rank() == 0);
    try {
      job.attempt([&](const Communicator& ranks) {
        std::optional<Dataset> data;
        const OpenStep open_step = [&](std::size_t step, const ReadOptions& read) -> const Dataset* {
          data.reset();  // only one step in memory at a time
          line.begin("reading " + series[step].files.front().filename().string());
          ReadOptions watched = read;
          watched.progress = line.listener();
          try {
            data.emplace(Dataset::open(series[step].files, watched, ranks, options.settings.ranks));
          } catch (const Error&) {
            if (step == 0 || job.size() > 1) throw;
            return nullptr;
          }
          return &*data;
        };
        const SeriesChoice choice = choose_by_steps(steps_to_examine(series.size()), options, options.read, open_step);
        if (choice.field.empty()) return;
        start_ = {choice.field, {choice.field, field_word_of(*data)}, choice.range, nullptr, parsed->look};
        if (choice.function) start_->function = std::make_shared<LoadedTransferFunction>(*choice.function);
      });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
    }
  }

  std::shared_ptr<const server::Scene> scene(const server::Json& state) override {
    const OptionWords words = state_words(base_, state);
    const auto parsed = parsed_words(words);
    std::optional<Camera> view;
    ImageSize picture;
    if (words.given("camera")) {
      const CameraFile file = cameras_of(words.word("camera")).front();
      view = file.camera;
      if (file.size) picture = *file.size;
    }
    assign(picture, words.size("size"));
    return std::make_shared<RenderScene>(parsed, view, picture);
  }

  std::string command(const server::Json& state) override {
    static_cast<void>(scene(state));  // throws for an invalid state, which has no command
    OptionWords words = state_words(base_, state);
    if (const auto function = series_function(words)) {
      const bool states_shading = words.given_one_of({"shade", "no-shade"});
      words = without(std::move(words), Trait::knots);
      words.set("transfer-function", transfer_function_json(function->function));
      if (function->shaded && !states_shading) words.set("shade", "true");
    }
    words = without(with_series_start(std::move(words)), Trait::machine);
    std::vector<std::string> all = {"tessera", "render", input_};
    const std::vector<std::string> arguments = arguments_of(words);
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", "picture.png"});
    return shell_words(all);
  }

  [[nodiscard]] server::Json base() const override { return state_of_words(base_); }
  [[nodiscard]] bool fixes(const std::string& option) const override { return base_.given(option); }
  [[nodiscard]] std::string input_name() const override { return std::filesystem::path(input_).filename().string(); }
  [[nodiscard]] std::vector<double> times() const override { return times_; }
  [[nodiscard]] std::string worded(const std::string& message) const override { return with_options(message); }

  [[nodiscard]] server::Json exact(const server::Json& state) const override {
    const auto integrator = state.find("integrator");
    if (integrator != state.end() && *integrator == "exact") return state;
    server::Json exact = state;
    exact["integrator"] = "exact";
    for (const char* of_others : {"accuracy", "step"}) exact[of_others] = nullptr;
    return exact;
  }

 private:
  static constexpr std::size_t most_parsed = 32;

  [[nodiscard]] bool shows_series_field(const OptionWords& words) const {
    const std::string& field = words.word("field");
    return start_ && (field.empty() || std::ranges::find(start_->names, field) != start_->names.end());
  }

  /// Returns the function chosen for the series; null if the words request another one.
  [[nodiscard]] std::shared_ptr<const LoadedTransferFunction> series_function(const OptionWords& words) const {
    const bool is_its_own = shows_series_field(words) && key_of(words, Trait::look) == start_->look;
    return is_its_own ? start_->function : nullptr;
  }

  /// Returns the words with the field of the series and, for presets, the range of all steps.
  [[nodiscard]] OptionWords with_series_start(OptionWords words) const {
    if (!start_) return words;
    const auto [low, high] = start_->range;
    if (shows_series_field(words) && !series_function(words) && preset_is_named(words.word("transfer-function")) &&
        !words.given_one_of({"rescale", "range", "log"}) && low < high)
      words.set("range", fmt::format("{},{}", low, high));
    // Smoothing turns a cell field into a point field.
    words.set_default("field", words.given("smooth") ? start_->names.back() : start_->field);
    return words;
  }

  /// Parses the words. The result is kept and reused for all cameras and sizes, which change most often.
  std::shared_ptr<const ParsedWords> parsed_words(const OptionWords& words) {
    OptionWords rest = words;
    if (rest.given("camera")) rest.set("camera", "{}");
    rest.set("size", "");
    std::string key = server::Json(rest.all()).dump(-1, ' ', false, server::Json::error_handler_t::replace);
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept)
      if (kept->first == key) {
        kept_.splice(kept_.begin(), kept_, kept);
        return kept_.front().second;
      }
    kept_.emplace_front(std::move(key), parse(words));
    if (kept_.size() > most_parsed) kept_.pop_back();
    return kept_.front().second;
  }

  [[nodiscard]] std::shared_ptr<const ParsedWords> parse(const OptionWords& state) const {
    OptionWords words = with_series_start(state);
    words.set("input", input_);
    words.set("output", "picture.png");
    words.set("quiet", "true");
    const std::string& step = words.word("time-step");
    if (step.find_first_not_of("0123456789") != std::string::npos)
      throw bad_input(fmt::format("--time-step: '{}' is not a time step; give a number, counted from 0", step));
    auto parsed = std::make_shared<ParsedWords>();
    parsed->options = render_options(words, is_grid_);
    const RenderOptions& options = parsed->options;
    check_annotation(options.annotation);
    parsed->frame = plan_film(options.plan).front();
    parsed->data = key_of(words, Trait::data);
    if (words.given("clip") && words.given("iso")) parsed->data += server::Json(words.words("iso")).dump();
    parsed->field = words.word("field");
    parsed->shape = options.read.shape && parsed->field.empty();
    parsed->accuracy = fmt::format("{:a}", options.higher_order_accuracy.value_or(options.read.higher_order_tolerance));
    parsed->look = key_of(words, Trait::look);
    parsed->settings = key_of(words, Trait::settings);
    parsed->series_function = series_function(state);
    return parsed;
  }

  std::string input_;
  bool is_grid_;
  OptionWords base_;
  std::vector<double> times_;
  bool shows_all_ = false;  ///< the server shows all steps of a series
  std::optional<SeriesStart> start_;
  std::list<std::pair<std::string, std::shared_ptr<const ParsedWords>>> kept_;
};

}  // namespace

std::unique_ptr<server::SceneReader> scene_reader(const OptionWords& words, Job& job) {
  auto reader = std::make_unique<RenderSceneReader>(words);
  reader->choose_for_all_steps(job);
  return reader;
}

}  // namespace tessera::apps
