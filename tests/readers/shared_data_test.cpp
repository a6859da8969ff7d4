// SPDX-License-Identifier: BSD-3-Clause
// The public meshes in ../shared/data, compared with the statements of its README.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"

namespace tessera::io {
namespace {

const std::filesystem::path data = std::filesystem::path(TESSERA_SOURCE_DIR) / ".." / "shared" / "data";

class SharedData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no " << data << ": the public meshes are not here";
  }

  static cells::MeshFile read(const std::string& name, const std::string& field = "") {
    ReadOptions options;
    options.field = field;
    cells::MeshFile file = read_mesh(data / name, options);
    scene::validate(file.mesh, name);
    EXPECT_EQ(file.counts.tets_made, file.mesh.tets.size());
    EXPECT_EQ(file.counts.cells_nan + file.counts.cells_ghost + file.counts.cells_not_volumetric, 0u);
    return file;
  }

  /// No triangle is shared by more than two tets: the split cells conform and do not overlap.
  static std::size_t boundary_triangles(const scene::TetMesh& mesh) {
    std::size_t boundary = 0, crowded = 0;
    for (const auto& [place, uses] : testing::count_triangles(mesh)) {
      boundary += uses == 1;
      crowded += uses > 2;
    }
    EXPECT_EQ(crowded, 0u);
    return boundary;
  }

  static cells::FieldSummary field(const cells::MeshFile& file, const std::string& name) {
    for (const cells::FieldSummary& f : file.fields)
      if (f.name == name) return f;
    ADD_FAILURE() << "no field " << name;
    return {};
  }
};

TEST_F(SharedData, OxygenPostClosesAtItsSeam) {
  const cells::MeshFile file = read("oxygen-post/postxyz.bin");
  EXPECT_EQ(file.counts.cells_read, 102675u);
  EXPECT_EQ(file.counts.points_read, 109744u);
  EXPECT_EQ(file.counts.cells_hidden, 0u);
  EXPECT_EQ(file.mesh.field_name, "StagnationEnergy");
  EXPECT_NEAR(field(file, "StagnationEnergy").low, -0.54, 0.005);  // as many digits as the README prints
  EXPECT_NEAR(field(file, "StagnationEnergy").high, 4.40, 0.005);
  EXPECT_EQ(field(file, "Density").low, 1);
  EXPECT_EQ(field(file, "Density").high, 1);
  EXPECT_EQ(field(file, "IBlank").low, -1);
  EXPECT_EQ(field(file, "Momentum").components, 3);
  // The grid is 37 x 75 x 37 cells with i across, j around and k up; j is periodic with a seam, so only the two i-ends
  // and two k-ends are boundary: 2 triangles a face.
  EXPECT_EQ(boundary_triangles(file.mesh), 2u * 2u * (37 * 75 + 37 * 75));
}

TEST_F(SharedData, BluntFinHasCollapsedEdges) {
  const cells::MeshFile file = read("bluntfin/bluntfinxyz.bin");
  EXPECT_EQ(file.counts.cells_read, 37479u);
  EXPECT_EQ(file.counts.points_read, 40960u);
  EXPECT_EQ(file.mesh.field_name, "Density");
  EXPECT_NEAR(field(file, "Density").low, 0.19, 0.005);
  EXPECT_NEAR(field(file, "Density").high, 4.98, 0.005);
  EXPECT_NEAR(field(file, "StagnationEnergy").high, 25.2, 0.05);
  EXPECT_GT(file.counts.tets_collapsed, 0u);
  EXPECT_EQ(file.counts.cells_zero_volume, 0u);
  boundary_triangles(file.mesh);
}

TEST_F(SharedData, BracketIsLeftHandedWithUnusedPoints) {
  const cells::MeshFile file = read("bracket/bracket_appended_compressed.vtu", "sj2p");
  EXPECT_EQ(file.counts.cells_read, 206208u);
  EXPECT_EQ(file.mesh.tets.size(), 206208u);
  EXPECT_EQ(file.counts.points_read, 50000u);
  EXPECT_EQ(file.counts.points_unused, 50000u - 39423u);
  EXPECT_EQ(file.mesh.association, scene::Association::cell);
  EXPECT_NEAR(scene::scalar_range(file.mesh)[0], 216, 0.5);
  EXPECT_NEAR(scene::scalar_range(file.mesh)[1], 1.19e5, 500);
  EXPECT_TRUE(file.mesh.original_cell.empty());
  EXPECT_EQ(read("bracket/bracket_appended_compressed.vtu").mesh.field_name, "xdsp");
  boundary_triangles(file.mesh);
}

TEST_F(SharedData, DiskOutIsReadFromExodus) {
  const cells::MeshFile file = read("disk-out/disk_out_ref.ex2");
  EXPECT_EQ(file.counts.cells_read, 7472u);
  EXPECT_EQ(file.counts.points_read, 8499u);
  EXPECT_EQ(file.mesh.field_name, "Temp");
  EXPECT_NEAR(scene::scalar_range(file.mesh)[0], 293, 0.5);
  EXPECT_NEAR(scene::scalar_range(file.mesh)[1], 913, 0.5);
  EXPECT_EQ(read("disk-out/disk_out_ref.ex2", "V:z").mesh.field_name, "V:z");
  boundary_triangles(file.mesh);
  ReadOptions options;
  options.time_step = 1;
  EXPECT_NE(testing::message_of([&] { read_mesh(data / "disk-out/disk_out_ref.ex2", options); }).find("no time step 1"),
            std::string::npos);
}

TEST_F(SharedData, NotchMixesHexahedraAndWedges) {
  const cells::MeshFile file = read("notch/notch_stress_fixed.vtk");
  EXPECT_EQ(file.counts.cells_read, 2192u);
  EXPECT_EQ(file.counts.points_read, 3537u);
  EXPECT_EQ(file.mesh.field_name, "Nodal Stress-0");
  EXPECT_NEAR(scene::scalar_range(file.mesh)[0], -1.5e5, 0.05e5);
  EXPECT_NEAR(scene::scalar_range(file.mesh)[1], 8.1e6, 0.05e6);
  EXPECT_EQ(read("notch/notch_stress_fixed.vtk", "Nodal Stress-normed").mesh.field_name, "Nodal Stress-normed");
  EXPECT_EQ(read("notch/notch_stress_fixed.vtk", "Nodal Stress:5").mesh.field_name, "Nodal Stress:5");
  boundary_triangles(file.mesh);
}

TEST_F(SharedData, UnisimKeepsMetresAtSevenMillion) {
  const cells::MeshFile file = read("unisim/UNISIM-II-D.vtu");
  EXPECT_EQ(file.counts.cells_read, 47610u);
  EXPECT_EQ(file.counts.points_read, 58433u);
  EXPECT_EQ(file.counts.cells_hidden, 14775u);
  EXPECT_EQ(file.mesh.association, scene::Association::cell);
  EXPECT_EQ(file.mesh.field_name, "BLOCK_I");
  EXPECT_EQ(file.counts.cells_zero_volume, 0u);
  boundary_triangles(file.mesh);
}

}  // namespace
}  // namespace tessera::io
