// SPDX-License-Identifier: BSD-3-Clause
// HyperTreeGrids: VTK's XML reader finds the arrays, and the trees are derived from them here. VTK 9.1's own code for
// this mishandles vectors in version 2 of the format, masks in version 0, and masks of files in pieces.
#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLHyperTreeGridReader.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "io/files/input_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/forest_leaves.hpp"
#include "readers/vtk/grid_pieces.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Larger than any number in real files, but small enough that sums of a few of them do not overflow.
constexpr std::int64_t most_numbers = std::int64_t{1} << 40;

class TreeFileReader final : public vtkXMLHyperTreeGridReader {
 public:
  static TreeFileReader* New() {
    auto* const made = new TreeFileReader;
    made->InitializeObjectBase();
    return made;
  }

  /// Called by Update(). Exceptions must not pass through VTK's pipeline, so they are stored until the pipeline ends.
  void ReadXMLData() override {
    try {
      read();
    } catch (...) {
      fault = std::current_exception();
    }
  }

  std::string source;
  std::uint64_t file_size = 0;
  std::exception_ptr fault;
  bool was_read = false, has_interfaces = false;
  StoredForest forest;
  vtkNew<vtkCellData> values;  ///< values of all cells of all trees
  std::array<vtkSmartPointer<vtkDataArray>, 3> coordinates;

 private:
  [[nodiscard]] scene::Error damaged(const std::string& what) const {
    return scene::bad_input(fmt::format("{}: {}; {}", source, what, write_again));
  }

  static vtkXMLDataElement* array_named(vtkXMLDataElement& in, const char* name) {
    return in.FindNestedElementWithNameAndAttribute("DataArray", "Name", name);
  }

  /// Returns the number of tuples that an array states; 0 if it states none.
  [[nodiscard]] std::int64_t promised(vtkXMLDataElement& array) const {
    vtkIdType tuples = 0;
    if (array.GetScalarAttribute("NumberOfTuples", tuples) == 0) return 0;
    if (tuples < 0 || tuples > most_numbers)
      throw damaged(fmt::format("array {} has {} numbers", name_of(array), tuples));
    return tuples;
  }

  static std::string name_of(vtkXMLDataElement& array) {
    const char* const name = array.GetAttribute("Name");
    return name != nullptr ? quote(name) : "without a name";
  }

  vtkSmartPointer<vtkDataArray> numbers_of(vtkXMLDataElement& element, std::int64_t tuples) {
    const auto made = vtkSmartPointer<vtkAbstractArray>::Take(CreateArray(&element));
    const auto array = vtkSmartPointer<vtkDataArray>(vtkDataArray::SafeDownCast(made));
    if (array == nullptr) throw damaged(fmt::format("array {} has no numbers", name_of(element)));
    const std::int64_t count = tuples * array->GetNumberOfComponents();
    // Deflate packs at most 1032 bytes, of eight bits each, into one byte.
    if (static_cast<double>(count) > 9000.0 * static_cast<double>(file_size))
      throw damaged(
          fmt::format("array {} has {} numbers, more than a file of this size can contain", name_of(element), count));
    array->SetNumberOfTuples(tuples);
    if (array->GetNumberOfValues() != count || (count > 0 && array->GetVoidPointer(0) == nullptr))
      throw std::bad_alloc();
    if (count > 0 && ReadArrayValues(&element, 0, array, 0, count) == 0)
      throw damaged(fmt::format("array {} ends before its {} numbers do", name_of(element), count));
    return array;
  }

  vtkSmartPointer<vtkDataArray> numbers_named(vtkXMLDataElement& in, const char* name) {
    vtkXMLDataElement* const element = array_named(in, name);
    if (element == nullptr) throw damaged(fmt::format("it has no array {}", name));
    return numbers_of(*element, promised(*element));
  }

  /// Appends an array of bits, which may be missing, and returns the number of its bits.
  std::size_t add_bits(vtkXMLDataElement& in, const char* name, std::vector<bool>& bits) {
    vtkXMLDataElement* const element = array_named(in, name);
    return element != nullptr ? add_bits(*element, promised(*element), bits) : 0;
  }

  std::size_t add_bits(vtkXMLDataElement& element, std::int64_t count, std::vector<bool>& bits) {
    const vtkSmartPointer<vtkDataArray> array = numbers_of(element, count);
    for (vtkIdType b = 0; b < array->GetNumberOfTuples(); ++b) bits.push_back(array->GetComponent(b, 0) != 0);
    return static_cast<std::size_t>(array->GetNumberOfTuples());
  }

  void read() {
    vtkXMLReader::ReadXMLData();
    vtkXMLDataElement* const grid = XMLParser->GetRootElement()->LookupElementWithName("HyperTreeGrid");
    if (grid == nullptr) throw damaged("it has no <HyperTreeGrid>");
    read_grid(*grid);
    vtkXMLDataElement* const trees = grid->LookupElementWithName("Trees");
    if (trees == nullptr) throw damaged("it has no <Trees>");
    if (GetFileMajorVersion() > 2)
      throw scene::bad_input(fmt::format(
          "{}: it has version {} of the format, but only versions up to 2 are supported; save it as .vtu in ParaView",
          source, GetFileMajorVersion()));
    if (GetFileMajorVersion() == 2)
      read_trees_together(*grid, *trees);
    else
      read_trees_apart(*trees);
    was_read = true;
  }

  void read_grid(vtkXMLDataElement& grid) {
    grid.GetScalarAttribute("BranchFactor", forest.branching);
    if (forest.branching != 2 && forest.branching != 3)
      throw scene::bad_input(
          fmt::format("{}: its cells are divided by {}, but those of a HyperTreeGrid by 2 or 3; write the file again",
                      source, forest.branching));
    int transposed = 0;
    grid.GetScalarAttribute("TransposedRootIndexing", transposed);
    forest.z_first = transposed != 0;
    has_interfaces = grid.GetAttribute("InterfaceNormalsName") != nullptr;
    std::array<int, 3> points{1, 1, 1};
    grid.GetVectorAttribute("Dimensions", 3, points.data());
    const auto flat = std::count_if(points.begin(), points.end(), [](int n) { return n <= 1; });
    if (flat > 0)
      throw scene::bad_input(
          fmt::format("{}: its trees have {} dimensions; give a three-dimensional grid", source, 3 - flat));
    vtkXMLDataElement* const axes = grid.LookupElementWithName("Grid");
    if (axes == nullptr) throw damaged("it has no <Grid>");
    for (std::size_t a = 0; a < 3; ++a) {
      constexpr std::array names{"XCoordinates", "YCoordinates", "ZCoordinates"};
      forest.roots[a] = points[a] - 1;
      coordinates[a] = numbers_named(*axes, names[a]);
      if (coordinates[a]->GetNumberOfTuples() != points[a] || coordinates[a]->GetNumberOfComponents() != 1)
        throw damaged(fmt::format("{} coordinates along {} for {} points", coordinates[a]->GetNumberOfTuples(),
                                  "xyz"[a], points[a]));
    }
  }

  /// Reads version 2: arrays of all trees, one tree after the other. The last level of a tree has no divisions.
  void read_trees_together(vtkXMLDataElement& grid, vtkXMLDataElement& trees) {
    vtkXMLDataElement* const ids = array_named(trees, "TreeIds");
    if (ids == nullptr || promised(*ids) == 0) return;  // as in VTK's output for a grid without trees
    const vtkSmartPointer<vtkDataArray> roots = numbers_of(*ids, promised(*ids)),
                                        depths = numbers_named(trees, "DepthPerTree"),
                                        counts = numbers_named(trees, "NumberOfVerticesPerDepth");
    const std::size_t bits = add_bits(trees, "Descriptors", forest.divided);
    vtkXMLDataElement* const mask = array_named(trees, "Mask");
    if (depths->GetNumberOfTuples() != roots->GetNumberOfTuples())
      throw damaged(fmt::format("{} depths for {} trees", depths->GetNumberOfTuples(), roots->GetNumberOfTuples()));
    std::size_t cells = 0, bit = 0;
    vtkIdType next = 0;
    for (vtkIdType t = 0; t < roots->GetNumberOfTuples(); ++t) {
      StoredTree tree{whole(*roots, t), cells, 0, bit, 0, cells, 0};
      std::size_t last = 0;
      for (std::int64_t depth = whole(*depths, t); depth > 0; --depth) {
        if (next >= counts->GetNumberOfTuples()) throw damaged("it has fewer counts of cells than levels");
        const std::int64_t count = whole(*counts, next++);
        if (count < 0 || count > most_numbers) throw damaged(fmt::format("a level has {} cells", count));
        last = static_cast<std::size_t>(count), tree.cells += last;
      }
      tree.bits = tree.cells - last;
      cells += tree.cells, bit += tree.bits;
      if (mask != nullptr) tree.masks = tree.cells;
      // Checked so that the sums do not overflow, and no arrays are allocated that the divisions do not explain.
      if (bit > bits || cells > 27 * bits + static_cast<std::size_t>(t) + 1)
        throw damaged(fmt::format("tree {} has {} cells, but too few divisions for them", t, tree.cells));
      forest.trees.push_back(tree);
    }
    // VTK also writes the number of bits that it had in memory, which may be larger, so that number is not used.
    if (mask != nullptr) add_bits(*mask, static_cast<std::int64_t>(cells), forest.masked);
    if (vtkXMLDataElement* const data = grid.FindNestedElementWithName("CellData"))
      for (int k = 0; k < data->GetNumberOfNestedElements(); ++k)
        values->AddArray(numbers_of(*data->GetNestedElement(k), static_cast<std::int64_t>(cells)));
  }

  /// Reads versions 0 and 1, where each tree has its own arrays.
  void read_trees_apart(vtkXMLDataElement& trees) {
    forest.values_by_descent = GetFileMajorVersion() == 0;
    std::size_t cells = 0;
    std::vector<std::vector<vtkSmartPointer<vtkDataArray>>> fields;
    for (int t = 0; t < trees.GetNumberOfNestedElements(); ++t) {
      vtkXMLDataElement& element = *trees.GetNestedElement(t);
      vtkIdType root = -1, count = 0;
      element.GetScalarAttribute("Index", root);
      element.GetScalarAttribute("NumberOfVertices", count);
      StoredTree tree{root, cells, static_cast<std::size_t>(count), forest.divided.size(), 0, forest.masked.size(), 0};
      tree.bits = add_bits(element, "Descriptor", forest.divided);
      tree.masks = add_bits(element, "Mask", forest.masked);
      if (count < 1 || tree.cells > 27 * tree.bits + 1)
        throw damaged(fmt::format("tree {} has {} cells, which does not match its {} divisions", t, count, tree.bits));
      cells += tree.cells;
      forest.trees.push_back(tree);
      vtkXMLDataElement* data = element.FindNestedElementWithName("CellData");
      if (data == nullptr) data = element.FindNestedElementWithName("PointData");  // original name of the element
      if (data == nullptr) continue;
      for (int k = 0; k < data->GetNumberOfNestedElements(); ++k) {
        if (fields.size() <= static_cast<std::size_t>(k)) fields.emplace_back();
        fields[static_cast<std::size_t>(k)].push_back(numbers_of(*data->GetNestedElement(k), count));
      }
    }
    for (auto& parts : fields) join(parts, cells);
  }

  /// Concatenates the arrays of a field in all trees.
  void join(std::vector<vtkSmartPointer<vtkDataArray>>& parts, std::size_t cells) {
    if (parts.size() != forest.trees.size())
      throw damaged(fmt::format("{} of its {} trees have a field", parts.size(), forest.trees.size()));
    const vtkSmartPointer<vtkDataArray>& first = parts.front();
    const auto joined = vtkSmartPointer<vtkDataArray>::Take(first->NewInstance());
    joined->SetName(first->GetName());
    joined->SetNumberOfComponents(first->GetNumberOfComponents());
    joined->SetNumberOfTuples(static_cast<vtkIdType>(cells));
    if (joined->GetNumberOfTuples() != static_cast<vtkIdType>(cells)) throw std::bad_alloc();
    vtkIdType at = 0;
    for (vtkSmartPointer<vtkDataArray>& part : parts) {
      if (part->GetDataType() != joined->GetDataType() ||
          part->GetNumberOfComponents() != joined->GetNumberOfComponents())
        throw damaged("its trees have fields of different kinds");
      joined->InsertTuples(at, part->GetNumberOfTuples(), 0, part);
      at += part->GetNumberOfTuples();
      part = nullptr;
    }
    values->AddArray(joined);
  }

  /// Returns a number that must be an integer; -1 if it is not.
  static std::int64_t whole(vtkDataArray& array, vtkIdType n) {
    const double number = array.GetComponent(n, 0);
    return number >= 0 && number <= static_cast<double>(most_numbers) ? static_cast<std::int64_t>(number) : -1;
  }
};

/// Returns the fields of the leaves only.
vtkSmartPointer<vtkCellData> of_leaves(vtkCellData& all, const std::vector<std::int64_t>& leaves) {
  auto chosen = vtkSmartPointer<vtkCellData>::New();
  const vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(static_cast<vtkIdType>(leaves.size()));
  std::copy(leaves.begin(), leaves.end(), ids->GetPointer(0));
  for (int k = 0; k < all.GetNumberOfArrays(); ++k) {
    vtkDataArray* const array = all.GetArray(k);
    const auto some = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    some->SetName(array->GetName());
    some->SetNumberOfComponents(array->GetNumberOfComponents());
    some->SetNumberOfTuples(ids->GetNumberOfIds());
    if (some->GetNumberOfTuples() != ids->GetNumberOfIds()) throw std::bad_alloc();
    array->GetTuples(ids, some);
    chosen->AddArray(some);
  }
  return chosen;
}

}  // namespace

io::ForeignContents read_hyper_trees(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json&) {
  allow_for(file);
  const std::string source = file.string();
  require_whole_xml(file);
  io::ForeignContents contents;
  contents.format = "VTK XML HyperTreeGrid";
  const std::string warning = with_quiet_vtk(source, write_again, [&] {
    const auto reader = vtkSmartPointer<TreeFileReader>::Take(TreeFileReader::New());
    reader->source = source;
    reader->file_size = io::require_file(file);
    reader->SetFileName(source.c_str());
    reader->Update();
    if (reader->fault) std::rethrow_exception(reader->fault);
    if (!reader->was_read) throw scene::bad_input(fmt::format("{}: no trees can be read; {}", source, write_again));
    ForestLeaves leaves = leaves_of(reader->forest, source);
    if (leaves.masked > 0) contents.notes.push_back(fmt::format("{} cells are masked and left out", leaves.masked));
    if (reader->has_interfaces)
      contents.notes.emplace_back("interfaces within cells are not supported: whole cells are used");
    if (leaves.level.empty()) return;
    io::ForeignPart part;
    part.kind = io::ForeignPart::Kind::trees;
    part.branching = reader->forest.branching;
    part.levels = leaves.levels;
    for (std::size_t a = 0; a < 3; ++a) {
      part.extent[2 * a + 1] = reader->forest.roots[a];
      part.coordinates.push_back(hold_array(holdings, *reader->coordinates[a]));
    }
    part.cell_fields = hold_fields(holdings, *of_leaves(*reader->values, leaves.values), "cell");
    part.points = hold_vector(holdings, {.type = NumberType::int32, .components = 3}, std::move(leaves.lows));
    part.types = hold_vector(holdings, {.type = NumberType::uint8}, std::move(leaves.level));
    contents.parts.push_back(std::move(part));
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  return contents;
}

}  // namespace tessera::readers
