#include "io/helper/xdmf_grids.hpp"

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

#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

using Grid = boost::shared_ptr<XdmfGrid>;

/// All grids in a domain or collection, which Xdmf keeps by their kinds.
std::vector<Grid> children_of(XdmfDomain& domain) {
  std::vector<Grid> grids;
  for (unsigned k = 0; k < domain.getNumberUnstructuredGrids(); ++k) grids.push_back(domain.getUnstructuredGrid(k));
  for (unsigned k = 0; k < domain.getNumberRegularGrids(); ++k) grids.push_back(domain.getRegularGrid(k));
  for (unsigned k = 0; k < domain.getNumberRectilinearGrids(); ++k) grids.push_back(domain.getRectilinearGrid(k));
  for (unsigned k = 0; k < domain.getNumberCurvilinearGrids(); ++k) grids.push_back(domain.getCurvilinearGrid(k));
  for (unsigned k = 0; k < domain.getNumberGridCollections(); ++k) grids.push_back(domain.getGridCollection(k));
  return grids;
}

/// Of the grid, or of the first in it that has one.
std::optional<double> time_of(const Grid& grid) {
  if (const auto time = grid->getTime()) return time->getValue();
  if (const auto collection = boost::dynamic_pointer_cast<XdmfGridCollection>(grid))
    for (const Grid& child : children_of(*collection))
      if (const std::optional<double> time = time_of(child)) return time;
  return std::nullopt;
}

class Walk {
 public:
  Walk(std::optional<std::size_t> wish, const std::string& source) : wish_(wish), source_(source) {}

  void visit(const Grid& grid, const std::string& path) {
    const auto collection = boost::dynamic_pointer_cast<XdmfGridCollection>(grid);
    if (collection == nullptr) {
      blocks.push_back({path, grid});
      return;
    }
    std::vector<Grid> children = children_of(*collection);
    if (collection->getType() == XdmfGridCollectionType::Temporal())
      visit_step(children, path);
    else
      for (const Grid& child : children) visit(child, joined(path, child->getName()));
  }

  static std::string joined(const std::string& path, const std::string& name) {
    return path.empty() || name.empty() ? path + name : fmt::format("{}/{}", path, name);
  }

  std::vector<XdmfBlock> blocks;
  std::size_t steps = 0, step = 0;  ///< 0 steps: there is no collection in time

 private:
  /// Grids that differ in their times have names that do, too: no block is named by them.
  void visit_step(std::vector<Grid>& children, const std::string& path) {
    if (children.empty()) return;
    std::vector<std::pair<double, Grid>> timed;
    for (const Grid& child : children)
      if (const std::optional<double> time = time_of(child)) timed.emplace_back(*time, child);
    if (timed.size() == children.size()) {
      std::stable_sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      for (std::size_t k = 0; k < timed.size(); ++k) children[k] = timed[k].second;
    }
    const std::size_t chosen = wish_.value_or(children.size() - 1);
    if (chosen >= children.size())
      throw scene::bad_input(
          fmt::format("{}: there is no time step {}, the file has {}; count from 0", source_, chosen, children.size()));
    steps = std::max(steps, children.size()), step = chosen;
    visit(children[chosen], path);
  }

  std::optional<std::size_t> wish_;
  const std::string& source_;
};

}  // namespace

std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, TimeStepRead& read) {
  Walk walk(time_step, source);
  const std::vector<Grid> grids = children_of(*domain);
  for (const Grid& grid : grids) walk.visit(grid, grids.size() > 1 ? grid->getName() : "");
  if (walk.steps == 0 && time_step.value_or(0) > 0)
    throw scene::bad_input(
        fmt::format("{}: there is no time step {}, the file has none; leave it out", source, *time_step));
  read = {walk.steps, walk.step};
  return std::move(walk.blocks);
}

}  // namespace tessera::io::helper
