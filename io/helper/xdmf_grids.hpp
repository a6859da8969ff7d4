#pragma once

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/time_step_read.hpp"

class XdmfDomain;
class XdmfGrid;

namespace tessera::io::helper {

/// A grid of one time step, which is no collection.
struct XdmfBlock {
  std::string name;  ///< with those of the collections around it: "engine/valve"; empty if it has none
  boost::shared_ptr<XdmfGrid> grid;
};

/// The grids of a domain: of collections in space all; of collections in time those of one step, counted from 0, or the
/// last. Steps are in the order of their times, if all have one. `read` says which step it is. Throws
/// Error(bad_input) for a step that there is not.
std::vector<XdmfBlock> blocks_at(const boost::shared_ptr<XdmfDomain>& domain, std::optional<std::size_t> time_step,
                                 const std::string& source, TimeStepRead& read);

}  // namespace tessera::io::helper
