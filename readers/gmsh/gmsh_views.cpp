// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_views.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <stdexcept>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// A view in Gmsh's library, without its numbers.
struct KnownView {
  int tag = 0;
  std::string name;
  std::size_t first_step = 0, steps = 0;  ///< first_step: files may count from 1
};

struct ModelData {
  std::string type;
  std::vector<std::size_t> tags;
  std::vector<std::vector<double>> values;
  int components = 0;
  double time = 0;
};

/// Returns the data of a view at a step. No value for lists of shapes, which have no mesh, and for a step without data.
std::optional<ModelData> data_of(int tag, std::size_t step) {
  ModelData data;
  try {
    gmsh::view::getModelData(tag, static_cast<int>(step), data.type, data.tags, data.values, data.time,
                             data.components);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {  // Gmsh throws objects of any type
    return std::nullopt;
  }
  if (data.tags.empty() || data.values.size() != data.tags.size() || data.components < 1) return std::nullopt;
  return data;
}

std::vector<KnownView> known_views() {
  std::vector<int> tags;
  gmsh::view::getTags(tags);
  std::vector<KnownView> views;
  for (std::size_t k = 0; k < tags.size(); ++k) {
    KnownView view{tags[k], {}, 0, 0};
    double steps = 0;
    gmsh::option::getNumber(fmt::format("View[{}].NbTimeStep", k), steps);
    gmsh::option::getString(fmt::format("View[{}].Name", k), view.name);
    if (view.name.find_first_not_of(' ') == std::string::npos) view.name = fmt::format("view {}", k + 1);
    if (steps >= 1) view.steps = static_cast<std::size_t>(steps);
    while (view.steps > 1 && !data_of(view.tag, view.first_step)) ++view.first_step, --view.steps;
    views.push_back(std::move(view));
  }
  return views;
}

std::optional<GmshView> view_of(const KnownView& known, std::size_t step) {
  std::optional<ModelData> data = data_of(known.tag, known.first_step + std::min(step, known.steps - 1));
  if (!data) return std::nullopt;
  GmshView view;
  view.name = known.name;
  view.components = static_cast<std::size_t>(data->components);
  view.places = TagIndex(data->tags);
  if (data->type == "ElementNodeData") {
    view.of = GmshView::Of::element_nodes;
    view.node_values = std::move(data->values);
    return view;
  }
  if (data->type != "NodeData" && data->type != "ElementData") return std::nullopt;
  view.of = data->type == "NodeData" ? GmshView::Of::nodes : GmshView::Of::elements;
  view.values.reserve(data->tags.size() * view.components);
  for (const std::vector<double>& value : data->values) {
    if (value.size() < view.components) return std::nullopt;
    view.values.insert(view.values.end(), value.begin(), value.begin() + data->components);
  }
  return view;
}

/// Returns the times of the first view that has `steps` steps.
std::vector<double> times_of(const std::vector<KnownView>& views, std::size_t steps) {
  std::vector<double> times;
  const auto longest = std::ranges::find(views, steps, &KnownView::steps);
  for (std::size_t step = 0; longest != views.end() && step < steps; ++step)
    if (const auto data = data_of(longest->tag, longest->first_step + step)) times.push_back(data->time);
  return times;
}

}  // namespace

TagIndex::TagIndex(const std::vector<std::size_t>& tags) {
  if (tags.empty()) return;
  const std::size_t largest = *std::max_element(tags.begin(), tags.end());
  if (largest / 4 <= tags.size()) {
    places_.assign(largest + 1, none);
    for (std::size_t k = tags.size(); k-- > 0;) places_[tags[k]] = k;
    return;
  }
  sorted_.reserve(tags.size());
  for (std::size_t k = 0; k < tags.size(); ++k) sorted_.emplace_back(tags[k], k);
  std::sort(sorted_.begin(), sorted_.end());
}

std::size_t TagIndex::find(std::size_t tag) const {
  if (sorted_.empty()) return tag < places_.size() ? places_[tag] : none;
  const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, std::size_t{0}));
  return found == sorted_.end() || found->first != tag ? none : found->second;
}

std::vector<GmshView> gmsh_views(std::optional<std::size_t> time_step, const std::string& source,
                                 std::vector<std::string>& notes, scene::TimeStepRead& read) {
  const std::vector<KnownView> known = known_views();
  std::size_t steps = 0;
  for (const KnownView& view : known) steps = std::max(steps, view.steps);
  read = scene::chosen_step(time_step, steps, source);
  if (steps > 1) scene::set_times(read, times_of(known, steps));
  const std::size_t step = read.step;
  std::vector<GmshView> views;
  for (const KnownView& each : known) {
    if (each.steps > 1 && step >= each.steps) continue;  // the view has fewer steps
    std::optional<GmshView> view = each.steps > 0 ? view_of(each, step) : std::nullopt;
    if (view)
      views.push_back(std::move(*view));
    else
      notes.push_back(fmt::format("the view '{}' is not a field of the mesh and is left out", each.name));
  }
  return views;
}

}  // namespace tessera::readers
