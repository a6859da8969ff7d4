// SPDX-License-Identifier: BSD-3-Clause
// A clip or a threshold does not change colours, opacities and their unit distance: these are derived from all the
// data.
#include <gtest/gtest.h>

#include <filesystem>

#include "api/communicator.hpp"
#include "api/query_data.hpp"
#include "datasets/boxes.hpp"
#include "exchange/loopback_transport.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "support/temporary_folder.hpp"

namespace tessera {
namespace {

struct Colors {
  std::array<double, 2> range;
  std::vector<Knot> by_default, by_name, by_logarithm;
  double unit_distance;
};

std::vector<Knot> knots_of(const LoadedTransferFunction& loaded) {
  const auto knots = loaded.function.knots();
  return {knots.begin(), knots.end()};
}

Colors colors_of(const Dataset& data) {
  TransferFunctionOptions logarithmic;
  logarithmic.logarithmic = true;
  const LoadedTransferFunction by_default = data.transfer_function("", {});
  return {data.range(), knots_of(by_default), knots_of(data.transfer_function("viridis:ramp", {})),
          knots_of(data.transfer_function("", logarithmic)), by_default.unit_distance.value_or(0)};
}

void expect_same(const Colors& a, const Colors& b) {
  EXPECT_EQ(a.range, b.range);
  EXPECT_EQ(a.unit_distance, b.unit_distance);
  EXPECT_TRUE(a.by_default == b.by_default);
  EXPECT_TRUE(a.by_name == b.by_name);
  EXPECT_TRUE(a.by_logarithm == b.by_logarithm);
}

/// A field that varies everywhere, above 0.
double field_at(const glm::dvec3& p) { return 2 + p.x + p.y * p.z + 0.3 * p.z; }

scene::TetMesh varied_cube() { return tests::with_field(datasets::cube(6), field_at); }

std::vector<Selection> selections(const std::array<double, 2>& range) {
  const std::vector<HalfSpace> clip = {{{0.1, 0, 0}, {1, 0.2, 0.1}}};
  const std::array<double, 2> lower = {range[0], (range[0] + range[1]) / 2};
  return {{clip}, {{}, lower}, {clip, lower}};
}

TEST(SelectionColors, AreThoseOfAllOfAMesh) {
  const Dataset whole = Dataset::of(datasets::arrays_of(varied_cube()));
  const Colors colors = colors_of(whole);
  for (const Selection& selection : selections(whole.range())) {
    const Dataset part = whole.selected(selection);
    EXPECT_LT(part.tet_count(), whole.tet_count());
    expect_same(colors_of(part), colors);
    expect_same(colors_of(part.selected({{{{0, 0.1, 0}, {0, 1, 0}}}})), colors);
  }
}

TEST(SelectionColors, AreThoseOfAllOfAFileOnAnyRanks) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.tets";
  io::write_tets(varied_cube(), file);
  const Dataset whole = Dataset::open(file, {});
  const Colors colors = colors_of(whole);
  for (const Selection& selection : selections(whole.range()))
    for (const int ranks : {1, 2, 3}) {
      ReadOptions options;
      options.selection = selection;
      std::vector<std::uint64_t> tets(static_cast<std::size_t>(ranks));
      exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
        const Dataset part = Dataset::open(std::span(&file, 1), options, api::communicator_over(transport), {});
        expect_same(colors_of(part), colors);
        tets[static_cast<std::size_t>(transport.rank())] = part.tet_count();
      });
      EXPECT_LT(tets.front(), whole.tet_count());
    }
}

TEST(SelectionColors, AreThoseOfAllOfAVolume) {
  const test::TemporaryFolder folder;
  std::string bytes = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n";
  for (int i = 0; i < 512; ++i) bytes += static_cast<char>(1 + (i * 37 + i / 8 * 11) % 200);
  const std::filesystem::path file = folder.write("a.nrrd", bytes);
  const Colors colors = colors_of(Dataset::open(file, {}));
  ReadOptions options;
  options.selection.threshold = {40, 120};
  expect_same(colors_of(Dataset::open(file, options)), colors);
  options.selection.clip = {{{3.5, 0, 0}, {1, 0, 0}}};
  expect_same(colors_of(Dataset::open(file, options)), colors);
}

}  // namespace
}  // namespace tessera
