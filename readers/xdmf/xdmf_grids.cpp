// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_grids.hpp"

#include <fmt/format.h>

#include <XdmfCurvilinearGrid.hpp>
#include <XdmfDomain.hpp>
#include <XdmfGridCollection.hpp>
#include <XdmfGridCollectionType.hpp>
#include <XdmfRectilinearGrid.hpp>
#include <XdmfRegularGrid.hpp>
#include <XdmfTime.hpp>
#include <XdmfUnstructuredGrid.hpp>
#include <algorithm>

#include "readers/xdmf/xdmf_shared.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

using Grid = boost::shared_ptr<XdmfGrid>;

/// Returns all grids in a domain or collection. Xdmf stores them separately by kind.
std::vector<Grid> children_of(XdmfDomain& domain) {
  std::vector<Grid> grids;
  for (unsigned k = 0; k < domain.getNumberUnstructuredGrids(); ++k) grids.push_back(domain.getUnstructuredGrid(k));
  for (unsigned k = 0; k < domain.getNumberRegularGrids(); ++k) grids.push_back(domain.getRegularGrid(k));
  for (unsigned k = 0; k < domain.getNumberRectilinearGrids(); ++k) grids.push_back(domain.getRectilinearGrid(k));
  for (unsigned k = 0; k < domain.getNumberCurvilinearGrids(); ++k) grids.push_back(domain.getCurvilinearGrid(k));
  for (unsigned k = 0; k < domain.getNumberGridCollections(); ++k) grids.push_back(domain.getGridCollection(k));
  return grids;
}

/// Returns the time of a grid, or of the first grid in it that has one.
std::optional<double> time_of(const Grid& grid) {
  if (const auto time = grid->getTime()) return time->getValue();
  if (const auto collection = boost::dynamic_pointer_cast<XdmfGridCollection>(grid))
    for (const Grid& child : children_of(*collection))
      if (const std::optional<double> time = time_of(child)) return time;
  return std::nullopt;
}

/// The steps of a temporal collection, sorted by time if all have one.
struct Steps {
  std::vector<Grid> grids;
  std::vector<double> times;  ///< empty unless all steps have a time
};

Steps steps_of(XdmfGridCollection& collection) {
  Steps steps{children_of(collection), {}};
  std::vector<std::pair<double, Grid>> timed;
  for (const Grid& child : steps.grids)
    if (const std::optional<double> time = time_of(child)) timed.emplace_back(*time, child);
  if (timed.size() != steps.grids.size()) return steps;
  std::stable_sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t k = 0; k < timed.size(); ++k) {
    steps.grids[k] = timed[k].second;
    steps.times.push_back(timed[k].first);
  }
  return steps;
}

bool is_in_time(const XdmfGridCollection& collection) {
  return collection.getType() == XdmfGridCollectionType::Temporal();
}

/// The steps of a domain, which combine those of all its temporal collections.
class Timeline {
 public:
  explicit Timeline(const std::vector<Grid>& grids) {
    for (const Grid& grid : grids) visit(grid);
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
    by_time_ = shortest_ != longest_ && all_timed_;
  }

  [[nodiscard]] std::size_t count() const { return by_time_ ? times_.size() : longest_; }

  /// Returns the times of the steps if all have one; otherwise an empty list.
  [[nodiscard]] std::vector<double> times() const {
    return all_timed_ && times_.size() == count() ? times_ : std::vector<double>();
  }

  /// Returns the grid of a collection at a step; null before the collection's first time.
  [[nodiscard]] Grid at(const Steps& steps, std::size_t step) const {
    if (!by_time_) return steps.grids[std::min(step, steps.grids.size() - 1)];
    const auto later = std::upper_bound(steps.times.begin(), steps.times.end(), times_[step]);
    return later == steps.times.begin() ? Grid()
                                        : steps.grids[static_cast<std::size_t>(later - steps.times.begin()) - 1];
  }

 private:
  void visit(const Grid& grid) {
    const auto collection = boost::dynamic_pointer_cast<XdmfGridCollection>(grid);
    if (collection == nullptr) return;
    if (!is_in_time(*collection)) {
      for (const Grid& child : children_of(*collection)) visit(child);
      return;
    }
    const Steps steps = steps_of(*collection);
    if (steps.grids.empty()) return;
    shortest_ = std::min(shortest_, steps.grids.size()), longest_ = std::max(longest_, steps.grids.size());
    all_timed_ = all_timed_ && !steps.times.empty();
    times_.insert(times_.end(), steps.times.begin(), steps.times.end());
  }

  std::vector<double> times_;
  std::size_t shortest_ = ~std::size_t{0}, longest_ = 0;
  bool all_timed_ = true, by_time_ = false;
};

class Walk {
 public:
  Walk(const Timeline& timeline, std::size_t step) : timeline_(timeline), step_(step) {}

  void visit(const Grid& grid, const std::string& path) {
    const auto collection = boost::dynamic_pointer_cast<XdmfGridCollection>(grid);
    if (collection == nullptr) {
      blocks.push_back({{path}, {grid}});
      return;
    }
    if (!is_in_time(*collection)) {
      for (const Grid& child : children_of(*collection)) visit(child, joined(path, child->getName()));
      return;
    }
    // Grids at different times have different names, so the names of grids in a temporal collection are not used for
    // blocks.
    const Steps steps = steps_of(*collection);
    if (steps.grids.empty()) return;
    if (const Grid chosen = timeline_.at(steps, step_)) visit(chosen, path);
  }

  std::vector<XdmfBlock> blocks;

 private:
  static std::string joined(const std::string& path, const std::string& name) {
    return path.empty() || name.empty() ? path + name : fmt::format("{}/{}", path, name);
  }

  const Timeline& timeline_;
  std::size_t step_;
};

}  // namespace

std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, scene::TimeStepRead& read) {
  const std::vector<Grid> grids = children_of(*domain);
  const Timeline timeline(grids);
  if (timeline.count() == 0 && time_step.value_or(0) > 0)
    throw scene::bad_input(fmt::format(
        "{}: there is no time step {}, because the file has no time steps; leave `time_step` out", source, *time_step));
  read = scene::chosen_step(time_step, timeline.count(), source);
  Walk walk(timeline, read.step);
  for (const Grid& grid : grids) walk.visit(grid, grids.size() > 1 ? grid->getName() : "");
  merge_same_meshes(walk.blocks);
  scene::set_times(read, timeline.times());
  if (timeline.count() == 0)
    for (const Grid& grid : grids)
      if (const auto time = time_of(grid); time && read.times.empty()) read = {1, 0, {*time}};
  return std::move(walk.blocks);
}

}  // namespace tessera::readers
