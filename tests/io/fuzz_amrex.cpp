// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as the Header, a list of boxes or the line before values of an AMReX plot file, or refused in one
// line.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/files/file_beginnings.hpp"
#include "io/mesh/amrex_header.hpp"
#include "support/fuzz_check.hpp"

namespace {

using namespace tessera;

void check_box(const io::AmrexBox& box) {
  for (std::size_t a = 0; a < 3; ++a) test::require(box.cells(a) >= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  io::looks_like_amrex(text);
  test::parse_or_refuse([&] {
    const io::AmrexHeader header = io::parse_amrex_header(text, "Header");
    test::require(!header.fields.empty() && !header.levels.empty());
    for (const std::string& field : header.fields) test::require(!field.empty());
    for (const io::AmrexLevel& level : header.levels) check_box(level.domain);
  });
  test::parse_or_refuse([&] {
    const auto boxes = io::parse_amrex_level(text, 1, "Cell_H");
    test::require(!boxes.empty());
    for (const io::AmrexFab& fab : boxes) check_box(fab.box);
  });
  test::parse_or_refuse([&] {
    std::size_t fields = 0;
    check_box(io::parse_amrex_fab(text, fields, "Cell_D"));
    test::require(fields >= 1);
  });
  return 0;
}
