// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "api/random_cases.hpp"
#include "frame/mesh/render.hpp"
#include "frame/plateaus.hpp"
#include "reference/judge.hpp"

/// Fields that differ from a step's value by only some last places over whole regions, like saturated fields.
namespace tessera::frame::plateau_test {
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
  Settings settings;
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

/// Knots that the lattice cannot distinguish.
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
  Settings settings;
  FrameStatistics statistics;
  Renderer(mesh, settings).render(view(ProjectionKind::orthographic), size, function, &statistics);
  EXPECT_FALSE(statistics.on_lattice);
}

/// Knots with a step at each of `steps` and a few others; between steps some last places apart the function is
/// constant.
scene::TransferFunction random_function(Random& random, std::vector<double> steps, double low, double high) {
  const double dense = random.power(-0.5, 2.2), near = 1e-3 * (high - low);
  const auto optics = [&](double value) {
    const glm::dvec3 color(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    return scene::Knot{value, color, random.chance(0.3) ? 0 : dense * random.uniform(0, 1)};
  };
  std::vector<std::pair<double, bool>> places;
  for (const double step : steps) places.emplace_back(step, true);
  for (int i = random.below(4); i-- > 0;) {
    const double value = random.uniform(low, high);
    if (std::all_of(steps.begin(), steps.end(), [&](double s) { return std::abs(value - s) > near; }))
      places.emplace_back(value, false);
  }
  std::sort(places.begin(), places.end());
  std::vector<scene::Knot> knots;
  for (const auto& [value, step] : places) {
    if (step) {
      knots.push_back(optics(value));
      if (knots.size() > 1 && value - knots[knots.size() - 2].value < near) {
        knots.back() = knots[knots.size() - 2];
        knots.back().value = value;
      }
    }
    knots.push_back(optics(value));
  }
  return scene::TransferFunction(knots);
}

scene::Camera random_camera(Random& random) {
  scene::Camera camera;
  const glm::dvec3 at(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
  glm::dvec3 towards = random.direction();
  if (random.chance(0.2)) {
    towards = glm::dvec3(0);
    towards[random.below(3)] = random.chance(0.5) ? 1 : -1;
  }
  camera.position = at + towards * (random.chance(0.1) ? random.uniform(0.01, 0.5) : random.uniform(2.2, 5));
  camera.focal_point = at;
  camera.view_up = std::abs(towards.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  camera.projection = random.chance(0.5) ? ProjectionKind::orthographic : ProjectionKind::perspective;
  camera.parallel_scale = random.uniform(0.2, 1.8);
  camera.view_angle = random.uniform(15, 110);
  return camera;
}

RandomCase random_plateau(Random& random) {
  constexpr int numbers_of_places[] = {0, 1, 1, 2, 3, 16, 64, 256, 1000, 10000, 1000000};
  constexpr std::array<double, 2> ranges[] = {{0, 1}, {-1, 1}, {1000, 1001}, {-3.7, 12.5}, {0, 1e-5}};
  enum Shape { saturating, noise, under, alternating, everywhere };
  constexpr Shape shapes[] = {saturating, noise, noise, under, alternating, everywhere};
  const LastPlace kind = random.chance(0.5) ? LastPlace::of_float : LastPlace::of_double;
  const auto rounded = [&](double v) { return kind == LastPlace::of_float ? double{static_cast<float>(v)} : v; };
  const auto [low, high] = random.of(ranges);
  const double span = high - low;
  const double levels[] = {rounded(high), rounded(high), rounded(low), rounded(low + span * random.uniform(0.2, 0.8)),
                           rounded(low + span / 2)};
  double level = random.of(levels);
  if (level == 0) level = rounded(span * 1e-3);
  const double sign = level == rounded(high) ? -1 : level == rounded(low) || random.chance(0.5) ? 1 : -1;
  std::vector<double> steps{level};
  for (int i = random.chance(0.5) ? random.below(4) : 0; i-- > 0;)
    steps.push_back(rounded(low + span * random.uniform(0.1, 0.9)));
  constexpr int apart[] = {1, 2, 16, 1000};
  if (random.chance(0.1)) steps.push_back(beside(level, random.of(apart), kind));
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());

  RandomCase c{datasets::cube(1 + random.below(5), random.chance(0.5) ? 0.2 : 0, random.bits()),
               random_camera(random),
               random_function(random, steps, low, high),
               {}};
  const glm::dvec3 normal = random.direction();
  const double offset = random.uniform(-0.6, 0.6), steep = random.power(0.3, 2);
  const int places = random.of(numbers_of_places);
  const Shape shape = random.of(shapes);
  int number = 0;
  const auto field = [&](const glm::dvec3& p) {
    const double u = glm::dot(normal, p) - offset;
    const int i = ++number;
    if (shape == saturating) return rounded(level + sign * span / 2 * (1 - std::tanh(steep * u)));
    if (shape != everywhere && u < 0) return rounded(level + sign * span * std::min(1.0, -u * steep / 10));
    if (shape == alternating) return beside(level, i % 2 != 0 ? places : -places, kind);
    if (shape == under) return beside(level, -places * random.below(2), kind);
    return beside(level, random.chance(0.5) ? places * (random.below(3) - 1) : random.below(2 * places + 1) - places,
                  kind);
  };
  std::vector<double> scalars;
  if (random.chance(0.25)) {
    c.mesh.association = scene::Association::cell;
    for (const scene::Tet& t : c.mesh.tets)
      scalars.push_back(field(
          (c.mesh.positions[t[0]] + c.mesh.positions[t[1]] + c.mesh.positions[t[2]] + c.mesh.positions[t[3]]) / 4.0));
  } else {
    for (const glm::dvec3& p : c.mesh.positions) scalars.push_back(field(p));
  }
  c.mesh.scalars = std::move(scalars);
  c.words = "shape " + std::to_string(shape) + ", " + std::to_string(places) + " last places of a " +
            (kind == LastPlace::of_float ? "float" : "double") + " round " + std::to_string(level) +
            (c.mesh.association == scene::Association::cell ? ", cell data" : "");
  return c;
}

TEST(Plateau, RandomPlateausKeepThePromise) { expect_random_cases_right(5, 100, random_plateau); }

}  // namespace
}  // namespace tessera::frame::plateau_test
