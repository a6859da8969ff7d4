// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/hdf5/vtk_hdf_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "readers/common/serve.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// A range of tuples of an array.
struct Stretch {
  std::size_t first = 0, count = 0;
  [[nodiscard]] std::size_t end() const { return first + count; }
};

/// One part of the mesh at a step, given by the ranges of its tuples in the arrays that all parts and steps share.
struct Part {
  Stretch points, cells, connectivity, offsets;
  std::size_t points_before = 0, cells_before = 0;  ///< counts in the previous parts of the step
};

class HdfMesh {
 public:
  HdfMesh(Holdings& holdings, const Hdf5File& file, const std::string& source)
      : holdings_(holdings), file_(file), source_(source), arrays_(file.arrays("VTKHDF")) {}

  io::ForeignContents read(const nlohmann::json& request) {
    io::ForeignContents contents;
    contents.format = "VTKHDF";
    contents.block_names.emplace_back();
    const auto times = static_cast<long>(numbers("Steps/Values").size());
    const long steps = std::max(file_.number_of("VTKHDF/Steps", "NSteps", times), 0L);
    const auto requested = request.find("time_step");
    contents.time_step =
        scene::chosen_step(requested == request.end() ? std::nullopt : std::optional(requested->get<std::size_t>()),
                           static_cast<std::uint64_t>(steps), source_);
    if (steps > 0) {
      step_ = contents.time_step.step;
      scene::set_times(contents.time_step, numbers("Steps/Values"));
    }
    const std::vector<Part> parts = parts_of_step();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      contents.parts.push_back(read_part(parts[p], p == 0 ? &contents.notes : nullptr));
      report_progress(static_cast<double>(p + 1) / static_cast<double>(parts.size()));
    }
    return contents;
  }

 private:
  [[nodiscard]] scene::Error wrong(const std::string& what) const {
    return scene::bad_input(fmt::format("{}: VTKHDF: {}; the file is damaged, export it again", source_, what));
  }

  [[nodiscard]] const Hdf5Array* find(const std::string& name) const {
    const auto found = std::ranges::find(arrays_, fmt::format("VTKHDF/{}", name), &Hdf5Array::path);
    return found == arrays_.end() ? nullptr : &*found;
  }

  [[nodiscard]] const Hdf5Array& need(const std::string& name, std::size_t rank) const {
    const Hdf5Array* const array = find(name);
    if (array == nullptr || array->lengths.size() != rank)
      throw wrong(fmt::format("it has no array '{}' of {} dimension{}", name, rank, rank == 1 ? "" : "s"));
    return *array;
  }

  /// Reads all numbers of a one-dimensional array; empty if it is missing.
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const {
    const Hdf5Array* const array = find(name);
    if (array == nullptr || array->lengths.size() != 1) return {};
    const std::array<std::size_t, 1> first = {0};
    return file_.read(*array, first, array->lengths).as_doubles();
  }

  [[nodiscard]] std::size_t count_from(double number, const std::string& name) const {
    if (!(number >= 0) || number > 0x1p52) throw wrong(fmt::format("'{}' has {}, not a count", name, number));
    return static_cast<std::size_t>(number);
  }

  /// Reads the first number of the step's row; no value if there are no steps or the array is missing.
  [[nodiscard]] std::optional<std::size_t> at_step(const std::string& name) const {
    const Hdf5Array* const array = step_ ? find(name) : nullptr;
    if (array == nullptr) return std::nullopt;
    if (array->lengths[0] <= *step_) throw wrong(fmt::format("'{}' has no number for step {}", name, *step_));
    std::vector<std::size_t> first(array->lengths.size(), 0), counts(array->lengths.size(), 1);
    first[0] = *step_;
    return count_from(file_.read(*array, first, counts).as_doubles().front(), name);
  }

  /// Returns the range of the step's parts among the parts of all steps.
  [[nodiscard]] Stretch part_numbers(std::size_t all) const {
    if (!step_) return {0, all};
    const std::size_t first = at_step("Steps/PartOffsets").value_or(0);
    if (const auto count = at_step("Steps/NumberOfParts")) return {first, *count};
    // If each step has separate parts, all steps have the same number of parts.
    const std::vector<double> offsets = numbers("Steps/PartOffsets");
    return {first, all / std::max<std::size_t>(std::set<double>(offsets.begin(), offsets.end()).size(), 1)};
  }

  [[nodiscard]] std::vector<Part> parts_of_step() const {
    const std::array<const char*, 3> names = {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"};
    std::array<std::vector<double>, 3> counts;
    for (std::size_t k = 0; k < 3; ++k) counts[k] = numbers(names[k]);
    if (counts[0].size() != counts[1].size() || counts[0].size() != counts[2].size())
      throw wrong("some of its parts have no number of points, cells or connectivity ids");
    const Stretch chosen = part_numbers(counts[0].size());
    if (chosen.end() > counts[0].size() || chosen.end() < chosen.first)
      throw wrong(fmt::format("its step {} has parts up to {}, but there are only {}", step_.value_or(0), chosen.end(),
                              counts[0].size()));
    std::size_t points = at_step("Steps/PointOffsets").value_or(0), cells = at_step("Steps/CellOffsets").value_or(0),
                uses = at_step("Steps/ConnectivityIdOffsets").value_or(0), offsets = cells + chosen.first;
    const std::size_t first_point = points, first_cell = cells;
    std::vector<Part> parts;
    for (std::size_t p = chosen.first; p < chosen.end(); ++p) {
      Part part;
      part.points_before = points - first_point, part.cells_before = cells - first_cell;
      part.points = {points, count_from(counts[0][p], names[0])};
      part.cells = {cells, count_from(counts[1][p], names[1])};
      part.connectivity = {uses, count_from(counts[2][p], names[2])};
      part.offsets = {offsets, part.cells.count + 1};
      points = part.points.end(), cells = part.cells.end(), uses = part.connectivity.end(),
      offsets = part.offsets.end();
      parts.push_back(part);
    }
    return parts;
  }

  [[nodiscard]] GridNumbers read(const Hdf5Array& array, const Stretch& tuples) const {
    if (tuples.end() > array.lengths[0])
      throw wrong(fmt::format("{} has {} tuples, not the requested {} to {}", quote(array.path), array.lengths[0],
                              tuples.first, tuples.end()));
    std::vector<std::size_t> first(array.lengths.size(), 0), counts = array.lengths;
    first[0] = tuples.first, counts[0] = tuples.count;
    if (tuples.count == 0) return {array.type, {}};
    return file_.read(array, first, counts);
  }

  template <class T>
  [[nodiscard]] std::vector<T> whole(const std::string& name, const Stretch& tuples) const {
    const std::vector<double> values = read(need(name, 1), tuples).as_doubles();
    std::vector<T> numbers;
    numbers.reserve(values.size());
    for (const double value : values) {
      constexpr double most = static_cast<double>(std::numeric_limits<T>::max());
      numbers.push_back(value >= 0 && value < most ? static_cast<T>(value) : std::numeric_limits<T>::max());
    }
    return numbers;
  }

  io::ForeignPart read_part(const Part& from, std::vector<std::string>* notes) const {
    io::ForeignPart part;
    const Hdf5Array& points = need("Points", 2);
    if (points.lengths[1] != 3) throw wrong("its points do not have three coordinates");
    part.points = hold_numbers(holdings_, read(points, from.points), 3);
    part.types = hold_vector(holdings_, {.type = NumberType::uint8}, whole<std::uint8_t>("Types", from.cells));
    part.offsets = hold_vector(holdings_, {.type = NumberType::uint64}, whole<std::uint64_t>("Offsets", from.offsets));
    part.connectivity =
        hold_vector(holdings_, {.type = NumberType::uint32}, whole<std::uint32_t>("Connectivity", from.connectivity));
    part.point_fields = fields("PointData", from.points, from.points_before, notes);
    part.cell_fields = fields("CellData", from.cells, from.cells_before, notes);
    return part;
  }

  /// Adds fields. In an array, a step may begin at another index than the step's points and cells.
  [[nodiscard]] std::vector<io::ForeignArray> fields(const std::string& kind, const Stretch& tuples, std::size_t before,
                                                     std::vector<std::string>* notes) const {
    const std::string group = fmt::format("VTKHDF/{}/", kind), active = file_.text_of(group.c_str(), "Scalars");
    std::vector<io::ForeignArray> fields;
    for (const Hdf5Array& array : arrays_) {
      if (!array.path.starts_with(group)) continue;
      const std::string name = array.path.substr(group.size());
      const std::size_t components = array.lengths.size() == 2 ? array.lengths[1] : 1;
      if (array.lengths.size() > 2 || components < 1 || components > 1000) {
        if (notes != nullptr)
          notes->push_back(
              fmt::format("{} is left out: its dimensions are {}", quote(name), fmt::join(array.lengths, " x ")));
        continue;
      }
      Stretch own = tuples;
      if (const auto first = at_step(fmt::format("Steps/{}Offsets/{}", kind, name))) own.first = *first + before;
      fields.push_back(hold_field_numbers(holdings_, name, read(array, own), static_cast<int>(components)));
      fields.back().active = name == active;
    }
    return fields;
  }

  Holdings& holdings_;
  const Hdf5File& file_;
  const std::string& source_;
  std::vector<Hdf5Array> arrays_;
  std::optional<std::size_t> step_;  ///< set if the file has steps
};

}  // namespace

io::ForeignContents read_vtk_hdf_mesh(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                      const nlohmann::json& request) {
  return HdfMesh(holdings, file, source).read(request);
}

}  // namespace tessera::readers
