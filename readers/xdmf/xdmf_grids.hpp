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

/// A mesh at one time step: a grid that is not a collection, or several grids with the same points and cells.
struct XdmfBlock {
  std::vector<std::string> names;                  ///< after those of enclosing collections: "engine/valve"
  std::vector<boost::shared_ptr<XdmfGrid>> grids;  ///< points and cells are the first grid's, fields those of all
};

/// The grids of a domain, those of one mesh merged: of spatial collections all; of temporal collections those of one
/// step, counted from 0, or the last. Steps are sorted by time, if all have one. If temporal collections have different
/// lengths, the steps are the union of their times, and each collection shows its latest grid at that time. `read`
/// receives the step. Throws Error(bad_input) for a step that does not exist.
std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, scene::TimeStepRead& read);

}  // namespace tessera::readers
