// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/series_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "tessera/error.hpp"
#include "tessera/program/film.hpp"

namespace tessera::apps {
namespace {

/// How far values may exceed the range of the colours, as a fraction of the range's width.
constexpr double most_beyond = 0.1;

/// One examined step, with its own field or the field chosen for all steps.
struct ExaminedStep {
  std::size_t step = 0;
  std::string field;  ///< empty: the step shows the shape
  std::array<double, 2> range{};
  std::vector<FieldInfo> fields;
  std::optional<LoadedTransferFunction> function;
  std::exception_ptr no_function;  ///< the error if the step has no function: with --log, a field that is 0 everywhere
};

std::vector<std::size_t> all_below(std::size_t end) {
  std::vector<std::size_t> all(end);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

double span_of(const std::array<double, 2>& range) { return range[1] - range[0]; }

class SeriesExamination {
 public:
  SeriesExamination(const RenderOptions& options, const ReadOptions& read, const OpenStep& open)
      : options_(options), read_(read), open_(open), keeps_values_(function_has_values(options)) {}

  /// Examines the steps from the last to the first. The first step remains open.
  void examine(const std::vector<std::size_t>& steps) {
    std::for_each(steps.rbegin(), steps.rend(), [this](std::size_t step) {
      if (std::ranges::find(examined_, step, &ExaminedStep::step) != examined_.end()) return;
      if (const Dataset* data = opened(step, read_)) examined_.push_back(found_in(step, *data));
    });
  }

  [[nodiscard]] bool varies() const {
    if (read_.field.empty()) return !chosen_field().empty();
    return std::ranges::any_of(examined_, [](const ExaminedStep& l) { return span_of(l.range) > 0; });
  }

  SeriesChoice choose() {
    SeriesChoice choice;
    choice.field = read_.field.empty() ? chosen_field() : read_.field;
    if (choice.field.empty()) require_same_field();
    ReadOptions chosen = read_;
    chosen.field = choice.field;
    if (read_.field.empty() && !choice.field.empty())
      for (ExaminedStep& l : examined_)
        if (l.field != choice.field)
          if (const Dataset* data = opened(l.step, chosen)) l = found_in(l.step, *data);
    std::ranges::sort(examined_, {}, &ExaminedStep::step);
    const ExaminedStep& widest =
        *std::ranges::max_element(examined_, {}, [](const ExaminedStep& l) { return span_of(l.range); });
    choice.range = widest.range;
    for (const ExaminedStep& l : examined_) {
      choice.steps.push_back(l.step);
      choice.range = {std::min(choice.range[0], l.range[0]), std::max(choice.range[1], l.range[1])};
    }
    choice.function = function_over(choice.range, widest, chosen);
    if (!(last_opened_ == std::pair(std::size_t{0}, choice.field)) &&
        !(last_opened_.first == 0 && choice.field.empty()))
      opened(0, chosen);
    return choice;
  }

 private:
  const Dataset* opened(std::size_t step, const ReadOptions& read) {
    const Dataset* const data = open_(step, read);
    if (data != nullptr) last_opened_ = {step, word_of(*data)};
    return data;
  }

  /// The name of the field in the form of field_of_steps().
  [[nodiscard]] std::string word_of(const Dataset& data) const {
    if (!read_.field.empty()) return read_.field;
    if (data.shows_shape() || data.fields().empty()) return "";
    if (read_.smooth) return data.field_name();
    return (data.association() == Association::point ? "point:" : "cell:") + data.field_name();
  }

  ExaminedStep found_in(std::size_t step, const Dataset& data) {
    ExaminedStep found{step, word_of(data), data.range(), {data.fields().begin(), data.fields().end()}, {}, {}};
    // The function is computed now, since only one step is in memory at a time.
    try {
      if (!keeps_values_) found.function = transfer_function_of(data, options_);
    } catch (const Error&) {
      found.no_function = std::current_exception();
    }
    return found;
  }

  [[nodiscard]] std::string chosen_field() const {
    std::vector<std::vector<FieldInfo>> fields;
    std::transform(examined_.rbegin(), examined_.rend(), std::back_inserter(fields),
                   std::mem_fn(&ExaminedStep::fields));
    return field_of_steps(fields, read_);
  }

  /// Throws if no field varies over the steps and some steps do not have the field that others show. Those steps would
  /// show another field with the same colours.
  void require_same_field() {
    std::ranges::sort(examined_, {}, &ExaminedStep::step);
    const auto with = std::ranges::find_if(examined_, [](const ExaminedStep& l) { return !l.field.empty(); });
    if (with == examined_.end()) return;
    const auto without = std::ranges::find_if(examined_, [&](const ExaminedStep& l) { return l.field != with->field; });
    if (without == examined_.end()) return;
    throw bad_input(
        fmt::format("time step {} has no field '{}', which time step {} shows; choose steps that have it with "
                    "--time-step FIRST:LAST, or a field that all steps have with --field",
                    without->step, with->field, with->step));
  }

  std::optional<LoadedTransferFunction> function_over(const std::array<double, 2>& range, const ExaminedStep& widest,
                                                      const ReadOptions& read) {
    if (keeps_values_) return std::nullopt;
    if (widest.no_function) std::rethrow_exception(widest.no_function);
    const double beyond = std::max(widest.range[0] - range[0], range[1] - widest.range[1]);
    if (options_.function.range || options_.function.rescale || !(beyond > most_beyond * span_of(widest.range)))
      return widest.function;
    RenderOptions over_all = options_;
    over_all.function.range = range;
    const Dataset* const data = opened(widest.step, read);
    return data == nullptr ? widest.function : transfer_function_of(*data, over_all);
  }

  const RenderOptions& options_;
  const ReadOptions& read_;
  const OpenStep& open_;
  const bool keeps_values_;
  std::vector<ExaminedStep> examined_;  ///< in the order of examination; sorted by step after a field has been chosen
  std::pair<std::size_t, std::string> last_opened_;
};

}  // namespace

bool function_has_values(const RenderOptions& options) {
  const std::string& function = options.transfer_function;
  return !options.function.rescale && (is_json_text(function) || std::filesystem::exists(function));
}

bool depends_on_steps(std::size_t steps, const RenderOptions& options) {
  if (steps < 2) return false;
  const bool fixes_values =
      function_has_values(options) || (options.function.range && !options.transfer_function.empty());
  return options.read.field.empty() || !fixes_values;
}

std::vector<std::size_t> steps_to_examine(std::size_t steps) {
  const std::size_t last = steps - 1;
  if (steps <= 5) return all_below(steps);
  const std::set<std::size_t> chosen = {0, last / 4, last / 2, last - last / 4, last};
  return {chosen.begin(), chosen.end()};
}

SeriesChoice choose_by_steps(std::vector<std::size_t> steps, const RenderOptions& options, const ReadOptions& read,
                             const OpenStep& open) {
  SeriesExamination examination(options, read, open);
  examination.examine(steps.size() > 3 ? std::vector{steps.front(), steps[steps.size() / 2], steps.back()} : steps);
  if (!examination.varies()) examination.examine(steps);
  return examination.choose();
}

std::string series_note(const SeriesChoice& choice, std::size_t steps, const std::string& field) {
  std::string list;
  for (std::size_t k = 0; k < choice.steps.size(); ++k)
    list += fmt::format("{}{}", k == 0 ? "" : k + 1 == choice.steps.size() ? " and " : ", ", choice.steps[k]);
  return fmt::format("field {} {} chosen by time steps {} of 0 to {}, where it is from {:.6g} to {:.6g}", field,
                     choice.function ? "and its colours are" : "is", list, steps - 1, choice.range[0], choice.range[1]);
}

}  // namespace tessera::apps
