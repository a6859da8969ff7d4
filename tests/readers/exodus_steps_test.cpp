// SPDX-License-Identifier: BSD-3-Clause
// Exodus files whose nodes move with time, written by the Exodus library: times, displacements, `warp`.
#include <gtest/gtest.h>
#include <vtk_exodusII.h>
#include <vtk_netcdf.h>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "cells/warp.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "tessera/dataset.hpp"

namespace tessera::io::exodus_steps_test {
namespace {

/// A unit cube at times 0.5, 0.75 and 4. In each vector the nodes at x = 1 have (step, 0, 0), the others 0.
void write_cube(const std::filesystem::path& file, const std::vector<std::string>& vectors, int mode = EX_CLOBBER) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(file.c_str(), mode, &word, &stored);
  ASSERT_GE(id, 0);
  ex_put_init(id, "cube", 3, 8, 1, 1, 0, 0);
  const std::array<double, 8> x = {0, 1, 1, 0, 0, 1, 1, 0}, y = {0, 0, 1, 1, 0, 0, 1, 1}, z = {0, 0, 0, 0, 1, 1, 1, 1};
  ex_put_coord(id, x.data(), y.data(), z.data());
  ex_put_block(id, EX_ELEM_BLOCK, 1, "HEX8", 1, 8, 0, 0, 0);
  const std::array<int, 8> corners = {1, 2, 3, 4, 5, 6, 7, 8};
  ex_put_conn(id, EX_ELEM_BLOCK, 1, corners.data(), nullptr, nullptr);
  ex_put_variable_param(id, EX_NODAL, static_cast<int>(3 * vectors.size()));
  int variable = 0;
  for (const std::string& vector : vectors)
    for (const char axis : {'x', 'y', 'z'}) ex_put_variable_name(id, EX_NODAL, ++variable, (vector + axis).c_str());
  const std::array<double, 3> times = {0.5, 0.75, 4};
  for (int step = 1; step <= 3; ++step) {
    ex_put_time(id, step, &times[static_cast<std::size_t>(step - 1)]);
    std::array<double, 8> moved{};
    const std::array<double, 8> still{};
    for (std::size_t k = 0; k < 8; ++k) moved[k] = step * x[k];
    for (int v = 1; v <= variable; ++v)
      ex_put_var(id, step, EX_NODAL, v, 1, 8, v % 3 == 1 ? moved.data() : still.data());
  }
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

double volume_of(const std::filesystem::path& file, const std::optional<Warp>& warp = {}, std::size_t step = 2) {
  ReadOptions options;
  options.warp = warp;
  options.time_step = step;
  return testing::volume(read_mesh(file, options).mesh);
}

TEST(ExodusSteps, AreAtTheirTimes) {
  const test::TemporaryFolder folder;
  write_cube(folder / "a.exo", {"v_"});
  const scene::TimeStepRead steps = time_steps_of_mesh(identify(folder / "a.exo"));
  EXPECT_EQ(steps.times, (std::vector<double>{0.5, 0.75, 4}));
  EXPECT_EQ(times_of(folder / "a.exo"), steps.times);
  const cells::MeshFile last = read_mesh(folder / "a.exo");
  EXPECT_EQ(last.time_step.step, 2u);
  const Dataset first = Dataset::open(folder / "a.exo", {.time_step = 0});
  EXPECT_EQ(first.notes().front(), "time step 0 of 0 to 2, time 0.5");
  EXPECT_EQ(first.time(), 0.5);
  EXPECT_EQ(first.times().size(), 3u);
}

TEST(ExodusSteps, MayBeHdf5BehindAUserBlock) {
  const test::TemporaryFolder folder;
  write_cube(folder / "a.exo", {"v_"}, EX_CLOBBER | EX_NETCDF4);
  for (const std::size_t block : {512u, 2048u}) {
    folder.write("b.exo", std::string(block, 'u') + test::contents(folder / "a.exo"));
    const cells::MeshFile file = read_mesh(folder / "b.exo");
    EXPECT_EQ(file.counts.cells_read, 1u);
    EXPECT_EQ(file.time_step.times, (std::vector<double>{0.5, 0.75, 4}));
    EXPECT_EQ(file.mesh.scalars, read_mesh(folder / "a.exo").mesh.scalars);
  }
}

TEST(ExodusSteps, NodesMoveByDisplacementsOnly) {
  const test::TemporaryFolder folder;
  for (const char* name : {"disp_", "DISPL", "Displacement_", "dis", "displacements_", "disp__"}) {
    write_cube(folder / "a.exo", {"v_", name});
    EXPECT_NEAR(volume_of(folder / "a.exo"), 4, 1e-12) << name;
    EXPECT_NEAR(volume_of(folder / "a.exo", {}, 0), 2, 1e-12) << name;
    EXPECT_NEAR(volume_of(folder / "a.exo", Warp{}), 1, 1e-12) << name;
  }
  for (const char* name : {"dissipation_", "distance_", "discharge", "displacement_rate_", "dispersion", "display_"}) {
    write_cube(folder / "a.exo", {name});
    EXPECT_NEAR(volume_of(folder / "a.exo"), 1, 1e-12) << name;
  }
  write_cube(folder / "a.exo", {"disp", "displacement"});  // only the first
  EXPECT_NEAR(volume_of(folder / "a.exo"), 4, 1e-12);
  EXPECT_EQ(std::ranges::count(read_mesh(folder / "a.exo").notes, "nodes are displaced by 'disp'"), 1);
}

TEST(ExodusSteps, PartsOfAVectorNeedNotBeNeighbours) {
  const test::TemporaryFolder folder;
  const auto fields_of = [&](const std::vector<std::string>& names) {
    int word = sizeof(double), stored = sizeof(double);
    const int id = ex_create((folder / "a.exo").c_str(), EX_CLOBBER, &word, &stored);
    ex_put_init(id, "tet", 3, 4, 1, 1, 0, 0);
    const std::array<double, 4> x = {0, 1, 0, 0}, y = {0, 0, 1, 0}, z = {0, 0, 0, 1};
    ex_put_coord(id, x.data(), y.data(), z.data());
    ex_put_block(id, EX_ELEM_BLOCK, 1, "TETRA", 1, 4, 0, 0, 0);
    const std::array<int, 4> corners = {1, 2, 3, 4};
    ex_put_conn(id, EX_ELEM_BLOCK, 1, corners.data(), nullptr, nullptr);
    ex_put_variable_param(id, EX_NODAL, static_cast<int>(names.size()));
    const double time = 0;
    ex_put_time(id, 1, &time);
    for (int v = 1; v <= static_cast<int>(names.size()); ++v) {
      ex_put_variable_name(id, EX_NODAL, v, names[static_cast<std::size_t>(v - 1)].c_str());
      const std::array<double, 4> values = {0.5 + v, 1.5 + v, 2.5 + v, 4.5 + v};
      ex_put_var(id, 1, EX_NODAL, v, 1, 4, values.data());
    }
    EXPECT_EQ(ex_close(id), EX_NOERR);
    ReadOptions still;
    still.warp = Warp{};
    std::vector<std::string> fields;
    for (const cells::FieldSummary& f : read_mesh(folder / "a.exo", still).fields)
      if (f.association == Association::point) fields.push_back(f.name + std::to_string(f.components));
    return fields;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(fields_of({"disp_x", "T", "disp_y", "disp_z"}), (Names{"disp3", "T1"}));
  ReadOptions moved;
  moved.field = "disp:z";
  const cells::MeshFile read = read_mesh(folder / "a.exo", moved);
  EXPECT_EQ(read.mesh.scalars.front(), 4.5);
  EXPECT_NEAR(read.mesh.positions.front().y, 3.5, 1e-6);
  EXPECT_EQ(fields_of({"vZ", "p", "vY", "q", "vX"}), (Names{"v3", "p1", "q1"}));
  EXPECT_EQ(fields_of({"s_xx", "s_yy", "s_zz", "s_xy", "s_yz", "s_xz"}),
            (Names{"s_xx1", "s_yy1", "s_zz1", "s_xy1", "s_yz1", "s_xz1"}));
  EXPECT_EQ(fields_of({"u_x", "u_y", "T"}), (Names{"u_x1", "u_y1", "T1"}));
}

/// A tetrahedron with T and, with three numbers per node, v as written by meshio 5: without `file_size`.
void write_as_meshio(const std::filesystem::path& file) {
  int id = 0, nodes = 0, space = 0, elements = 0, blocks = 0, letters = 0, steps = 0, corners = 0, variables = 0,
      node = 0, three = 0;
  const auto require = [](int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); };
  require(nc_create(file.c_str(), NC_CLOBBER, &id));
  const float version = 5.1f;
  const int word = 8;
  for (const char* name : {"version", "api_version"})
    require(nc_put_att_float(id, NC_GLOBAL, name, NC_FLOAT, 1, &version));
  require(nc_put_att_int(id, NC_GLOBAL, "floating_point_word_size", NC_INT, 1, &word));
  for (const auto& [name, length, made] :
       {std::tuple("num_nodes", 4, &nodes), std::tuple("num_dim", 3, &space), std::tuple("num_elem", 1, &elements),
        std::tuple("num_el_blk", 1, &blocks), std::tuple("len_string", 33, &letters),
        std::tuple("time_step", 0, &steps), std::tuple("num_el_in_blk1", 1, &elements),
        std::tuple("num_nod_per_el1", 4, &corners), std::tuple("num_nod_var", 2, &variables),
        std::tuple("dim_nod_var00", 4, &node), std::tuple("dim_nod_var11", 3, &three)})
    require(nc_def_dim(id, name, static_cast<std::size_t>(length), made));
  int times = 0, coordinates = 0, ids = 0, connect = 0, names = 0, t = 0, v = 0;
  const auto define = [&](const char* name, nc_type type, const std::vector<int>& axes, int& made) {
    require(nc_def_var(id, name, type, static_cast<int>(axes.size()), axes.data(), &made));
  };
  define("time_whole", NC_FLOAT, {steps}, times);
  define("coord", NC_DOUBLE, {space, nodes}, coordinates);
  define("eb_prop1", NC_INT, {blocks}, ids);
  define("connect1", NC_INT, {elements, corners}, connect);
  require(nc_put_att_text(id, connect, "elem_type", 5, "TETRA"));
  define("name_nod_var", NC_CHAR, {variables, letters}, names);
  define("vals_nod_var1", NC_DOUBLE, {steps, node}, t);
  define("vals_nod_var2", NC_DOUBLE, {steps, node, three}, v);
  require(nc_enddef(id));
  const std::array<double, 12> places = {0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  require(nc_put_var_double(id, coordinates, places.data()));
  const int block = 0;
  require(nc_put_var_int(id, ids, &block));
  const std::array<int, 4> cell = {1, 2, 3, 4};
  require(nc_put_var_int(id, connect, cell.data()));
  std::string text(66, '\0');
  text[0] = 'T', text[33] = 'v';
  require(nc_put_var_text(id, names, text.data()));
  for (std::size_t step = 0; step < 2; ++step) {
    const std::array<std::size_t, 3> from{step, 0, 0}, values{1, 4, 1}, vectors{1, 4, 3};
    const std::array<float, 1> time{static_cast<float>(step)};
    require(nc_put_vara_float(id, times, from.data(), values.data(), time.data()));
    std::array<double, 4> temperatures{1.5, 2.5, 4.5, 8.5};
    for (double& number : temperatures) number += 100 * static_cast<double>(step);
    require(nc_put_vara_double(id, t, from.data(), values.data(), temperatures.data()));
    require(nc_put_vara_double(id, v, from.data(), vectors.data(), places.data()));
  }
  require(nc_close(id));
}

TEST(ExodusSteps, WithoutFileSizeNodesHaveTheirValues) {
  const test::TemporaryFolder folder;
  write_as_meshio(folder / "a.e");
  for (const std::size_t step : {0u, 1u}) {
    ReadOptions options;
    options.field = "T";
    options.time_step = step;
    const cells::MeshFile read = read_mesh(folder / "a.e", options);
    ASSERT_EQ(read.mesh.positions.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      const glm::dvec3 p = read.mesh.positions[k];
      EXPECT_EQ(read.mesh.scalars[k], 1.5 + p.x + 3 * p.y + 7 * p.z + 100. * static_cast<double>(step));
    }
    EXPECT_EQ(read.fields.front().name, "T");
    EXPECT_TRUE(std::ranges::any_of(read.notes, [](const std::string& note) {
      return note.find("'v' is left out: it has 3 numbers per node") != std::string::npos;
    })) << read.notes.size();
  }
}

TEST(ExodusSteps, AWarpNamesVectorAndFactor) {
  const test::TemporaryFolder folder;
  write_cube(folder / "a.exo", {"disp_", "dissipation_"});
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"disp", 10}), 31, 1e-12);
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"disp", -0.1}), 0.7, 1e-12);
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"dissipation", 2}), 7, 1e-12);
  test::expect_bad_input([&] { volume_of(folder / "a.exo", Warp{"dips"}); },
                         {"`warp`: there is no point vector 'dips'", "did you mean 'disp'?", "'dissipation'"});
}

}  // namespace
}  // namespace tessera::io::exodus_steps_test
