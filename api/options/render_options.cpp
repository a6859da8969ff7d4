// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/render_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "api/options/setting_name.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/input_file.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

/// Throws for options that apply only to the other kind of data. For grids, an option of meshes is allowed if it has
/// its default value, which is its first choice.
void refuse_others(const OptionWords& words, bool is_grid) {
  for (const OptionRow* row : option_rows(is_grid ? Trait::meshes : Trait::volumes)) {
    if (!row->is(Trait::render) || !words.given(row->key())) continue;
    const auto choices = row->choices();
    if (is_grid && !choices.empty() && words.word(row->key()) == choices.front()) continue;
    if (words.given("input")) require_input(words.word("input"));  // a missing input is neither a mesh nor a volume
    throw bad_input(fmt::format("{}: it is for {}; leave it out", api::setting_name(row->key()),
                                is_grid ? "meshes, but the input is a volume" : "volumes, but the input is a mesh"));
  }
}

}  // namespace

RenderOptions render_options(const OptionWords& words) {
  InputFile first = first_input(words);
  RenderOptions options = render_options(words, draws_grids(words, first));
  options.first = std::move(first);
  return options;
}

Dataset RenderOptions::open(std::span<const std::filesystem::path> files, const ReadOptions& how,
                            const Communicator& communicator) const {
  if (files.size() == 1 && first && files.front() == first->path())
    return Dataset::open(*first, how, communicator, settings.ranks);
  return Dataset::open(files, how, communicator, settings.ranks);
}

RenderOptions render_options(const OptionWords& words, bool is_grid) {
  refuse_others(words, is_grid);
  RenderOptions options;
  options.words = words;
  FilmPlan& plan = options.plan;
  plan.grids = is_grid;
  plan.inputs = {words.word("input")};
  const auto& more = words.words("more");
  plan.inputs.insert(plan.inputs.end(), more.begin(), more.end());
  if (more.empty() && is_time_series(plan.inputs.front())) plan.series = read_time_series(plan.inputs.front());
  plan.steps = api::time_steps(words);
  api::set_outputs(words, options);
  options.read = read_options(words, is_grid);
  if (options.read.time_step && is_series(plan)) {  // for a series, the option is a step of the series, not of its
                                                    // files
    plan.steps = StepRange{*options.read.time_step, options.read.time_step};
    options.read.time_step.reset();
  }
  api::set_function(words, options);
  api::set_view(words, options);
  api::set_method(words, options);
  options.settings.surfaces = api::surfaces_of(words, options.block_surfaces);
  if (is_grid && !options.block_surfaces.empty())
    throw bad_input("`surface`: it is for meshes, but the input is a volume; `iso` VALUE shows a surface in one");
  api::set_ranks(words, options);
  api::set_pictures(words, options);
  return options;
}

}  // namespace v0_1
}  // namespace tessera
