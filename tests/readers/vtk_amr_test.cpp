// SPDX-License-Identifier: BSD-3-Clause
// FLASH and Enzo files in their programs' formats, written here, and VTK's own HyperTreeGrids.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkHyperTree.h>
#include <vtkHyperTreeGrid.h>
#include <vtkHyperTreeGridNonOrientedGeometryCursor.h>
#include <vtkNew.h>
#include <vtkXMLHyperTreeGridWriter.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "support/amr_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::vtk_amr_test {
namespace {

using namespace testing;

class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& file)
      : file_(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Hdf5Writer() { H5Fclose(file_); }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& name) const {
    H5Gclose(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }

  /// Stored as type `stored`, compressed if `is_packed`.
  void data(const std::string& name, hid_t type, hid_t stored, const std::vector<hsize_t>& sizes, const void* numbers,
            bool is_packed = false) const {
    const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (is_packed) H5Pset_chunk(how, static_cast<int>(sizes.size()), sizes.data()), H5Pset_deflate(how, 4);
    const hid_t set = H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
    H5Dclose(set), H5Pclose(how), H5Sclose(space);
  }
  void ints(const std::string& name, const std::vector<hsize_t>& sizes, const std::vector<int>& numbers) const {
    data(name, H5T_NATIVE_INT, H5T_NATIVE_INT, sizes, numbers.data());
  }
  void doubles(const std::string& name, const std::vector<hsize_t>& sizes, const std::vector<double>& numbers) const {
    data(name, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, sizes, numbers.data());
  }

 private:
  hid_t file_;
};

/// A name and its number, in FLASH's list format.
template <class T>
struct Scalar {
  std::array<char, 80> name{};
  T value{};
  Scalar(const char* words, T number) : value(number) { std::strncpy(name.data(), words, name.size() - 1); }
};

template <class T>
void write_scalars(const Hdf5Writer& file, const char* name, hid_t type, const std::vector<Scalar<T>>& scalars) {
  const hid_t text = H5Tcopy(H5T_C_S1), pair = H5Tcreate(H5T_COMPOUND, sizeof(Scalar<T>));
  H5Tset_size(text, 80);
  H5Tinsert(pair, "name", HOFFSET(Scalar<T>, name), text);
  H5Tinsert(pair, "value", HOFFSET(Scalar<T>, value), type);
  file.data(name, pair, pair, {scalars.size()}, scalars.data());
  H5Tclose(pair), H5Tclose(text);
}

/// A FLASH file with blocks of 4 x 4 x 4 cells; each divided block has eight children.
std::filesystem::path write_flash(const test::TemporaryFolder& folder, const AmrScene& scene, const Field& at,
                                  bool is_packed = false) {
  const std::filesystem::path name = folder / "run_hdf5_plt_cnt_0003";
  const Hdf5Writer file(name);
  const hsize_t n = scene.blocks.size();
  const hid_t version = H5Tcreate(H5T_COMPOUND, sizeof(int));
  H5Tinsert(version, "file format version", 0, H5T_NATIVE_INT);
  const int nine = 9;
  file.data("sim info", version, version, {1}, &nine);
  H5Tclose(version);
  write_scalars<int>(file, "integer scalars", H5T_NATIVE_INT,
                     {{"nxb", 4}, {"nyb", 4}, {"nzb", 4}, {"globalnumblocks", static_cast<int>(n)}, {"nstep", 3}});
  write_scalars<double>(file, "real scalars", H5T_NATIVE_DOUBLE, {{"time", 0.25}});
  std::vector<int> levels, types;
  std::vector<double> bounds, centres, f;
  for (const Block& block : scene.blocks) {
    levels.push_back(block.level + 1);
    const bool has_children = std::any_of(scene.blocks.begin(), scene.blocks.end(), [&](const Block& other) {
      return other.level == block.level + 1 && block.holds((AmrScene::low(other) - AmrScene::origin) / AmrScene::unit);
    });
    types.push_back(has_children ? 2 : 1);
    for (std::size_t a = 0; a < 3; ++a) {
      const double low = AmrScene::low(block)[static_cast<int>(a)], size = AmrScene::spacing(block) * block.cells(a);
      bounds.insert(bounds.end(), {low, low + size});
      centres.push_back(low + 0.5 * size);
    }
    const std::vector<double> values = AmrScene::values(block, false, at);
    f.insert(f.end(), values.begin(), values.end());
  }
  file.ints("gid", {n, 15}, std::vector<int>(15 * n, -1));
  file.ints("refine level", {n}, levels);
  file.ints("node type", {n}, types);
  file.doubles("bounding box", {n, 3, 2}, bounds);
  file.doubles("coordinates", {n, 3}, centres);
  const hid_t word = H5Tcopy(H5T_C_S1);
  H5Tset_size(word, 4);
  file.data("unknown names", word, word, {2, 1}, "f   dens");
  H5Tclose(word);
  file.data("f   ", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, {n, 4, 4, 4}, f.data(), is_packed);
  file.data("dens", H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE, {n, 4, 4, 4}, f.data(), is_packed);
  return name;
}

/// One block and its eight children. The first child has eight too, and the last of those, in the middle, has eight
/// more.
AmrScene oct_tree() {
  AmrScene scene{{{0, 1, {0, 0, 0}, {3, 3, 3}}}};
  const auto add_children = [&](int level, int parts, std::array<int, 3> first) {
    for (int c = 0; c < 8; ++c) {
      const std::array<int, 3> low{first[0] + ((c & 1) != 0 ? 4 : 0), first[1] + ((c & 2) != 0 ? 4 : 0),
                                   first[2] + ((c & 4) != 0 ? 4 : 0)};
      scene.blocks.push_back({level, parts, low, {low[0] + 3, low[1] + 3, low[2] + 3}});
    }
  };
  add_children(1, 2, {0, 0, 0});
  add_children(2, 4, {0, 0, 0});
  add_children(3, 8, {8, 8, 8});
  return scene;
}

ReadOptions with(const char* field, bool smooth) {
  ReadOptions options;
  options.field = std::string(field);
  options.smooth = smooth;
  return options;
}

TEST(Flash, CellsHaveTheirValuesAndSmoothedTheyAreContinuous) {
  const test::TemporaryFolder folder;
  const AmrScene scene = oct_tree();
  for (const bool is_packed : {false, true}) {
    const auto file = write_flash(folder, scene, wavy, is_packed);
    const cells::MeshFile cells = read_mesh(file, with("dens", false));
    EXPECT_EQ(cells.format, "FLASH");
    EXPECT_EQ(cells.counts.cells_read, 64u * (7 + 7 + 8));
    expect_cells(cells.mesh, scene, 4, wavy, 3e-7);  // stored as float
  }
  for (const auto& at : {linear, wavy}) {
    const cells::MeshFile read = read_mesh(write_flash(folder, scene, at), with("f   ", true));
    scene::validate(read.mesh, "flash");
    expect_smooth(read.mesh, scene, 4, at, at == linear, 1e-9);
  }
}

TEST(Flash, DamagesAreOneLine) {
  const test::TemporaryFolder folder;
  const auto file = write_flash(folder, oct_tree(), wavy, true);
  const std::string good = test::contents(file);
  const auto fault = [&](const std::string& text) {
    folder.write("run_hdf5_plt_cnt_0003", text);
    const std::string message = message_of([&] { read_mesh(file); });
    EXPECT_NE(message, "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  fault(good.substr(0, good.size() / 2));
  std::string text = good;
  const std::size_t packed = text.rfind("\x78\x5e");  // beginning of a zlib chunk
  ASSERT_NE(packed, std::string::npos);
  for (std::size_t k = 20; k < 60; ++k) text[packed + k] ^= '\x5a';
  fault(text);
  ReadOptions options;
  options.time_step = 3;
  folder.write("run_hdf5_plt_cnt_0003", good);
  EXPECT_NE(message_of([&] { read_mesh(file, options); }), "");
}

TEST(Flash, ChangedBytesAreReadOrRefused) {
  const test::TemporaryFolder folder;
  const auto file = write_flash(folder, oct_tree(), wavy, true);
  expect_read_or_refused(file, file, 40);
}

/// Enzo's grids, each with the grids in it.
struct EnzoGrid {
  Block block;
  std::vector<EnzoGrid> inside{};
};

class EnzoWriter {
 public:
  EnzoWriter(const std::filesystem::path& folder, Field at)
      : at_(std::move(at)), data_(folder / "output_0003.cpu0000") {}

  /// Adds the siblings from number `from` on, in Enzo's order: first all siblings, then the contents of the last one,
  /// then those of the one before it, and so on.
  void add(const std::vector<EnzoGrid>& siblings, std::size_t from = 0) {
    const EnzoGrid& grid = siblings[from];
    const int id = ++last_;
    add_grid(grid.block, id);
    const bool has_next = from + 1 < siblings.size();
    text_ += fmt::format("Pointer: Grid[{}]->NextGridThisLevel = {}\n", id, has_next ? last_ + 1 : 0);
    if (has_next) add(siblings, from + 1);
    text_ += fmt::format("Pointer: Grid[{}]->NextGridNextLevel = {}\n", id, grid.inside.empty() ? 0 : last_ + 1);
    if (!grid.inside.empty()) add(grid.inside);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add_grid(const Block& block, int id) {
    const glm::dvec3 low = AmrScene::low(block),
                     high = low + AmrScene::spacing(block) * glm::dvec3(block.cells(0), block.cells(1), block.cells(2));
    text_ += fmt::format(
        "\nGrid = {}\nTask              = 0\nGridRank          = 3\nGridDimension     = {} {} {} \n"
        "GridStartIndex    = 3 3 3 \nGridEndIndex      = {} {} {} \nGridLeftEdge      = {} {} {} \n"
        "GridRightEdge     = {} {} {} \nTime              = 0.25\nSubgridsAreStatic = 0\nNumberOfBaryonFields = 1\n"
        "FieldType = 0 \nBaryonFileName = ./somewhere/output_0003.cpu0000\nCourantSafetyNumber    = 0.3\n"
        "NumberOfParticles   = 0\nGravityBoundaryType = 0\n",
        id, block.cells(0) + 6, block.cells(1) + 6, block.cells(2) + 6, block.cells(0) + 2, block.cells(1) + 2,
        block.cells(2) + 2, low.x, low.y, low.z, high.x, high.y, high.z);
    const std::string group = fmt::format("Grid{:08}", id);
    data_.group(group);
    data_.doubles(group + "/f",
                  {static_cast<hsize_t>(block.cells(2)), static_cast<hsize_t>(block.cells(1)),
                   static_cast<hsize_t>(block.cells(0))},
                  AmrScene::values(block, false, at_));
  }

  Field at_;
  Hdf5Writer data_;
  std::string text_;
  int last_ = 0;
};

std::filesystem::path write_enzo(const test::TemporaryFolder& folder, const std::vector<EnzoGrid>& grids,
                                 const Field& at) {
  EnzoWriter writer(folder.path(), at);
  writer.add(grids);
  folder.write("output_0003",
               "InitialCycleNumber  = 3\nInitialTime         = 0.25\nTopGridRank            = 3\n"
               "DataLabel[0]              = f\n#DataCGSConversionFactor[0] = 7.5\n");
  folder.write("output_0003.boundary", "BoundaryRank         = 3\nBoundaryDimension    = 10 10 10\n");
  return folder.write("output_0003.hierarchy", writer.text());
}

/// Like nested_blocks(), each block in one of the previous level.
std::vector<EnzoGrid> nested_grids() {
  const std::vector<Block> b = nested_blocks().blocks;
  return {{b[0], {{b[1], {{b[2]}}}, {{1, 2, {6, 6, 0}, {7, 7, 1}}, {{b[3]}}}}}};
}

TEST(Enzo, CellsHaveTheirValuesAndSmoothedTheyAreContinuous) {
  const test::TemporaryFolder folder;
  const AmrScene scene = nested_blocks();
  const auto file = write_enzo(folder, nested_grids(), wavy);
  for (const auto& named : {file, folder / "output_0003.boundary"}) {
    const cells::MeshFile cells = read_mesh(named, with("f", false));
    EXPECT_EQ(cells.format, "Enzo");
    EXPECT_EQ(cells.counts.cells_read, 64u - 8 - 1 + 64 - 8 + 2 * 64);
    expect_cells(cells.mesh, scene, 4, wavy, 1e-12);
  }
  for (const auto& at : {linear, wavy}) {
    const cells::MeshFile read = read_mesh(write_enzo(folder, nested_grids(), at), with("f", true));
    scene::validate(read.mesh, "enzo");
    expect_smooth(read.mesh, scene, 4, at, at == linear, 1e-9);
  }
}

TEST(Enzo, DamagesAreOneLine) {
  const test::TemporaryFolder folder;
  const auto file = write_enzo(folder, nested_grids(), wavy);
  const std::string good = test::contents(file);
  const auto fault = [&] {
    const std::string message = message_of([&] { read_mesh(file); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  };
  folder.write("output_0003.hierarchy", good.substr(0, good.rfind("GridRightEdge")));
  EXPECT_NE(fault().find("the file ends after 5 grids where GridRightEdge is required"), std::string::npos) << fault();
  folder.write("output_0003.hierarchy", good);
  std::filesystem::resize_file(folder / "output_0003.cpu0000", 3000);
  EXPECT_NE(fault(), "");
  std::filesystem::remove(folder / "output_0003.cpu0000");
  EXPECT_NE(fault(), "");
  std::filesystem::remove(folder / "output_0003");
  EXPECT_NE(fault().find("output_0003, which belongs to it, does not exist"), std::string::npos) << fault();
}

TEST(Enzo, ChangedBytesAreReadOrRefused) {
  const test::TemporaryFolder folder;
  const auto file = write_enzo(folder, nested_grids(), wavy);
  for (const char* name : {"output_0003.hierarchy", "output_0003.cpu0000", "output_0003"})
    expect_read_or_refused(file, folder / name, 20);
}

/// A grid of VTK's own, divided around its middle, partly masked; a cell's value is its number.
vtkSmartPointer<vtkHyperTreeGrid> trees_of_vtk() {
  auto grid = vtkSmartPointer<vtkHyperTreeGrid>::New();
  grid->SetDimensions(3, 3, 3);
  grid->SetBranchFactor(2);
  const vtkNew<vtkDoubleArray> corners;
  for (const double x : {0.0, 1.0, 3.0}) corners->InsertNextValue(x);
  grid->SetXCoordinates(corners), grid->SetYCoordinates(corners), grid->SetZCoordinates(corners);
  const vtkNew<vtkHyperTreeGridNonOrientedGeometryCursor> cursor;
  vtkIdType offset = 0;
  for (vtkIdType t = 0; t < 8; ++t) {
    grid->InitializeNonOrientedGeometryCursor(cursor, t, true);
    cursor->SetGlobalIndexStart(offset);
    if (t % 3 == 0) {
      cursor->SubdivideLeaf();
      cursor->ToChild(static_cast<unsigned char>(t));
      cursor->SubdivideLeaf();
      cursor->ToRoot();
    }
    offset += cursor->GetTree()->GetNumberOfVertices();
  }
  const vtkNew<vtkDoubleArray> f;
  f->SetName("f");
  const vtkNew<vtkBitArray> mask;
  for (vtkIdType n = 0; n < offset; ++n) f->InsertNextValue(static_cast<double>(n)), mask->InsertNextValue(n % 7 == 5);
  grid->GetCellData()->AddArray(f);
  grid->SetMask(mask);
  return grid;
}

/// The leaves' boxes and values in VTK's order.
void add_leaves(vtkHyperTreeGrid& grid, vtkHyperTreeGridNonOrientedGeometryCursor& cursor,
                std::vector<std::pair<std::array<double, 6>, double>>& leaves) {
  if (cursor.IsMasked()) return;
  if (cursor.IsLeaf()) {
    std::array<double, 6> box{};
    cursor.GetBounds(box.data());
    leaves.emplace_back(box, grid.GetCellData()->GetArray("f")->GetComponent(cursor.GetGlobalNodeIndex(), 0));
    return;
  }
  for (unsigned char c = 0; c < cursor.GetNumberOfChildren(); ++c) {
    cursor.ToChild(c);
    add_leaves(grid, cursor, leaves);
    cursor.ToParent();
  }
}

TEST(HyperTreesOfVtk, MatchVtksTreesInMemory) {
  const test::TemporaryFolder folder;
  const auto grid = trees_of_vtk();
  std::vector<std::pair<std::array<double, 6>, double>> leaves;
  for (vtkIdType t = 0; t < 8; ++t) {
    const vtkNew<vtkHyperTreeGridNonOrientedGeometryCursor> cursor;
    grid->InitializeNonOrientedGeometryCursor(cursor, t);
    add_leaves(*grid, *cursor, leaves);
  }
  double whole = 0;
  for (const auto& [b, value] : leaves) whole += (b[1] - b[0]) * (b[3] - b[2]) * (b[5] - b[4]);
  for (const int version : {0, 1, 2})
    for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
      const std::string file = (folder / "vtk.htg").string();
      const vtkNew<vtkXMLHyperTreeGridWriter> writer;
      writer->SetInputData(grid);
      writer->SetDataSetMajorVersion(version);
      writer->SetDataMode(mode);
      writer->SetFileName(file.c_str());
      ASSERT_NE(writer->Write(), 0);
      const cells::MeshFile read = read_mesh(file);
      EXPECT_EQ(read.counts.cells_read, leaves.size()) << version << ' ' << mode;
      EXPECT_NEAR(volume(read.mesh), whole, 1e-12 * whole);
      for (std::size_t t = 0; t < read.mesh.tets.size(); ++t) {
        glm::dvec3 p(0);
        for (const std::uint32_t v : read.mesh.tets[t]) p += 0.25 * read.mesh.positions[v];
        const auto leaf = std::find_if(leaves.begin(), leaves.end(), [&](const auto& known) {
          const auto& b = known.first;
          return p.x > b[0] && p.x < b[1] && p.y > b[2] && p.y < b[3] && p.z > b[4] && p.z < b[5];
        });
        ASSERT_NE(leaf, leaves.end()) << version << ' ' << mode;
        ASSERT_EQ(read.mesh.scalars[t], leaf->second) << version << ' ' << mode;
      }
    }
}

}  // namespace
}  // namespace tessera::io::vtk_amr_test
