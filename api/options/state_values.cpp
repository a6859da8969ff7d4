// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "api/dataset.hpp"
#include "api/options/values.hpp"
#include "api/state_access.hpp"
#include "tessera/error.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/state.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

RenderOptions options_of(const State& state, bool is_grid) {
  const OptionWords words(state);
  refuse_time_steps(words);
  return render_options(words, is_grid);
}

View first_view(const RenderOptions& options, const Dataset& data) {
  FilmFrame frame;
  frame.size = options.plan.size.value_or(ImageSize{});
  if (!options.plan.cameras.empty()) {
    const CameraFile file = cameras_of(options.plan.cameras.string()).front();
    frame.camera = file.camera;
    if (!options.plan.size && file.size) frame.size = *file.size;
  }
  return {frame.view(data.bounds(), options.projection, options.view, data.body_axes()), frame.size};
}

}  // namespace

ReadOptions State::read_options(DataKind kind) const {
  const OptionWords words(*this);
  refuse_time_steps(words);
  ReadOptions read = tessera::read_options(words, kind == DataKind::grid);
  read.shape = kind == DataKind::mesh && !words.given("transfer-function");
  return read;
}

Dataset State::open(std::span<const std::filesystem::path> files, const Communicator& communicator) const {
  if (files.empty()) throw bad_input("input: no file is named; name one");
  const OptionWords words(*this);
  const RenderOptions options = options_of(*this, is_grid_input(words, InputFile(files.front())));
  return open_for_accuracy(
      options, options.read,
      [&](const ReadOptions& read) { return Dataset::open(files, read, communicator, options.settings.ranks); },
      [&](const Dataset& data) { return api::chosen_function(data, options).function; },
      [&](const Dataset& data) { return first_view(options, data); }, communicator);
}

Settings State::settings(const Dataset& data) const {
  const RenderOptions options = options_of(*this, data.is_grid());
  Settings settings = options.settings;
  const auto& files = StateAccess::of(data).files;
  if (!options.block_surfaces.empty() || data.axis_scale() != glm::dvec3(1)) {
    if (files.empty() && !options.block_surfaces.empty())
      throw bad_input(
          fmt::format("`surface`: '{}' is a block, and data in memory have no blocks; give a file of triangles",
                      options.block_surfaces.front().word));
    settings.surfaces = with_block_surfaces(std::move(settings.surfaces), found_blocks(options.block_surfaces, data),
                                            data, files, options.read);
  }
  if (data.is_grid() && shades_by_default(api::chosen_function(data, options), options))
    settings.grid.shading.emplace();
  return settings;
}

LoadedTransferFunction State::transfer_function(const Dataset& data) const {
  return api::chosen_function(data, options_of(*this, data.is_grid()));
}

View State::view(const Dataset& data) const { return first_view(options_of(*this, data.is_grid()), data); }

Annotation State::annotation(const Dataset& data, int frame) const {
  const auto annotation = options_of(*this, data.is_grid()).annotation.annotation;
  if (!annotation) return {};
  const std::string file = std::filesystem::path(data.source()).filename().string();
  return filled_annotation(*annotation, annotation_values(data, data.time().value_or(0), file, frame));
}

ImageFileOptions State::image_file_options() const { return api::image_options(OptionWords(*this)); }

Dataset open_for_accuracy(const RenderOptions& options, const ReadOptions& read,
                          const std::function<Dataset(const ReadOptions&)>& open,
                          const std::function<TransferFunction(const Dataset&)>& function,
                          const std::function<View(const Dataset&)>& view, const Communicator& communicator) {
  Dataset data = open(read);
  if (!options.higher_order_accuracy || data.higher_order_cells().divided == 0) return data;
  return read_for_accuracy(
             read, options.higher_order_accuracy,
             [&, is_open = true](const ReadOptions& with) mutable {
               const bool is_same = with.higher_order_tolerance == read.higher_order_tolerance;
               return std::exchange(is_open, false) && is_same ? std::move(data) : open(with);
             },
             function, view, options.settings, communicator)
      .dataset;
}

}  // namespace v0_1
}  // namespace tessera
