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

/// A mesh at one time step: a grid that is no collection, or several grids of the same points and cells.
struct XdmfBlock {
  std::vector<std::string> names;  ///< with those of the collections around it: "engine/valve"; empty ones of none
  std::vector<boost::shared_ptr<XdmfGrid>> grids;  ///< the points and cells are the first's, fields those of all
};

/// The grids of a domain, those of one mesh together: of collections in space all; of collections in time those of one
/// step, counted from 0, or the last. Steps are in the order of their times, if all have one. Where collections in time
/// differ in length, steps are all their times, and each shows what it has had last by then. `read` says which step it
/// is. Throws Error(bad_input) for a step that there is not.
std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, scene::TimeStepRead& read);

}  // namespace tessera::readers
