// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/time_step_read.hpp"

class XdmfDomain;
class XdmfGrid;

namespace tessera::readers {

/// A mesh at one time step: a grid that is not a collection, or several grids that have the same points and cells.
struct XdmfBlock {
  std::vector<std::string> names;                  ///< with the names of enclosing collections: "engine/valve"
  std::vector<boost::shared_ptr<XdmfGrid>> grids;  ///< the first grid has the points and cells; all grids have fields
};

/// Returns the grids of a domain; grids of one mesh are merged. All grids of a spatial collection are used. The grids
/// of one step of a temporal collection are used: `time_step`, counted from 0, or the last step. Steps are sorted by
/// time if all of them have a time. If temporal collections have different lengths, the steps are the union of their
/// times, and each collection has its latest grid at that time. `read` receives the step. Throws Error(bad_input) for a
/// step that does not exist.
std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, scene::TimeStepRead& read);

}  // namespace tessera::readers
