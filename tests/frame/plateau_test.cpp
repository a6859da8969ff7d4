#include <gtest/gtest.h>

#include "frame/plateaus.hpp"
#include "frame/render.hpp"
#include "reference/judge.hpp"

/// Fields that lie within some last places of a step's value over whole regions, as saturated ones do.
namespace tessera::frame {
namespace {

using scene::ProjectionKind;

constexpr double promised_error = 2e-5;
constexpr scene::ImageSize size{32, 24};

scene::Camera view(ProjectionKind kind) {
  scene::Camera camera;
  camera.position = {2.9, 2.1, 4.3};
  camera.projection = kind;
  camera.parallel_scale = 1.5;
  camera.view_angle = 38;
  return camera;
}

void expect_promise(const scene::TetMesh& mesh, const scene::TransferFunction& function, bool lattice) {
  RenderSettings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  settings.use.lattice = lattice;
  for (const ProjectionKind kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    FrameStatistics statistics;
    const scene::Image image = Renderer(mesh, settings).render(view(kind), size, function, &statistics);
    EXPECT_EQ(statistics.on_lattice, lattice);
    const reference::Reference reference(mesh, view(kind), size, function);
    const reference::Judgement judgement = reference::judge(image, reference, promised_error);
    EXPECT_LE(judgement.max_error_not_excused, promised_error)
        << judgement.over_bound << " over, " << judgement.excused << " excused";
  }
}

struct Plateau {
  int places;
  LastPlace kind;
  bool cells;
};
void PrintTo(const Plateau& p, std::ostream* out) {
  *out << p.places << " last places of a " << (p.kind == LastPlace::of_float ? "float" : "double")
       << (p.cells ? ", cell data" : "");
}

class Plateaus : public testing::TestWithParam<Plateau> {};
INSTANTIATE_TEST_SUITE_P(
    Frame, Plateaus,
    testing::Values(Plateau{0, LastPlace::of_float, false}, Plateau{1, LastPlace::of_float, false},
                    Plateau{16, LastPlace::of_float, false}, Plateau{256, LastPlace::of_float, false},
                    Plateau{10000, LastPlace::of_float, false}, Plateau{1, LastPlace::of_double, false},
                    Plateau{16, LastPlace::of_double, false}, Plateau{100000, LastPlace::of_double, false},
                    Plateau{1, LastPlace::of_float, true}, Plateau{1, LastPlace::of_double, true}));

TEST_P(Plateaus, ShowEachSideOfAStepWhereItIs) {
  const auto [places, kind, cells] = GetParam();
  for (const double level : {1.0, 0.7f * 1.0}) {
    const scene::TetMesh mesh = plateau(level, places, kind, cells, 11);
    for (const bool up : {true, false}) {
      const scene::TransferFunction function = step_at(level, up);
      expect_promise(mesh, function, true);
      expect_promise(mesh, function, false);
    }
  }
}

/// Knots that the lattice cannot tell apart.
TEST(Plateau, BetweenTwoStepsTooCloseForTheLatticeGoesInDoublePrecision) {
  const double low = 0.5, high = beside(low, 4, LastPlace::of_double);
  const scene::TransferFunction function({{0, {0.2, 0.3, 0.9}, 0.1},
                                          {low, {0.2, 0.3, 0.9}, 0.1},
                                          {low, {0.9, 0.2, 0.1}, 4},
                                          {high, {0.9, 0.2, 0.1}, 4},
                                          {high, {0.2, 0.9, 0.1}, 0.3},
                                          {1, {0.2, 0.9, 0.1}, 0.3}});
  scene::TetMesh mesh = plateau(low, 1, LastPlace::of_double, false, 3);
  for (double& s : mesh.scalars)
    if (s >= low) s = beside(low, 2, LastPlace::of_double);
  mesh.scalars[0] = 1;
  expect_promise(mesh, function, false);
  RenderSettings settings;
  FrameStatistics statistics;
  Renderer(mesh, settings).render(view(ProjectionKind::orthographic), size, function, &statistics);
  EXPECT_FALSE(statistics.on_lattice);
}

}  // namespace
}  // namespace tessera::frame
