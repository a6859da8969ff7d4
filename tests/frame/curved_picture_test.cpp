// SPDX-License-Identifier: BSD-3-Clause
// Images of higher-order cells, compared with the reference that uses their true faces and fields.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "api/random_cases.hpp"
#include "reference/curved/curved_reference.hpp"
#include "reference/curved/curved_shapes.hpp"
#include "reference/judge.hpp"
#include "support/curved_meshes.hpp"
#include "support/mesh_checks.hpp"
#include "tessera/dataset.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/session.hpp"

namespace tessera::frame::curved_picture_test {
namespace {

constexpr ImageSize size{24, 24};

Camera random_camera(Random& random) {
  Camera camera;
  camera.focal_point = {random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), random.uniform(0.3, 0.7)};
  camera.position = camera.focal_point + 4.0 * random.direction();
  camera.view_up = random.direction();
  camera.projection = random.chance(0.5) ? ProjectionKind::perspective : ProjectionKind::orthographic;
  camera.parallel_scale = random.uniform(0.5, 0.9);
  camera.view_angle = random.uniform(12, 26);
  return camera;
}

/// Ramps without steps; an average ray is half opaque.
TransferFunction random_function(Random& random, const std::array<double, 2>& range) {
  std::vector<Knot> knots;
  const int count = 2 + random.below(4);
  knots.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    knots.push_back({range[0] + (range[1] - range[0]) * k / (count - 1),
                     {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                     random.chance(0.2) ? 0 : random.uniform(0, 2)});
  return TransferFunction(knots);
}

/// Some cells in formats lack nodes in faces or inside. No source defines their shape functions, so the reference does
/// not support them.
bool is_in_reference(const io::testing::Kind& kind) {
  try {
    return !reference::cell_shape(kind.type, kind.nodes, kind.degrees, "").nodes.empty();
  } catch (const Error&) {
    return false;
  }
}

struct Case {
  cells::CellBlock block;
  std::string words;
};

/// A random mesh that is smooth enough for the requested small error: few and nearly straight cells.
Case random_case(Random& random, double accuracy) {
  std::vector<io::testing::Kind> kinds = io::testing::kinds;
  std::erase_if(kinds, [](const io::testing::Kind& k) { return !is_in_reference(k); });
  const io::testing::Kind& kind = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
  const double rough = std::sqrt(accuracy), bend = random.uniform(0.1, 0.5) * rough,
               wave = random.uniform(0.5, 3) * rough;
  const glm::dvec3 phase(random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 6));
  const auto warp = [=](const glm::dvec3& p) {
    return glm::dvec3(p.x + bend * std::sin(3 * p.y + p.z + phase.x), p.y + bend * std::sin(2 * p.z + p.x + phase.y),
                      p.z + bend * std::sin(3 * p.x - p.y + phase.z));
  };
  const auto field = [=](const glm::dvec3& p) {
    return p.x + 0.5 * p.y - p.z + wave * std::sin(2 * p.x + phase.z) * std::cos(2 * p.y - p.z);
  };
  // If serendipity cells are rotated, their sides do not match those of their neighbours.
  return {io::testing::warped_box(kind, 1 + random.below(2), warp, field, random.chance(0.5)),
          "type " + std::to_string(static_cast<int>(kind.type)) + " of " + std::to_string(kind.nodes) + " nodes"};
}

/// The cells in the reference's form.
struct Truth {
  explicit Truth(const cells::CellBlock& block) {
    scalars.resize(block.positions.size());
    for (const cells::BlockField& field : block.fields) {
      if (field.name == "f") field.read(0, 0, scalars);
      if (field.name != "HigherOrderDegrees") continue;
      degrees.resize(field.tuples);
      std::vector<double> numbers(field.tuples);
      for (int c = 0; c < 3; ++c) {
        field.read(c, 0, numbers);
        for (std::size_t k = 0; k < numbers.size(); ++k)
          degrees[k][static_cast<std::size_t>(c)] = static_cast<int>(numbers[k]);
      }
    }
    cells = {block.types, block.offsets, block.connectivity, block.positions, Association::point, scalars, degrees};
  }
  std::vector<double> scalars;
  std::vector<std::array<int, 3>> degrees;
  reference::CurvedCells cells;
};

TEST(CurvedPicture, IsWithinTheAccuracyAskedFor) {
  const int first = wanted("TESSERA_RANDOM_FIRST", 0), last = first + wanted("TESSERA_RANDOM_CASES", 4);
  const test::TemporaryFolder folder;
  std::size_t excused = 0, pixels = 0, met = 0, near = 0;
  double worst = 0;
  std::uint64_t tets = 0;
  for (int number = first; number < last; ++number) {
    Random random(7000003u + static_cast<std::uint64_t>(number));
    // The last two, which take a million tets per mesh, are used only if more cases are requested.
    static constexpr std::array accuracies = {1e-2, 1e-3, 1e-2, 1e-3, 1e-4, 1e-5, 1e-4, 1e-5};
    const double accuracy = accuracies[static_cast<std::size_t>(number) % accuracies.size()];
    const Case made = random_case(random, accuracy);
    SCOPED_TRACE(made.words + ", case " + std::to_string(number));
    const auto file = folder.write("mesh.vtu", io::testing::vtu_text(made.block));
    ReadOptions options;
    options.field = "point:f";
    options.higher_order_tolerance = accuracy;
    options.higher_order_tets = std::uint64_t{1} << 23;
    Dataset data = Dataset::open(file, options);
    const TransferFunction function = random_function(random, data.range());
    const Camera camera = random_camera(random);
    HigherOrderRead read = read_for_accuracy(
        options, accuracy, [&](const ReadOptions& with) { return Dataset::open(file, with); },
        [&](const Dataset&) -> const TransferFunction& { return function; },
        [&](const Dataset&) {
          return View{camera, size};
        });
    data = std::move(read.dataset);
    const double stated = read.pixel_error;
    Settings settings;
    settings.integrator.kind = IntegratorKind::exact;  // so that only the cells cause errors
    const RenderedFrame frame = Session(data, settings).render({camera, size}, function);
    const Truth truth(made.block);
    const reference::CurvedReference reference(truth.cells, camera, size, function);
    const reference::Judgement judgement = reference::judge(frame.image, reference, std::max(accuracy, stated));
    EXPECT_LE(judgement.max_error_not_excused, std::max(accuracy, stated))
        << judgement.over_bound << " over at (" << judgement.worst_x << ", " << judgement.worst_y << "), accuracy "
        << accuracy << ", stated " << stated << ", " << data.higher_order_cells().tets << " tets";
    EXPECT_GT(judgement.pixels_checked, 0u);
    met += stated <= accuracy;
    near += stated <= 4 * judgement.max_error_not_excused;
    worst = std::max(worst, judgement.max_error_not_excused / std::max(accuracy, stated));
    excused += judgement.excused, pixels += judgement.pixels_checked;
    tets += data.higher_order_cells().tets;
  }
  EXPECT_LE(static_cast<double>(excused), 1e-4 * static_cast<double>(pixels) + 3);
  EXPECT_GE(met, static_cast<std::size_t>((last - first) * 9 / 10)) << "accuracies were not reached";
  EXPECT_GE(near, static_cast<std::size_t>((last - first) / 2)) << "what is stated is far from the truth";
  std::printf(
      "cases %d to %d: %zu reached the accuracy; largest error %.3g of it, %zu of %zu pixels excused, %llu tets\n",
      first, last - 1, met, worst, excused, pixels, static_cast<unsigned long long>(tets));
}

}  // namespace
}  // namespace tessera::frame::curved_picture_test
