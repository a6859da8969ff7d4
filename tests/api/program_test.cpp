// SPDX-License-Identifier: BSD-3-Clause
// Parts of the library that the program uses beyond the installed API: plans of films, and files that appear whole.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "support/temporary_folder.hpp"
#include "tessera/dataset.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr ImageSize size{61, 47};

fs::path touched(const test::TemporaryFolder& folder, const char* name) { return folder.write(name, "x"); }

TEST(FilmPlans, NumbersStepsTimesViewsAndRecognizesFinishedFrames) {
  const test::TemporaryFolder folder;
  FilmPlan plan;
  plan.inputs = {touched(folder, "a.tets"), touched(folder, "b.tets")};
  plan.orbit = 2;
  plan.size = size;
  plan.outputs = {folder / "f_%02d.png", folder / "f_%02d.pfm"};
  plan.resume = true;
  touched(folder, "f_00.png"), touched(folder, "f_00.pfm"), touched(folder, "f_02.png");
  const auto frames = plan_film(plan);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_TRUE(is_series(plan));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].number, static_cast<int>(i));
    EXPECT_EQ(frames[i].step, i / 2);
    EXPECT_EQ(frames[i].data.files.front(), plan.inputs[i / 2]);
    EXPECT_EQ(frames[i].turn.value(), i % 2 == 0 ? 0.0 : 0.5);
    EXPECT_EQ(frames[i].finished, i == 0) << i;  // frame 2 has one image missing
  }
  EXPECT_EQ(frames[3].outputs[1], folder / "f_03.pfm");
  // After half a turn, the eye is on the other side of the box, and the box is still in view.
  const Box box{{0, 0, 0}, {2, 2, 2}};
  const Camera first = frames[0].view(box, ProjectionKind::orthographic);
  const Camera turned = frames[1].view(box, ProjectionKind::orthographic);
  EXPECT_EQ(first.focal_point, turned.focal_point);
  EXPECT_NEAR(first.position.x - 1, 1 - turned.position.x, 1e-12);

  EXPECT_NO_THROW(frames[3].require_still_there());
  fs::remove(plan.inputs[1]);
  EXPECT_THROW(frames[3].require_still_there(), Error);
  EXPECT_THROW(plan_film(plan), Error);
}

TEST(FilmPlans, LaterStepsHaveTheFieldOfTheFirst) {
  const std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, scalars{0, 1, 2, 3};
  const std::vector<std::uint32_t> tets{0, 1, 2, 3};
  MeshArrays arrays;
  arrays.points = points, arrays.tets = tets, arrays.scalars = scalars;
  const Dataset of_points = Dataset::of(arrays);
  EXPECT_EQ(read_of_later_steps({}, of_points).field, "point:scalar");
  EXPECT_EQ(read_of_later_steps({.smooth = true}, of_points).field, "scalar");
  EXPECT_EQ(read_of_later_steps({.field = "p"}, of_points).field, "p");
  const std::vector<double> of_cell{7};
  arrays.scalars = of_cell, arrays.association = Association::cell;
  EXPECT_EQ(read_of_later_steps({}, Dataset::of(arrays)).field, "cell:scalar");
}

TEST(FilmPlans, RefusesInvalidNamesBeforeRendering) {
  const test::TemporaryFolder folder;
  FilmPlan plan;
  plan.inputs = {touched(folder, "a.tets")};
  plan.outputs = {folder / "one.png"};
  auto frames = plan_film(plan);
  EXPECT_NO_THROW(check_film_outputs(frames, {}, {}));
  const auto refused = [&](std::vector<fs::path> more, std::vector<fs::path> inputs) {
    EXPECT_THROW(check_film_outputs(frames, more, inputs), Error);
  };
  refused({folder / "one.png"}, {});                    // named twice
  refused({folder / "nowhere" / "report.json"}, {});    // no such directory
  refused({folder / "a.tets"}, {plan.inputs.front()});  // an input
  frames.front().outputs = {folder / "one.gif"};
  refused({}, {});
  frames.front().outputs = {plan.inputs.front()};
  refused({}, {});
  plan.orbit = 3;
  EXPECT_THROW(plan_film(plan), Error);  // three frames with one name
  plan.inputs.clear();
  EXPECT_THROW(plan_film(plan), Error);
}

TEST(OutputFiles, TextIsWrittenWhole) {
  const test::TemporaryFolder folder;
  write_text(folder / "a.json", R"({"a": 1, "b": [2]})");
  EXPECT_EQ(read_text(folder / "a.json"), R"({"a": 1, "b": [2]})");
  EXPECT_THROW(write_text(folder / "nowhere" / "a.json", "x"), OutputFault);
  EXPECT_THROW(check_output(folder / "a.json", folder / "a.json"), Error);
  { const AtomicFile begun(folder / "b.json"); }
  EXPECT_FALSE(fs::exists(folder / "b.json"));  // never committed
}

}  // namespace
}  // namespace tessera
