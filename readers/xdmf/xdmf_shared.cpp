// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_shared.hpp"

#include <XdmfAttribute.hpp>
#include <XdmfCurvilinearGrid.hpp>
#include <XdmfGeometry.hpp>
#include <XdmfGrid.hpp>
#include <XdmfHeavyDataController.hpp>
#include <XdmfRectilinearGrid.hpp>
#include <XdmfRegularGrid.hpp>
#include <XdmfTopology.hpp>
#include <XdmfTopologyType.hpp>
#include <XdmfUnstructuredGrid.hpp>
#include <algorithm>
#include <map>
#include <typeinfo>

namespace tessera::readers {
namespace {

bool is_same(const XdmfArray* a, const XdmfArray* b) {
  if (a == b) return true;
  if (a == nullptr || b == nullptr || a->getReadMode() != XdmfArray::Controller ||
      b->getReadMode() != XdmfArray::Controller)
    return false;
  const unsigned count = a->getNumberHeavyDataControllers();
  if (count == 0 || count != b->getNumberHeavyDataControllers()) return false;
  for (unsigned k = 0; k < count; ++k) {
    const auto one = a->getHeavyDataController(k), other = b->getHeavyDataController(k);
    if (one->getFilePath() != other->getFilePath() || one->getDescriptor() != other->getDescriptor() ||
        one->getDataspaceDescription() != other->getDataspaceDescription())
      return false;
  }
  return true;
}

bool has_same_mesh(XdmfGrid& a, XdmfGrid& b) {
  if (typeid(a) != typeid(b)) return false;
  const std::vector<XdmfArray*> of_a = mesh_arrays(a), of_b = mesh_arrays(b);
  if (of_a.size() != of_b.size() || of_a.empty()) return false;
  for (std::size_t k = 0; k < of_a.size(); ++k)
    if (of_a[k] == nullptr || !is_same(of_a[k], of_b[k])) return false;
  const auto *topology = dynamic_cast<const XdmfTopology*>(of_a.back()),
             *other = dynamic_cast<const XdmfTopology*>(of_b.back());
  return topology == nullptr || other == nullptr || topology->getType()->getID() == other->getType()->getID();
}

/// Whether both grids have, at points or at cells, a field of the same name, but not the same field.
bool has_field_of_same_name(XdmfGrid& a, XdmfGrid& b) {
  for (unsigned k = 0; k < a.getNumberAttributes(); ++k)
    for (unsigned j = 0; j < b.getNumberAttributes(); ++j) {
      const auto one = a.getAttribute(k), other = b.getAttribute(j);
      if (one != other && one->getName() == other->getName() && one->getCenter() == other->getCenter()) return true;
    }
  return false;
}

bool takes(XdmfBlock& block, XdmfBlock& other) {
  if (!has_same_mesh(*block.grids.front(), *other.grids.front())) return false;
  return std::ranges::none_of(block.grids,
                              [&](const auto& grid) { return has_field_of_same_name(*grid, *other.grids.front()); });
}

}  // namespace

std::vector<XdmfArray*> mesh_arrays(XdmfGrid& grid) {
  if (auto* regular = dynamic_cast<XdmfRegularGrid*>(&grid))
    return {regular->getDimensions().get(), regular->getOrigin().get(), regular->getBrickSize().get()};
  if (auto* curvilinear = dynamic_cast<XdmfCurvilinearGrid*>(&grid))
    return {curvilinear->getDimensions().get(), curvilinear->getGeometry().get()};
  std::vector<XdmfArray*> arrays;
  if (auto* rectilinear = dynamic_cast<XdmfRectilinearGrid*>(&grid))
    for (const auto& axis : rectilinear->getCoordinates()) arrays.push_back(axis.get());
  if (auto* unstructured = dynamic_cast<XdmfUnstructuredGrid*>(&grid))
    arrays = {unstructured->getGeometry().get(), unstructured->getTopology().get()};
  return arrays;
}

void merge_same_meshes(std::vector<XdmfBlock>& blocks) {
  std::vector<XdmfBlock> merged;
  for (XdmfBlock& block : blocks) {
    const auto same =
        std::find_if(merged.begin(), merged.end(), [&](XdmfBlock& earlier) { return takes(earlier, block); });
    if (same == merged.end()) {
      merged.push_back(std::move(block));
      continue;
    }
    same->names.insert(same->names.end(), block.names.begin(), block.names.end());
    same->grids.insert(same->grids.end(), block.grids.begin(), block.grids.end());
  }
  blocks = std::move(merged);
}

std::set<const XdmfArray*> shared_arrays(const std::vector<XdmfBlock>& blocks) {
  std::map<const XdmfArray*, int> uses;
  for (const XdmfBlock& block : blocks) {
    for (const XdmfArray* array : mesh_arrays(*block.grids.front())) ++uses[array];
    for (const auto& grid : block.grids)
      for (unsigned k = 0; k < grid->getNumberAttributes(); ++k) ++uses[grid->getAttribute(k).get()];
  }
  std::set<const XdmfArray*> shared;
  for (const auto& [array, count] : uses)
    if (count > 1) shared.insert(array);
  return shared;
}

}  // namespace tessera::readers
