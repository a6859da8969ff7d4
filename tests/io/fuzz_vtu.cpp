// SPDX-License-Identifier: BSD-3-Clause
// Any bytes in a VTK XML file of one data set give blocks of cells with valid indices and readable fields, or are left
// to VTK's reader, or refused in one line.
#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/vtk/vtk_xml_file.hpp"
#include "support/fuzz_check.hpp"
#include "support/fuzz_file.hpp"

namespace {

void check(const tessera::cells::CellBlock& block) {
  using tessera::test::require;
  if (!block.types.empty()) {
    require(block.offsets.size() == block.types.size() + 1);
    require(block.offsets.back() == block.connectivity.size());
    for (std::size_t c = 0; c < block.types.size(); ++c) require(block.offsets[c] <= block.offsets[c + 1]);
  }
  for (const std::uint32_t v : block.connectivity) require(v < block.positions.size());
  for (const auto& tet : block.tets)
    for (const std::uint32_t v : tet) require(v < block.positions.size());
  for (const tessera::cells::BlockField& field : block.fields) {
    const bool is_point = field.association == tessera::scene::Association::point;
    require(field.tuples == (is_point ? block.positions.size() : block.cell_count()));
    std::vector<double> values(field.tuples);
    field.read(0, 0, values);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  static const test::FuzzFile file(".vtu");
  // Inputs are small: threads would only wait for each other.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  file.write(data, size);
  test::parse_or_refuse([&] {
    const auto opened = io::open_vtk_xml(file.path);
    if (!opened) return;
    std::vector<std::string> notes;
    for (const cells::CellBlock& block : io::blocks_of(*opened, notes, io::GridsAre::hexahedra)) check(block);
  });
  return 0;
}
