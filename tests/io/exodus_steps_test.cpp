// Exodus files whose nodes move with time, which its own library writes here: times, displacements, `warp`.
#include <gtest/gtest.h>
#include <vtk_exodusII.h>

#include <array>
#include <string>
#include <vector>

#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"
#include "io/warp.hpp"
#include "tessera/dataset.hpp"

namespace tessera::io::exodus_steps_test {
namespace {

/// A unit cube at times 0.5, 0.75 and 4. Of each vector the nodes at x = 1 have (step, 0, 0), the others 0.
void write_cube(const std::filesystem::path& file, const std::vector<std::string>& vectors) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(file.c_str(), EX_CLOBBER, &word, &stored);
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
  MeshOptions options;
  options.warp = warp;
  options.time_step = step;
  return testing::volume(read_mesh(file, options).mesh);
}

TEST(ExodusSteps, AreAtTheirTimes) {
  const test::TemporaryFolder folder;
  write_cube(folder / "a.exo", {"v_"});
  const TimeStepRead steps = time_steps_of_mesh(folder / "a.exo");
  EXPECT_EQ(steps.times, (std::vector<double>{0.5, 0.75, 4}));
  EXPECT_EQ(times_of(folder / "a.exo"), steps.times);
  const MeshFile last = read_mesh(folder / "a.exo");
  EXPECT_EQ(last.time_step.step, 2u);
  EXPECT_EQ(last.notes.front().substr(0, 28), "time step 2 of 0 to 2, time ") << last.notes.front();
  const Dataset first = Dataset::open(folder / "a.exo", {.time_step = 0});
  EXPECT_EQ(first.time(), 0.5);
  EXPECT_EQ(first.times().size(), 3u);
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
  write_cube(folder / "a.exo", {"disp", "displacement"});  // the first alone
  EXPECT_NEAR(volume_of(folder / "a.exo"), 4, 1e-12);
  EXPECT_EQ(std::ranges::count(read_mesh(folder / "a.exo").notes, "nodes are displaced by 'disp'"), 1);
}

TEST(ExodusSteps, AWarpNamesVectorAndFactor) {
  const test::TemporaryFolder folder;
  write_cube(folder / "a.exo", {"disp_", "dissipation_"});
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"disp", 10}), 31, 1e-12);
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"disp", -0.1}), 0.7, 1e-12);
  EXPECT_NEAR(volume_of(folder / "a.exo", Warp{"dissipation", 2}), 7, 1e-12);
  test::expect_bad_input([&] { volume_of(folder / "a.exo", Warp{"dips"}); },
                         {"`warp`: no point vector 'dips'", "did you mean 'disp'?", "'dissipation'"});
}

}  // namespace
}  // namespace tessera::io::exodus_steps_test
