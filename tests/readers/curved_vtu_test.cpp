// SPDX-License-Identifier: BSD-3-Clause
// Lagrange hexahedra of .vtu files in several pieces, old and new, as read by Tessera itself and by VTK's reader.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cells/curved/curved_lattice.hpp"
#include "support/curved_reference.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io::curved_vtu_test {
namespace {

using testing::BentCell;

/// A Lagrange cell of these degrees, bent like a quadratic cell with another numbering.
BentCell bent_lagrange(const std::array<int, 3>& degrees, bool is_old) {
  std::size_t nodes = 1;
  for (const int degree : degrees) nodes *= static_cast<std::size_t>(degree) + 1;
  const auto lattice = cells::curved_lattice(72, nodes, degrees);
  std::vector<glm::dvec3> places;
  for (std::size_t k = 0; k < nodes; ++k) places.push_back(lattice->place(k));
  if (is_old) {
    // In VTK 8 the edge from corner 3 to 7 precedes that from 2 to 6.
    std::vector<std::size_t> third, fourth;
    for (std::size_t k = 8; k < nodes; ++k)
      if (const glm::dvec3& p = places[k]; p.y == 1 && p.z > 0 && p.z < 1)
        if (p.x == 1 || p.x == 0) (p.x == 1 ? third : fourth).push_back(k);
    for (std::size_t k = 0; k < third.size(); ++k) std::swap(places[third[k]], places[fourth[k]]);
  }
  return testing::bend_places(cells::CurvedFamily::hexahedron, testing::CellSpace::quadratic, places);
}

std::string array(const std::string& type, const std::string& name, int components, const std::string& numbers) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>\n",
                     type, name, components, numbers);
}

/// One piece with the cell `copies` times, each with its own points; `more` is in its <CellData>.
std::string piece(const BentCell& cell, int copies, double shift, const std::string& more) {
  std::string points, values, nodes, ends, types;
  for (int copy = 0; copy < copies; ++copy) {
    for (std::size_t k = 0; k < cell.positions.size(); ++k) {
      const glm::dvec3 p = cell.positions[k] + glm::dvec3(shift + 5 * copy, 0, 0);
      points += fmt::format("{} {} {} ", p.x, p.y, p.z);
      values += fmt::format("{} ", cell.values[k]);
      nodes += fmt::format("{} ", static_cast<std::size_t>(copy) * cell.positions.size() + k);
    }
    ends += fmt::format("{} ", static_cast<std::size_t>(copy + 1) * cell.positions.size());
    types += "72 ";
  }
  return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
                     static_cast<std::size_t>(copies) * cell.positions.size(), copies) +
         array("Float64", "f", 1, values) + "</PointData>\n<CellData>\n" + more + "</CellData>\n<Points>\n" +
         array("Float64", "Points", 3, points) + "</Points>\n<Cells>\n" + array("Int64", "connectivity", 1, nodes) +
         array("Int64", "offsets", 1, ends) + array("UInt8", "types", 1, types) + "</Cells>\n</Piece>\n";
}

std::string vtu(const std::string& version, const std::string& pieces) {
  return fmt::format(
      "<VTKFile type=\"UnstructuredGrid\" version=\"{}\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n{}"
      "</UnstructuredGrid>\n</VTKFile>\n",
      version, pieces);
}

cells::MeshFile read_text(const std::string& text) {
  const test::TemporaryFolder folder;
  return read_mesh(folder.write("a.vtu", text), testing::coarse_options());
}

TEST(CurvedVtu, OldHexahedraOfEveryPieceAreReordered) {
  for (const char* version : {"0.1", "1.0", "2.0", "2.1", "2.2"}) {
    SCOPED_TRACE(version);
    const BentCell cell = bent_lagrange({2, 2, 2}, version < std::string("2.1"));
    testing::expect_same(
        read_text(vtu(version, piece(cell, 1, 0, "") + piece(cell, 2, 10, "") + piece(cell, 1, 30, ""))), cell, 4);
  }
}

TEST(CurvedVtu, PiecesWithDifferentArraysAreReorderedOnceEach) {
  TESSERA_VTK_OR_SKIP();
  for (const char* version : {"1.0", "2.0", "2.1"}) {
    SCOPED_TRACE(version);
    const BentCell cell = bent_lagrange({2, 2, 2}, version < std::string("2.1"));
    for (const int pieces : {2, 3}) {
      std::string text;
      for (int p = 0; p < pieces; ++p)
        text += piece(cell, 1, 10 * p, p == 1 ? array("Float64", "of_one_piece", 1, "7") : "");
      testing::expect_same(read_text(vtu(version, text)), cell, pieces);
    }
  }
}

TEST(CurvedVtu, OldHexahedraOfDifferentDegreesAreReordered) {
  for (const auto& degrees : {std::array{2, 3, 2}, std::array{2, 2, 3}, std::array{3, 3, 3}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", degrees[0], degrees[1], degrees[2]));
    const BentCell cell = bent_lagrange(degrees, true);
    const std::string numbers =
        array("Int64", "HigherOrderDegrees", 3, fmt::format("{} {} {}", degrees[0], degrees[1], degrees[2]));
    testing::expect_same(read_text(vtu("2.0", piece(cell, 1, 0, numbers) + piece(cell, 1, 10, numbers))), cell, 2);
    if (!has_reader(Reader::vtk)) continue;
    const std::string more = array("Float64", "of_one_piece", 1, "7");
    testing::expect_same(read_text(vtu("2.0", piece(cell, 1, 0, numbers) + piece(cell, 1, 10, numbers + more))), cell,
                         2);
  }
}

}  // namespace
}  // namespace tessera::io::curved_vtu_test
