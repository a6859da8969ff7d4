// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <vtk_exodusII.h>
#include <vtk_netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cells/block_choice.hpp"
#include "cells/mesh_blocks.hpp"
#include "cells/tuple_length.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/vtk/exodus_elements.hpp"
#include "readers/vtk/exodus_faces.hpp"
#include "readers/vtk/exodus_sets.hpp"
#include "readers/vtk/netcdf/netcdf_size.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// An open file. Every call that fails throws Error.
class ExodusFile {
 public:
  explicit ExodusFile(const std::filesystem::path& file) : source_(file.string()) {
    // ex_open prints a message if NetCDF cannot open the file, so the file is opened by NetCDF first.
    if (nc_open(file.c_str(), NC_NOWRITE, &id_) != NC_NOERR) {
      id_ = -1;
      fail("it cannot be opened as a NetCDF file, which Exodus files are");
    }
    const std::uint64_t least = least_netcdf_bytes(id_), size = io::require_file(file);
    nc_close(id_);
    if (size < least) {
      id_ = -1;
      fail(fmt::format("it has {} bytes, but needs at least {}", size, least));
    }
    ex_opts(0);  // makes the library print no messages
    int double_size = sizeof(double), file_size = 0;
    float version = 0;
    id_ = ex_open(file.c_str(), EX_READ, &double_size, &file_size, &version);
    if (id_ < 0) fail("it cannot be opened as an Exodus file");
    ex_set_int64_status(id_, EX_ALL_INT64_API);
    ex_set_max_name_length(id_, max_name);
  }
  ~ExodusFile() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  [[nodiscard]] int id() const { return id_; }

  void require(int status, const char* what) const {
    if (status < 0) fail(fmt::format("{} cannot be read", what));
  }
  /// Called for functions that do not set anything if they return a warning.
  void require_values(int status, const char* what) const { require(status == EX_NOERR ? status : EX_FATAL, what); }

  /// Returns the array of a nodal variable. Needed because without the attribute `file_size`, which meshio omits, the
  /// library searches for one array of all variables, and finds none.
  [[nodiscard]] std::optional<int> node_array(int index) const {
    int array = 0, axes = 0;
    if (nc_inq_varid(id_, "vals_nod_var", &array) == NC_NOERR ||
        nc_inq_varid(id_, fmt::format("vals_nod_var{}", index).c_str(), &array) != NC_NOERR ||
        nc_inq_varndims(id_, array, &axes) != NC_NOERR || axes < 2)
      return std::nullopt;
    return array;
  }
  /// Returns the number of values per node.
  [[nodiscard]] std::size_t numbers_a_node(int index) const {
    std::array<int, NC_MAX_VAR_DIMS> axes{};
    int count = 0;
    const auto array = node_array(index);
    if (!array || nc_inq_varndims(id_, *array, &count) != NC_NOERR ||
        nc_inq_vardimid(id_, *array, axes.data()) != NC_NOERR)
      return 1;
    std::size_t numbers = 1, length = 0;
    for (const int axis : std::span(axes).first(static_cast<std::size_t>(count)).subspan(2))
      if (nc_inq_dimlen(id_, axis, &length) == NC_NOERR) numbers *= length;
    return numbers;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it again", source_, what));
  }

  /// Returns the names of the variables of nodes or elements, without trailing blanks.
  [[nodiscard]] std::vector<std::string> variable_names(ex_entity_type type) const {
    int count = 0;
    if (ex_get_variable_param(id_, type, &count) < 0 || count < 0 || count > 100000) return {};
    std::vector<std::string> names;
    for (int k = 1; k <= count; ++k) {
      std::array<char, max_name + 1> name{};
      require(ex_get_variable_name(id_, type, k, name.data()), "a variable's name");
      const std::string_view text(name.data(), ::strnlen(name.data(), max_name));
      const std::size_t length = text.find_last_not_of(ascii_blanks) + 1;
      names.push_back(length == 0 ? fmt::format("variable{}", k) : printable_ascii(text.substr(0, length)));
    }
    return names;
  }

 private:
  static constexpr int max_name = 255;
  std::string source_;
  int id_ = -1;
};

struct ElementBlock {
  std::int64_t id = 0;
  std::uint64_t first = 0, count = 0;  ///< cells of the mesh that are from this block
  std::vector<std::uint64_t> of{};     ///< their indices in the block, ascending; empty: all
};

/// One variable, or three that form a vector.
struct Variable {
  std::string name;
  std::vector<int> indices;  ///< indices of the variables in the file, from 1
};

/// Groups names like "V_x" "V_y" "V_z" and "VX" "VY" "VZ" to vectors: three names that differ only in their last
/// letter. If the names may be part of a tensor, like "Sxx" "Sxy" "Sxz", they must be adjacent.
std::vector<Variable> group_vectors(const std::vector<std::string>& names) {
  const auto with_last = [](std::string name, char letter) {
    name.back() = letter;
    return name;
  };
  const auto last_of = [](const std::string& name) { return name.size() < 2 ? ' ' : lower_case(name.back()); };
  std::map<std::string, std::size_t> places;  // index of each name, with the last letter in lower case
  for (std::size_t k = 0; k < names.size(); ++k) places.emplace(with_last(names[k], last_of(names[k])), k);
  std::vector<Variable> variables;
  std::vector<bool> is_used(names.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (is_used[k]) continue;
    std::vector<int> parts;
    std::string name = names[k];
    if (const char last = last_of(name); last >= 'x' && last <= 'z')
      for (const char axis : {'x', 'y', 'z'})
        if (const auto at = places.find(with_last(name, axis)); at != places.end() && !is_used[at->second])
          parts.push_back(static_cast<int>(at->second) + 1);
    name.pop_back();
    const char before = last_of(name);
    const bool may_be_tensor = before >= 'x' && before <= 'z';
    if (parts.size() == 3 && (!may_be_tensor || (parts[1] == parts[0] + 1 && parts[2] == parts[0] + 2))) {
      for (const int part : parts) is_used[static_cast<std::size_t>(part) - 1] = true;
      if (name.size() > 1 && name.back() == '_') name.pop_back();
      variables.push_back({name, parts});
    } else {
      variables.push_back({names[k], {static_cast<int>(k) + 1}});
    }
  }
  return variables;
}

/// Reads `n` values of one variable from entity `first` on, as doubles.
void read_values(const ExodusFile& file, int step, ex_entity_type type, int index, std::int64_t block,
                 std::uint64_t first, std::span<double> out) {
  if (out.empty()) return;
  if (const auto array = type == EX_NODAL ? file.node_array(index) : std::nullopt) {
    std::array<std::size_t, NC_MAX_VAR_DIMS> from{static_cast<std::size_t>(step) - 1, first}, count;
    count.fill(1), count[1] = out.size();
    file.require_values(nc_get_vara_double(file.id(), *array, from.data(), count.data(), out.data()), "a variable");
    return;
  }
  file.require_values(ex_get_partial_var(file.id(), step, type, index, block, static_cast<std::int64_t>(first) + 1,
                                         static_cast<std::int64_t>(out.size()), out.data()),
                      "a variable");
}

/// Reads values of element blocks at cells [first, first + out.size()); NaN in blocks that do not have the variable.
void read_cell_values(const ExodusFile& file, int step, int index, std::span<const ElementBlock> blocks,
                      std::span<const int> has_variable, std::uint64_t first, std::span<double> out) {
  std::fill(out.begin(), out.end(), nan);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::uint64_t low = std::max(first, blocks[b].first),
                        high = std::min(first + out.size(), blocks[b].first + blocks[b].count);
    if (low >= high || !has_variable[b]) continue;
    const std::uint64_t from = low - blocks[b].first, to = high - blocks[b].first;
    const std::span<double> values = out.subspan(low - first, high - low);
    const std::vector<std::uint64_t>& of = blocks[b].of;
    if (of.empty()) {
      read_values(file, step, EX_ELEM_BLOCK, index, blocks[b].id, from, values);
      continue;
    }
    std::vector<double> all(of[to - 1] - of[from] + 1);
    read_values(file, step, EX_ELEM_BLOCK, index, blocks[b].id, of[from], all);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = all[of[from + k] - of[from]];
  }
}

/// Converts a function that reads the values of one variable to a field's function that reads components and magnitude.
template <class ReadOne>
cells::BlockField make_field(const Variable& variable, scene::Association association, std::size_t tuples,
                             ReadOne read_one) {
  cells::BlockField field;
  field.name = variable.name;
  field.association = association;
  field.components = static_cast<int>(variable.indices.size());
  field.type = "double";
  field.tuples = tuples;
  field.read = [indices = variable.indices, read_one](int component, std::size_t first, std::span<double> out) {
    if (component != cells::magnitude) {
      read_one(indices[static_cast<std::size_t>(component)], first, out);
      return;
    }
    const std::size_t n = out.size(), components = indices.size();
    std::vector<double> planes(n * components), tuple(components);
    for (std::size_t c = 0; c < components; ++c) read_one(indices[c], first, std::span(planes).subspan(c * n, n));
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < components; ++c) tuple[c] = planes[c * n + k];
      out[k] = cells::tuple_length(tuple.data(), static_cast<int>(components));
    }
  };
  return field;
}

/// Reads one file. This is a class so that the steps of reading share the open file and the counts.
class Reading {
 public:
  Reading(const std::filesystem::path& path, std::optional<std::size_t> time_step, cells::BlockChoice choice,
          bool with_surfaces)
      : source_(path.string()),
        choice_(std::move(choice)),
        with_surfaces_(with_surfaces),
        file_(std::make_shared<ExodusFile>(path)),
        // In compressed HDF5, a value may take less than a byte. NetCDF classic files are not compressed.
        most_values_(io::require_file(path) * (io::read_beginning(path, 3).starts_with("CDF") ? 1 : 1040)),
        faces_(file_->id(), most_values_, [file = file_.get()](const std::string& what) { file->fail(what); }) {
    file_->require(ex_get_init_ext(file_->id(), &init_), "the header");
    if (init_.num_dim == 1 || init_.num_dim == 2)
      throw scene::bad_input(
          fmt::format("{}: it is {}-dimensional, so there is no volume in it; give a three-dimensional mesh", source_,
                      init_.num_dim));
    if (init_.num_dim != 3) file_->fail(fmt::format("its points have {} coordinates, not 3", init_.num_dim));
    check_count("nodes", init_.num_nodes, 3);
    check_count("elements", init_.num_elem, 1);
    check_count("element blocks", init_.num_elem_blk, 1);
    choose_step(time_step);
    read_elements();
    read_points();
    settle_exodus_middles(block_);
    add_fields();
  }

  cells::MeshBlocks take() { return std::move(result_); }

 private:
  void check_count(const char* what, std::int64_t n, std::uint64_t values_each) const {
    if (n < 0 || static_cast<std::uint64_t>(n) > most_values_ / values_each)
      file_->fail(fmt::format("it states {} {}", n, what));
  }

  void choose_step(std::optional<std::size_t> requested) {
    const std::int64_t steps = std::max<std::int64_t>(ex_inquire_int(file_->id(), EX_INQ_TIME), 0);
    check_count("time steps", steps, 1);
    result_.time_step = scene::chosen_step(requested, static_cast<std::uint64_t>(steps), source_);
    if (steps > INT32_MAX) file_->fail(fmt::format("it states {} time steps", steps));
    std::vector<double> times(static_cast<std::size_t>(steps));
    if (steps > 0 && ex_get_all_times(file_->id(), times.data()) >= 0)
      scene::set_times(result_.time_step, std::move(times));
    step_ = requested ? static_cast<int>(*requested) + 1 : static_cast<int>(steps);  // from 1; 0 if there are none
  }

  void read_elements() {
    std::vector<std::int64_t> ids(static_cast<std::size_t>(init_.num_elem_blk));
    if (!ids.empty()) file_->require(ex_get_ids(file_->id(), EX_ELEM_BLOCK, ids.data()), "the element blocks");
    block_.offsets.push_back(0);
    const ExodusSets sets(
        file_->id(), init_, choice_, most_values_, source_, [this](const std::string& what) { file_->fail(what); },
        with_surfaces_);
    std::uint64_t first = 0;  // first element of the block among all elements
    std::vector<SidesOf> sides_of;
    for (const std::int64_t id : ids) {
      ex_block info{};
      info.id = id;
      info.type = EX_ELEM_BLOCK;
      file_->require(ex_get_block_param(file_->id(), &info), "an element block");
      check_count("elements", info.num_entry, 1);
      const std::string name = exodus_name(file_->id(), EX_ELEM_BLOCK, id);
      result_.block_names.push_back(name.empty() ? fmt::format("block {}", id) : name);
      const auto count = static_cast<std::uint64_t>(info.num_entry);
      std::vector<std::uint64_t> of;
      if (!cells::is_chosen(choice_, result_.block_names.back())) of = sets.chosen_of(first, count);
      first += count;
      sides_of.push_back({id, info.num_nodes_per_entry, first, exodus_topology(info)});
      if (count == 0 || (of.empty() && !cells::is_chosen(choice_, result_.block_names.back()))) {
        blocks_.push_back({id, block_.types.size(), 0});
        continue;
      }
      const std::string topology = exodus_topology(info);
      const ExodusElement element = exodus_element(topology, info.num_nodes_per_entry);
      if (!element.type)
        throw scene::bad_input(
            fmt::format("{}: element block {} has the unsupported type '{}' of {} nodes; write tetrahedra, wedges, "
                        "pyramids or hexahedra",
                        source_, id, topology.substr(0, 20), info.num_nodes_per_entry));
      add_block(id, info, element);
      if (of.empty()) continue;
      keep_cells(block_, blocks_.back().first, of);
      blocks_.back().count = of.size();
      blocks_.back().of = std::move(of);
    }
    result_.block_names.insert(result_.block_names.end(), sets.names().begin(), sets.names().end());
    result_.surface_names = sets.sides_left_out();
    if (!result_.surface_names.empty())
      result_.notes.push_back(cells::note_on_surfaces("side set", result_.surface_names));
    for (const std::int64_t set : sets.sides())
      add_sides(
          file_->id(), set, init_.num_nodes, most_values_, [this](const std::string& what) { file_->fail(what); },
          sides_of, block_);
    has_sides_ = !sets.sides().empty();
    if (!block_.faces.empty()) block_.face_locations.resize(block_.types.size(), cells::CellBlock::no_faces);
  }

  void add_block(std::int64_t id, const ex_block& info, const ExodusElement& element) {
    const CellType type = *element.type;
    const auto count = static_cast<std::size_t>(info.num_entry);
    blocks_.push_back({id, block_.types.size(), count});
    const bool has_corners = (type != CellType::quad || is_faces(info)) && type != CellType::polyhedron;
    const auto nodes = static_cast<std::size_t>(std::max<std::int64_t>(has_corners ? info.num_nodes_per_entry : 0, 0));
    if (nodes > 0 && count > most_values_ / nodes)
      file_->fail(fmt::format("it states {} elements with {} nodes", count, nodes));
    // Only the corners of faces are used.
    const std::string topology = exodus_topology(info);
    const bool is_triangle = topology.starts_with("TRI") || nodes == 3 || nodes == 6 || nodes == 7;
    block_.types.insert(block_.types.end(), count,
                        vtk_number(type == CellType::quad && is_triangle ? CellType::triangle : type));
    if (nodes > 0) {
      std::vector<std::int64_t> corner(count * nodes);
      file_->require_values(ex_get_conn(file_->id(), EX_ELEM_BLOCK, id, corner.data(), nullptr, nullptr),
                            "the elements");
      block_.connectivity.reserve(block_.connectivity.size() + corner.size());
      for (std::size_t k = 0; k < corner.size(); ++k) {
        if (corner[k] < 1 || corner[k] > init_.num_nodes)
          throw scene::bad_input(
              fmt::format("{}: element {} of block {} uses node {}, but the file has only {} nodes; write elements and "
                          "nodes from one mesh",
                          source_, k / nodes + 1, id, corner[k], init_.num_nodes));
        block_.connectivity.push_back(static_cast<std::uint32_t>(corner[k] - 1));
      }
    }
    for (std::size_t c = 0; c < count; ++c) {
      block_.offsets.push_back(block_.offsets.back() + nodes);
      if (element.order != nullptr)
        cells::to_vtk_order(*element.order,
                            std::span(block_.connectivity).subspan(block_.offsets[block_.offsets.size() - 2], nodes));
    }
    if (type == CellType::polyhedron) faces_.add(id, info, init_.num_nodes, block_);
    report_progress(static_cast<double>(block_.types.size()) /
                    static_cast<double>(std::max<std::int64_t>(init_.num_elem, 1)));
  }

  /// Whether a block's elements are requested faces.
  [[nodiscard]] bool is_faces(const ex_block& info) const {
    const std::string topology = exodus_topology(info);
    return with_surfaces_ && info.num_nodes_per_entry >= 3 &&
           (topology.starts_with("SHE") || topology.starts_with("QUA") || topology.starts_with("TRI"));
  }

  void read_points() {
    const auto n = static_cast<std::size_t>(init_.num_nodes);
    if (n > std::numeric_limits<std::uint32_t>::max()) file_->fail(fmt::format("{} nodes are more than 2^32 - 1", n));
    block_.positions.resize(n);
    if (n == 0) return;
    std::array<std::vector<double>, 3> xyz;
    for (std::vector<double>& axis : xyz) axis.resize(n);
    file_->require_values(ex_get_coord(file_->id(), xyz[0].data(), xyz[1].data(), xyz[2].data()), "the nodes");
    for (std::size_t v = 0; v < n; ++v) block_.positions[v] = {xyz[0][v], xyz[1][v], xyz[2][v]};
  }

  void add_fields() {
    const auto nodes = block_.positions.size();
    const auto file = file_;
    const int step = step_;
    if (step > 0) {
      for (const Variable& variable : group_vectors(file_->variable_names(EX_NODAL))) {
        if (const std::size_t numbers = file_->numbers_a_node(variable.indices.front()); numbers > 1) {
          result_.notes.push_back(fmt::format(
              "field '{}' is left out: it has {} numbers per node in one variable; write a variable for each number",
              variable.name, numbers));
          continue;
        }
        block_.fields.push_back(make_field(variable, scene::Association::point, nodes,
                                           [file, step](int index, std::size_t first, std::span<double> out) {
                                             read_values(*file, step, EX_NODAL, index, 1, first, out);
                                           }));
      }
      if (!has_sides_) add_element_fields();
    }
    if (has_sides_) return finish();
    std::vector<double> ids;
    for (const ElementBlock& b : blocks_) ids.insert(ids.end(), b.count, static_cast<double>(b.id));
    block_.fields.push_back(cells::field_of_values("ObjectId", "int64", scene::Association::cell, 1, std::move(ids)));
    finish();
  }

  void finish() {
    result_.format = "Exodus II";
    result_.blocks.push_back(std::move(block_));
  }

  void add_element_fields() {
    const std::vector<Variable> variables = group_vectors(file_->variable_names(EX_ELEM_BLOCK));
    std::size_t count = 0;
    for (const Variable& variable : variables) count += variable.indices.size();
    std::vector<int> truth(blocks_.size() * count, 0);  // one row per block
    if (!truth.empty())
      file_->require(ex_get_truth_table(file_->id(), EX_ELEM_BLOCK, static_cast<int>(blocks_.size()),
                                        static_cast<int>(count), truth.data()),
                     "the table of element variables");
    for (const Variable& variable : variables) {
      std::vector<int> has;
      for (std::size_t b = 0; b < blocks_.size(); ++b)
        has.push_back(truth[b * count + static_cast<std::size_t>(variable.indices.front() - 1)]);
      if (std::find(has.begin(), has.end(), 0) != has.end())
        result_.notes.push_back(fmt::format(
            "field '{}' is missing in some element blocks: when it is shown, their cells are blanked", variable.name));
      block_.fields.push_back(make_field(
          variable, scene::Association::cell, block_.types.size(),
          [file = file_, step = step_, blocks = blocks_, has](int index, std::size_t first, std::span<double> out) {
            read_cell_values(*file, step, index, blocks, has, first, out);
          }));
    }
  }

  std::string source_;
  cells::BlockChoice choice_;
  bool with_surfaces_ = false;
  bool has_sides_ = false;            ///< the cells include sides, which have no values of element variables
  std::shared_ptr<ExodusFile> file_;  // fields keep the file open
  ex_init_params init_{};
  std::uint64_t most_values_ = 0;
  ExodusFaces faces_;
  int step_ = 0;
  std::vector<ElementBlock> blocks_;
  cells::CellBlock block_;
  cells::MeshBlocks result_;
};

}  // namespace

io::ForeignContents read_exodus(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  std::optional<std::size_t> time_step;
  if (const auto step = request.find("time_step"); step != request.end()) time_step = step->get<std::size_t>();
  cells::MeshBlocks read =
      Reading(file, time_step, request.value("blocks", cells::BlockChoice()), request.value("surfaces", false)).take();
  io::ForeignContents contents;
  for (cells::CellBlock& block : read.blocks) contents.parts.push_back(hold_block(holdings, std::move(block)));
  contents.notes = std::move(read.notes);
  contents.time_step = read.time_step;
  contents.format = std::move(read.format);
  contents.block_names = std::move(read.block_names);
  contents.surface_names = std::move(read.surface_names);
  return contents;
}

}  // namespace tessera::readers
