// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-xdmf: reads XDMF by its own library, as tessera-read-vtk does for other formats. A separate program,
// because that library uses another build of HDF5, for MPI, than VTK's.
#include <fmt/format.h>

#include <XdmfAttribute.hpp>
#include <XdmfAttributeCenter.hpp>
#include <XdmfCurvilinearGrid.hpp>
#include <XdmfDomain.hpp>
#include <XdmfError.hpp>
#include <XdmfGeometry.hpp>
#include <XdmfGeometryType.hpp>
#include <XdmfReader.hpp>
#include <XdmfRectilinearGrid.hpp>
#include <XdmfRegularGrid.hpp>
#include <XdmfTopology.hpp>
#include <XdmfUnstructuredGrid.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cells/block_choice.hpp"
#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/xdmf/xdmf_arrays.hpp"
#include "readers/xdmf/xdmf_cells.hpp"
#include "readers/xdmf/xdmf_elements.hpp"
#include "readers/xdmf/xdmf_grids.hpp"
#include "readers/xdmf/xdmf_references.hpp"
#include "readers/xdmf/xdmf_rewritten.hpp"
#include "readers/xdmf/xdmf_shared.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

constexpr const char* finite_element_function = "FiniteElementFunction";

/// Returns the numbers of points or cells along x, y and z, given dimensions in the reverse order.
std::array<std::int64_t, 3> sizes_of(XdmfArray& dimensions, const std::string& where) {
  const std::vector<double> numbers = doubles_of(dimensions);
  if (numbers.size() != 3)
    throw scene::bad_input(
        fmt::format("{}: it is a grid of {} dimensions, not a volume; give one of three", where, numbers.size()));
  std::array<std::int64_t, 3> sizes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = numbers[2 - axis];
    if (!(n >= 1 && n <= 2147483647.0))
      throw scene::bad_input(fmt::format(
          "{}: an axis has {} points, not a whole number from 1 to 2147483647; write the file again", where, n));
    sizes[axis] = static_cast<std::int64_t>(n);
  }
  return sizes;
}

void set_extent(XdmfArray& dimensions, io::ForeignPart& part, const std::string& where) {
  const auto sizes = sizes_of(dimensions, where);
  for (std::size_t axis = 0; axis < 3; ++axis) part.extent[2 * axis + 1] = sizes[axis] - 1;
}

io::ForeignArray hold_points(Holdings& holdings, XdmfGeometry& geometry, const std::string& where, bool is_kept) {
  if (geometry.getType() != XdmfGeometryType::XYZ())
    throw scene::bad_input(fmt::format("{}: its points are given as {}, not as x y z; write them as x y z", where,
                                       geometry.getType()->getName()));
  return hold_xdmf(holdings, geometry, "", 3, is_kept);
}

/// Values that all blocks share.
struct Reading {
  Holdings& holdings;
  bool headers_only;
  const std::string& source;
  std::set<const XdmfArray*> shared;  ///< arrays that several blocks use
  std::vector<std::string>& notes;
};

/// Reads one block, which gets the given name.
class PartOf {
 public:
  PartOf(Reading& reading, const XdmfBlock& block, const std::string& name)
      : reading_(reading),
        holdings_(reading.holdings),
        headers_only_(reading.headers_only),
        where_(name.empty() ? reading.source : fmt::format("{}: block '{}'", reading.source, name)) {
    part.name = name;
    XdmfGrid* const grid = block.grids.front().get();
    if (auto* regular = dynamic_cast<XdmfRegularGrid*>(grid)) {
      set(*regular);
    } else if (auto* rectilinear = dynamic_cast<XdmfRectilinearGrid*>(grid)) {
      set(*rectilinear);
    } else if (auto* curvilinear = dynamic_cast<XdmfCurvilinearGrid*>(grid)) {
      part.kind = io::ForeignPart::Kind::structured;
      if (headers_only_) return;
      set_extent(*curvilinear->getDimensions(), part, where_);
      part.points = hold_points(holdings_, *curvilinear->getGeometry(), where_, is_shared(*curvilinear->getGeometry()));
    } else if (auto* unstructured = dynamic_cast<XdmfUnstructuredGrid*>(grid)) {
      if (!headers_only_) set(*unstructured);
    } else {
      throw scene::bad_input(fmt::format("{}: it is a grid of an unknown kind; write the file again", where_));
    }
    for (const auto& each : block.grids)
      if (!headers_only_) add_attributes(*each);
  }

  io::ForeignPart part;

 private:
  [[nodiscard]] bool is_shared(const XdmfArray& array) const { return reading_.shared.contains(&array); }

  void set(XdmfRegularGrid& grid) {
    part.kind = io::ForeignPart::Kind::image;
    if (headers_only_) return;
    set_extent(*grid.getDimensions(), part, where_);
    const std::vector<double> origin = doubles_of(*grid.getOrigin()), steps = doubles_of(*grid.getBrickSize());
    if (origin.size() != 3 || steps.size() != 3)
      throw scene::bad_input(
          fmt::format("{}: its origin or spacing does not have three numbers; write the file again", where_));
    for (std::size_t axis = 0; axis < 3; ++axis)
      part.origin[axis] = origin[2 - axis], part.spacing[axis] = steps[2 - axis];
    part.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  }

  void set(XdmfRectilinearGrid& grid) {
    part.kind = io::ForeignPart::Kind::rectilinear;
    if (headers_only_) return;
    const auto axes = grid.getCoordinates();
    if (axes.size() != 3)
      throw scene::bad_input(
          fmt::format("{}: it is a grid of {} dimensions, not a volume; give one of three", where_, axes.size()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part.coordinates.push_back(hold_xdmf(holdings_, *axes[axis], "", 1, is_shared(*axes[axis])));
      part.extent[2 * axis + 1] = static_cast<std::int64_t>(part.coordinates.back().tuples) - 1;
    }
  }

  void set(XdmfUnstructuredGrid& grid) {
    part.points = hold_points(holdings_, *grid.getGeometry(), where_, is_shared(*grid.getGeometry()));
    XdmfTopology& topology = *grid.getTopology();
    read_numbers(topology);
    XdmfCells cells = cells_of(topology, where_);
    if (!is_shared(topology)) topology.release();
    part.types = hold_vector(holdings_, {.type = NumberType::uint8}, std::move(cells.types));
    part.offsets = hold_vector(holdings_, {.type = NumberType::uint64}, std::move(cells.offsets));
    part.connectivity = hold_vector(holdings_, {.type = NumberType::uint32}, std::move(cells.connectivity));
  }

  [[nodiscard]] std::uint64_t count_of(bool points) const {
    if (part.kind == io::ForeignPart::Kind::unstructured) return points ? part.points->tuples : part.types->tuples;
    std::uint64_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto last = static_cast<std::uint64_t>(part.extent[2 * axis + 1]);
      count *= points ? last + 1 : std::max<std::uint64_t>(last, 1);
    }
    return count;
  }

  void add_attributes(XdmfGrid& grid) {
    for (unsigned k = 0; k < grid.getNumberAttributes(); ++k) {
      XdmfAttribute& attribute = *grid.getAttribute(k);
      if (!taken_.insert(&attribute).second) continue;
      if (attribute.getItemType() == finite_element_function) {
        reading_.notes.push_back(note_on_function(attribute));
        continue;
      }
      const bool is_node = attribute.getCenter() == XdmfAttributeCenter::Node();
      if (!is_node && attribute.getCenter() != XdmfAttributeCenter::Cell()) continue;
      const std::string name = attribute.getName().empty() ? fmt::format("attribute{}", k) : attribute.getName();
      read_numbers(attribute);
      const std::uint64_t count = count_of(is_node), values = attribute.getSize();
      if (count == 0 || values == 0) continue;
      if (values % count != 0 || values / count > 1024)
        throw scene::bad_input(fmt::format("{}: field '{}' has {} values for {} {}; write the file again", where_, name,
                                           values, count, is_node ? "points" : "cells"));
      (is_node ? part.point_fields : part.cell_fields)
          .push_back(hold_xdmf(holdings_, attribute, name, static_cast<int>(values / count), is_shared(attribute)));
    }
  }

  /// Returns a note about an attribute whose values belong to degrees of freedom, not to points or cells of the file.
  static std::string note_on_function(const XdmfAttribute& function) {
    std::string family = function.getElementFamily();
    if (family.empty()) family = "some";
    return fmt::format(
        "the field '{}' is a finite-element function ({} of degree {}) and is left out: these are not "
        "supported; write its values at points or cells (FEniCS: write instead of write_checkpoint)",
        function.getName(), family, function.getElementDegree());
  }

  Reading& reading_;
  Holdings& holdings_;
  bool headers_only_;
  std::string where_;
  std::set<const XdmfAttribute*> taken_;
};

/// Adds the files of every array that PartOf reads.
void add_arrays(XdmfGrid& grid, XdmfHeavyFiles& files) {
  for (XdmfArray* const array : mesh_arrays(grid))
    if (array != nullptr) files.add(*array);
  for (unsigned k = 0; k < grid.getNumberAttributes(); ++k) files.add(*grid.getAttribute(k));
}

/// Returns the name by which a block is chosen; no value if it is not chosen.
std::optional<std::string> chosen_name(const XdmfBlock& block, const cells::BlockChoice& choice) {
  for (const std::string& name : block.names)
    if (cells::is_chosen(choice, name)) return name;
  return std::nullopt;
}

io::ForeignContents read(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string();
  allow_for(file);
  const bool is_plain = check_xdmf_elements(file) == XdmfText::plain;
  add_cell_names();
  const auto reader = XdmfReader::New();
  XdmfHeavyFiles files(file);
  // The library splits file names, which fails for the names of files without a name. If it parses a text instead of a
  // file, file names in the text are relative to the current directory, which is therefore changed.
  const CurrentFolder current(io::is_inflated(file) || is_plain ? std::filesystem::path() : file.parent_path());
  const auto domain = boost::dynamic_pointer_cast<XdmfDomain>(
      !is_plain               ? reader->parse(rewritten_xdmf(file))
      : io::is_inflated(file) ? reader->parse(io::read_beginning(file, io::require_file(file)))
                              : reader->read(source));
  if (domain == nullptr) throw scene::bad_input(fmt::format("{}: it has no <Domain>; write the file again", source));
  std::optional<std::size_t> time_step;
  const bool headers_only = request.value("look", false);
  if (const auto step = request.find("time_step"); step != request.end()) time_step = step->get<std::size_t>();
  io::ForeignContents contents;
  contents.format = "XDMF";
  std::vector<XdmfBlock> blocks = blocks_at(domain, time_step, source, contents.time_step);
  if (blocks.empty()) throw scene::bad_input(fmt::format("{}: it holds no grid; give a mesh or a volume", source));
  if (blocks.size() == 1) blocks.front().names = {""};
  for (const XdmfBlock& block : blocks)
    contents.block_names.insert(contents.block_names.end(), block.names.begin(), block.names.end());
  const auto choice = request.value("blocks", cells::BlockChoice());
  std::erase_if(blocks, [&](const XdmfBlock& block) { return !chosen_name(block, choice); });
  for (const XdmfBlock& block : blocks)
    for (const auto& grid : block.grids) add_arrays(*grid, files);
  files.allow();
  Reading reading{holdings, headers_only, source, shared_arrays(blocks), contents.notes};
  for (const XdmfBlock& block : blocks) {
    contents.parts.push_back(std::move(PartOf(reading, block, *chosen_name(block, choice)).part));
    report_progress(static_cast<double>(contents.parts.size()) / static_cast<double>(blocks.size()));
  }
  return contents;
}

io::ForeignContents read_xdmf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  try {
    return read(holdings, file, request);
  } catch (const XdmfError& error) {
    throw scene::bad_input(
        fmt::format("{}: Xdmf's library reports {}; the file or its data are damaged, write it again", file.string(),
                    printable_ascii(std::string_view(error.what()).substr(0, 160))));
  }
}

}  // namespace
}  // namespace tessera::readers

int main() {
  using namespace tessera::readers;
  constexpr Reader readers[] = {{"xdmf", read_xdmf}};
  serve(readers);
}
