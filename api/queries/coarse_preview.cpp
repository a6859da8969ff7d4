// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/coarse_preview.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "api/queries/preview.hpp"
#include "frame/ranks/reduce.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr std::uint64_t least_samples = 8, most_samples = std::uint64_t{1} << 26;

/// Makes a data set of the samples of a preview. It has the source and field name of `whole`, the data that it
/// represents.
Dataset dataset_of(std::shared_ptr<const scene::SampleSource> samples, const Dataset::State& whole, int threads) {
  auto state = std::make_shared<Dataset::State>();
  state->samples = std::move(samples);
  state->ranges =
      scene::with_threads(threads, [&] { return std::make_shared<const volume::CellRanges>(*state->samples); });
  const scene::ValueRange& range = state->ranges->range;
  if (range.empty())
    throw scene::bad_input(whole.source + ": so few samples contain none of its data; request more, or use the data");
  const GridGeometry& geometry = state->samples->geometry();
  state->facts = {
      scene::bounds(geometry), {range.low, range.high}, scene::mean_thickness(geometry), 0, geometry.association};
  if (!whole.clip.empty() && whole.samples != nullptr) state->facts.box = whole.facts.box, state->clip = whole.clip;
  state->source = whole.source;
  state->format = "coarse preview";
  state->field_name = whole.field_name;
  state->shape = whole.shape;
  state->body_axes = whole.body_axes;
  state->fields = {{whole.field_name, state->facts.association, 1, "float", range.low, range.high, range.blanks, true}};
  const GridIndex n = geometry.samples();
  state->notes = {fmt::format("a coarse preview of {} x {} x {} samples", n[0], n[1], n[2])};
  return StateAccess::make(std::move(state));
}

/// Makes a source of samples from a grid in the encoding of PreviewSamples.
std::shared_ptr<const scene::SampleSource> source_of(const api::PreviewSamples& samples,
                                                     const std::array<double, 2>& range, GridGeometry geometry,
                                                     const std::string& field) {
  std::vector<float> values;
  values.reserve(samples.size());
  for (const std::uint64_t sample : samples)
    values.push_back(sample == api::no_sample ? std::numeric_limits<float>::quiet_NaN()
                                              : std::bit_cast<float>(static_cast<std::uint32_t>(sample)));
  scene::Grid grid;
  grid.geometry = std::move(geometry);
  grid.scale = range[0] < range[1] ? range[1] - range[0] : 1;
  grid.shift = range[0];
  grid.field_name = field;
  return scene::MemorySource::of(std::move(grid), std::move(values), "coarse preview");
}

}  // namespace

std::optional<Dataset> coarse_preview(const Dataset& dataset, const PreviewSettings& settings,
                                      const std::stop_token& stop, const Communicator& communicator) {
  const Dataset::State& data = StateAccess::of(dataset);
  if (settings.samples < least_samples || settings.samples > most_samples)
    throw scene::bad_input(fmt::format("preview: {} samples are not supported; choose {} to {}", settings.samples,
                                       least_samples, most_samples));
  if (data.ranks > 1 && data.ranks != communicator.size())
    throw scene::bad_input(fmt::format(
        "{}: this rank has a part of the mesh; give the communicator that it was opened with", data.source));
  tbb::task_arena arena(scene::threads_for(settings.threads));
  if (dataset.is_grid()) {
    if (static_cast<std::uint64_t>(data.samples->geometry().all_samples().count()) <= settings.samples) return dataset;
    std::shared_ptr<const scene::SampleSource> samples;
    arena.execute([&] { samples = api::coarser(*data.samples, settings.samples, stop); });
    if (samples == nullptr) return std::nullopt;
    return dataset_of(std::move(samples), data, settings.threads);
  }
  const GridGeometry geometry = api::preview_geometry(data.facts.box, settings.samples);
  api::PreviewSamples samples;
  arena.execute(
      [&] { samples = api::preview_samples(data.mesh, data.global_tet, data.facts.scalar_range, geometry, stop); });
  bool stopped = stop.stop_requested();
  if (data.ranks > 1) {
    const std::shared_ptr<exchange::Transport> transport = StateAccess::of(communicator).connect();
    stopped = frame::reduce_all(*transport, {stopped ? 1U : 0U}, frame::Reduction::bit_or).front() != 0;
    if (!stopped) samples = frame::reduce_all(*transport, std::move(samples), frame::Reduction::minimum);
  }
  if (stopped) return std::nullopt;
  return dataset_of(source_of(samples, data.facts.scalar_range, geometry, data.field_name), data, settings.threads);
}

}  // namespace v0_1
}  // namespace tessera
