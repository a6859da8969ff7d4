// SPDX-License-Identifier: BSD-3-Clause
#include "support/amr_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"

namespace tessera::io::testing {
namespace {

/// Numbers as stored in a FAB.
std::string bytes_of(const std::vector<double>& values, bool single, bool big_endian) {
  std::string bytes;
  for (const double value : values) {
    std::string word(single ? 4 : 8, '\0');
    const auto narrow = static_cast<float>(value);
    std::memcpy(word.data(), single ? static_cast<const void*>(&narrow) : &value, word.size());
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(word.begin(), word.end());
    bytes += word;
  }
  return bytes;
}

std::string box_text(const std::array<int, 3>& low, const std::array<int, 3>& high) {
  return fmt::format("(({},{},{}) ({},{},{}) (0,0,0))", low[0], low[1], low[2], high[0], high[1], high[2]);
}

std::string number_format(const AmrexWish& wish) {
  if (wish.single)
    return fmt::format("((8, (32 8 23 0 1 9 0 127)),(4, ({})))", wish.big_endian ? "1 2 3 4" : "4 3 2 1");
  return fmt::format("((8, (64 11 52 0 1 12 0 1023)),(8, ({})))",
                     wish.big_endian ? "1 2 3 4 5 6 7 8" : "8 7 6 5 4 3 2 1");
}

std::array<int, 3> moved(std::array<int, 3> p, int by) {
  for (int& n : p) n += by;
  return p;
}

}  // namespace

bool Block::holds(const glm::dvec3& p) const {
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    if (p[a] * parts < first[axis] || p[a] * parts >= last[axis] + 1) return false;
  }
  return true;
}

double linear(const glm::dvec3& p) { return 1 + 2 * p.x - 3 * p.y + 0.5 * p.z; }
double wavy(const glm::dvec3& p) { return std::sin(5 * p.x) + std::cos(7 * p.y) * std::sin(3 * p.z); }

const Block& AmrScene::block_at(const glm::dvec3& p) const {
  const Block* found = &blocks.front();
  for (const Block& block : blocks)
    if (block.holds((p - origin) / unit) && (block.parts > found->parts || !found->holds((p - origin) / unit)))
      found = &block;
  return *found;
}

glm::dvec3 AmrScene::centre_at(const glm::dvec3& p) const {
  const double size = spacing(block_at(p));
  return origin + size * (glm::floor((p - origin) / size) + 0.5);
}

glm::dvec3 AmrScene::low(const Block& block) {
  return origin + spacing(block) * glm::dvec3(block.first[0], block.first[1], block.first[2]);
}

std::vector<double> AmrScene::values(const Block& block, bool points, const Field& at) {
  std::vector<double> values;
  const int more = points ? 1 : 0;
  for (int k = 0; k < block.cells(2) + more; ++k)
    for (int j = 0; j < block.cells(1) + more; ++j)
      for (int i = 0; i < block.cells(0) + more; ++i)
        values.push_back(at(low(block) + spacing(block) * (glm::dvec3(i, j, k) + (points ? 0.0 : 0.5))));
  return values;
}

AmrScene nested_blocks() {
  return {{{0, 1, {0, 0, 0}, {3, 3, 3}},
           {1, 2, {2, 2, 2}, {5, 5, 5}},
           {2, 4, {6, 6, 6}, {9, 9, 9}},
           {2, 4, {12, 12, 0}, {15, 15, 3}}}};
}

std::filesystem::path write_vth(const test::TemporaryFolder& folder, const AmrScene& scene, bool points,
                                const Field& at) {
  std::string list;
  for (std::size_t b = 0; b < scene.blocks.size(); ++b) {
    const Block& block = scene.blocks[b];
    std::string values;
    for (const double value : AmrScene::values(block, points, at)) values += fmt::format("{} ", value);
    const glm::dvec3 low = AmrScene::low(block);
    folder.write(
        fmt::format("b{}.vti", b),
        fmt::format("<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\"><ImageData "
                    "WholeExtent=\"{0}\" Origin=\"{1} {2} {3}\" Spacing=\"{4} {4} {4}\"><Piece Extent=\"{0}\"><{5}>"
                    "<DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">{6}</DataArray></{5}></Piece></ImageData>"
                    "</VTKFile>",
                    fmt::format("0 {} 0 {} 0 {}", block.cells(0), block.cells(1), block.cells(2)), low.x, low.y, low.z,
                    AmrScene::spacing(block), points ? "PointData" : "CellData", values));
    list += fmt::format("<Block level=\"{}\"><DataSet index=\"0\" file=\"b{}.vti\"/></Block>", block.level, b);
  }
  return folder.write("amr.vth", fmt::format("<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\"><vtkOverlappingAMR>{}"
                                             "</vtkOverlappingAMR></VTKFile>",
                                             list));
}

namespace {

/// One level's directory, and its part of the Header.
std::string write_amrex_level(const std::filesystem::path& plot, int level, int shift, const AmrScene& scene,
                              const Field& at, const AmrexWish& wish) {
  std::string boxes, fabs, ends;
  std::array<std::string, 2> data;
  std::size_t count = 0;
  for (const Block& block : scene.blocks) {
    if (block.level != level) continue;
    const double size = AmrScene::spacing(block);
    const glm::dvec3 low = AmrScene::low(block);
    std::vector<double> values, others;
    for (int k = -wish.around; k < block.cells(2) + wish.around; ++k)
      for (int j = -wish.around; j < block.cells(1) + wish.around; ++j)
        for (int i = -wish.around; i < block.cells(0) + wish.around; ++i) {
          const bool is_own =
              i >= 0 && j >= 0 && k >= 0 && i < block.cells(0) && j < block.cells(1) && k < block.cells(2);
          values.push_back(is_own ? at(low + size * (glm::dvec3(i, j, k) + 0.5)) : 1e30);
          others.push_back(-7);
        }
    const std::size_t number = wish.two_files ? count % 2 : 0;
    std::string& file = data[number];
    boxes += fmt::format("{}\n", box_text(moved(block.first, shift), moved(block.last, shift)));
    fabs += fmt::format("FabOnDisk: Cell_D_0000{} {}\n", number, file.size());
    file += fmt::format("FAB {}{} 2\n", number_format(wish),
                        box_text(moved(block.first, shift - wish.around), moved(block.last, shift + wish.around)));
    file += bytes_of(others, wish.single, wish.big_endian);
    file += bytes_of(values, wish.single, wish.big_endian);
    for (std::size_t a = 0; a < 3; ++a) {
      const double begin = low[static_cast<int>(a)];
      ends += fmt::format("{} {}\n", begin, begin + size * block.cells(a));
    }
    ++count;
  }
  const std::filesystem::path folder = plot / fmt::format("Level_{}", level);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "Cell_H") << fmt::format("1\n1\n2\n{}\n({} 0\n{})\n{}\n{}\n", wish.around, count, boxes, count,
                                                  fabs);
  for (std::size_t n = 0; n < (wish.two_files ? 2u : 1u); ++n)
    std::ofstream(folder / fmt::format("Cell_D_0000{}", n), std::ios::binary) << data[n];
  return fmt::format("{} {} 0.25\n10\n{}Level_{}/Cell\n", level, count, ends, level);
}

}  // namespace

std::filesystem::path write_amrex(const test::TemporaryFolder& folder, const AmrScene& scene, const Field& at,
                                  const AmrexWish& wish) {
  const std::filesystem::path plot = folder.path() / "plt00010";
  std::filesystem::remove_all(plot);
  std::vector<int> parts;
  for (const Block& block : scene.blocks) {
    parts.resize(std::max<std::size_t>(parts.size(), static_cast<std::size_t>(block.level) + 1), 1);
    parts[static_cast<std::size_t>(block.level)] = block.parts;
  }
  const Block& coarsest = scene.blocks.front();
  std::string ratios, domains, steps, sizes, lists;
  for (std::size_t level = 0; level < parts.size(); ++level) {
    const int here = parts[level], shift = wish.first_cell * here / parts[0];
    std::array<int, 3> first = coarsest.first, last = coarsest.last;
    for (std::size_t a = 0; a < 3; ++a)
      first[a] = first[a] * here / parts[0], last[a] = (last[a] + 1) * here / parts[0] - 1;
    if (level + 1 < parts.size()) ratios += fmt::format("{} ", parts[level + 1] / here);
    domains += fmt::format("{} ", box_text(moved(first, shift), moved(last, shift)));
    steps += fmt::format("{} ", 10);
    sizes += fmt::format("{0} {0} {0}\n", AmrScene::unit / here);
    lists += write_amrex_level(plot, static_cast<int>(level), shift, scene, at, wish);
  }
  const glm::dvec3 low = AmrScene::low(coarsest);
  std::ofstream(plot / "Header") << fmt::format(
      "HyperCLaw-V1.1\n2\nother one\nf\n3\n0.25\n{}\n{} {} {}\n9 9 9\n{}\n{}\n{}\n{}0\n0\n{}", parts.size() - 1, low.x,
      low.y, low.z, ratios, domains, steps, sizes, lists);
  return plot;
}

void expect_conforming(const scene::TetMesh& mesh, const glm::dvec3& sides) {
  const double whole = sides.x * sides.y * sides.z;
  EXPECT_NEAR(volume(mesh), whole, 1e-12 * whole);
  double area = 0;
  for (const auto& [triangle, uses] : count_triangles(mesh)) {
    ASSERT_LE(uses, 2);
    if (uses == 2) continue;
    std::array<glm::dvec3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = {triangle[k][0], triangle[k][1], triangle[k][2]};
    area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  EXPECT_NEAR(area, 2 * (sides.x * sides.y + sides.y * sides.z + sides.z * sides.x), 1e-12 * area)
      << "some triangles inside have one tet only: hanging corners";
  std::map<Point, double> value;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3& p = mesh.positions[v];
    const auto [at, is_new] = value.emplace(Point{p.x, p.y, p.z}, mesh.scalars[v]);
    ASSERT_TRUE(is_new || at->second == mesh.scalars[v]) << "two values at one place";
  }
}

void expect_cells(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, double tolerance) {
  ASSERT_EQ(mesh.association, scene::Association::cell);
  const double whole = std::pow(side * AmrScene::unit, 3);
  EXPECT_NEAR(volume(mesh), whole, 1e-12 * whole);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : mesh.tets[t]) centre += 0.25 * mesh.positions[v];
    ASSERT_NEAR(mesh.scalars[t], at(scene.centre_at(centre)), tolerance);
  }
}

void expect_smooth(const scene::TetMesh& mesh, const AmrScene& scene, double side, const Field& at, bool is_linear,
                   double tolerance) {
  ASSERT_EQ(mesh.association, scene::Association::point);
  expect_conforming(mesh, glm::dvec3(side * AmrScene::unit));
  std::size_t centres = 0, inner = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3 p = mesh.positions[v], lattice = (p - AmrScene::origin) / AmrScene::unit;
    if (glm::length(scene.centre_at(p) - p) < 1e-9) {
      ++centres;
      EXPECT_NEAR(mesh.scalars[v], at(p), tolerance);
    }
    const double margin =
        std::min({lattice.x, lattice.y, lattice.z, side - lattice.x, side - lattice.y, side - lattice.z});
    if (is_linear && margin >= 0.5 - 1e-9) {
      ++inner;
      EXPECT_NEAR(mesh.scalars[v], at(p), tolerance) << lattice.x << ' ' << lattice.y << ' ' << lattice.z;
    }
  }
  EXPECT_GE(centres, 64u);
  EXPECT_TRUE(!is_linear || inner > 100u);
}

void expect_read_or_refused(const std::filesystem::path& named, const std::filesystem::path& changed, unsigned seeds) {
  const std::string good = test::contents(changed);
  test::SomeCases some(3);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    if (!some.next()) continue;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bytes = good;
    if (seed % 4 == 0) {
      bytes.resize(random() % good.size() + 1);
    } else {
      for (unsigned k = 0; k < 1 + seed % 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    std::ofstream(changed, std::ios::binary) << bytes;
    const test::Fault fault = test::fault_of([&] { scene::validate(read_mesh(named).mesh, "changed"); });
    if (!fault.code) continue;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_TRUE(fault.message.starts_with(changed.parent_path().parent_path().string())) << fault.message;
    EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
  }
  std::ofstream(changed, std::ios::binary) << good;
}

}  // namespace tessera::io::testing
