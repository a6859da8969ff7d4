// SPDX-License-Identifier: BSD-3-Clause
// Damaged .vtu files are refused in one line, or left to VTK's reader, and do not allocate memory that they cannot
// fill.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <cstring>
#include <limits>
#include <random>

#include "io/mesh/vtu_checks.hpp"
#include "io/mesh/vtu_writing.hpp"
#include "io/text/xml_elements.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::all_storages;
using test::sample_piece;
using test::vtu_file_text;
using test::VtuStorage;
using Coding = VtuStorage::Coding;
using Codec = VtuStorage::Codec;

constexpr std::size_t most_memory = 100 << 20;

class VtuDamaged : public ::testing::Test {
 protected:
  void SetUp() override { before_ = peak(); }
  void TearDown() override {
#ifndef __SANITIZE_ADDRESS__  // it keeps freed memory
    EXPECT_LT(peak() - before_, most_memory) << "bytes that damaged files took";
#endif
  }

  static std::size_t peak() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) << 10;
  }

  /// Reads all of a file; returns whether it was accepted.
  bool is_read(const std::string& text) const {
    const auto file = folder.write("d.vtu", text);
    bool known = true;
    const test::Fault fault = test::fault_of([&] {
      const auto opened = open_vtk_xml(file);
      known = opened.has_value();
      if (!opened) return;
      std::vector<std::string> notes;
      for (const cells::CellBlock& block : blocks_of(*opened, notes))
        for (const cells::BlockField& field : block.fields) test::values_of(field, 0);
    });
    if (!fault.code) return known;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_TRUE(fault.message.starts_with(file.string())) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
    EXPECT_LT(fault.message.size(), 400u) << fault.message;
    return false;
  }

  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  test::TemporaryFolder folder;

 private:
  std::size_t before_ = 0;
};

TEST_F(VtuDamaged, TruncatedFilesAreRefused) {
  for (const VtuStorage& storage : all_storages()) {
    const std::string text = vtu_file_text(storage, {sample_piece()});
    ASSERT_TRUE(is_read(text));
    for (std::size_t size = 0; size < text.size() - 40; size += 97) {
      EXPECT_FALSE(size > 0 && is_read(text.substr(0, size))) << size;
      EXPECT_FALSE(is_read(text.substr(0, size) + "</VTKFile>")) << size << " of " << text.size();
    }
  }
}

TEST_F(VtuDamaged, CountsThatTheFileCannotHoldAreRefused) {
  for (const VtuStorage& storage : all_storages()) {
    const std::string text = vtu_file_text(storage, {sample_piece()});
    for (const char* count : {"13", "4000000000", "999999999999", "9223372036854775807", "-1", "1e3", "", "0x10"}) {
      EXPECT_FALSE(is_read(replaced(text, "NumberOfPoints=\"12\"", fmt::format("NumberOfPoints=\"{}\"", count))));
      EXPECT_FALSE(is_read(replaced(text, "NumberOfCells=\"3\"", fmt::format("NumberOfCells=\"{}\"", count)))) << count;
    }
    EXPECT_FALSE(
        is_read(replaced(text, "Name=\"f\" NumberOfComponents=\"1\"", "Name=\"f\" NumberOfComponents=\"1000000\"")));
  }
}

TEST_F(VtuDamaged, OffsetsOutsideTheFileAreRefused) {
  for (const Coding coding : {Coding::appended_base64, Coding::appended_raw})
    for (const Codec codec : {Codec::none, Codec::zlib}) {
      const std::string text = vtu_file_text({.coding = coding, .codec = codec}, {sample_piece()});
      for (const char* offset : {"1000000", "9223372036854775807", "-9223372036854775808", "-1", "1", "-100", "x"})
        EXPECT_FALSE(is_read(replaced(text, "offset=\"0\"", fmt::format("offset=\"{}\"", offset)))) << offset;
    }
}

TEST_F(VtuDamaged, HeadersThatTheirBlocksDoNotFitAreRefused) {
  for (const VtuStorage& storage : all_storages()) {
    if (storage.coding != Coding::appended_raw) continue;
    const std::string text = vtu_file_text(storage, {sample_piece()});
    const std::size_t first = text.find('_', text.find("AppendedData")) + 1, width = storage.wide_numbers ? 8 : 4;
    const std::size_t numbers = storage.codec == Codec::none ? 1 : 4;
    for (std::size_t k = 0; k < numbers; ++k)
      for (const std::uint64_t value : {std::uint64_t{1}, std::uint64_t{41}, std::uint64_t{1} << 31,
                                        std::uint64_t{UINT32_MAX}, std::uint64_t{1} << 62, UINT64_MAX}) {
        std::string changed = text;
        for (std::size_t b = 0; b < width; ++b)
          changed[first + k * width + (storage.big_endian ? width - 1 - b : b)] =
              static_cast<char>(value >> 8 * b & 255);
        if (changed == text) continue;
        EXPECT_FALSE(is_read(changed)) << "number " << k << " is " << value;
      }
  }
}

TEST_F(VtuDamaged, SmallBlocksCannotStateThatTheyAreLarge) {
  // One small block that states 3 GiB, the size of the file's 2^27 points.
  const auto number = [](std::uint64_t value) {
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &value, 8);
    return bytes;
  };
  for (const char* compressor : {"vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"}) {
    const std::uint64_t bytes = 24ull << 27;
    const std::string text = fmt::format(
                                 "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" header_type=\"UInt64\" "
                                 "compressor=\"{}\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"0\">"
                                 "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" "
                                 "offset=\"0\"/></Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_",
                                 compressor, 1 << 27) +
                             number(1) + number(bytes) + number(0) + number(1000) + std::string(1000, 'x') +
                             "</AppendedData></VTKFile>";
    EXPECT_FALSE(is_read(text));
  }
}

TEST_F(VtuDamaged, GeometryOutOfProportionToTheFileIsRefusedBeforeItTakesMemory) {
  // 60 million points of zeros in a file of half a megabyte.
  constexpr std::size_t points = 60'000'000, block = 8 << 20, bytes = points * 12, blocks = (bytes + block - 1) / block;
  std::string packed(::compressBound(block), '\0');
  uLongf size = packed.size();
  const std::string zeros(block, '\0');
  ASSERT_EQ(
      ::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()), block),
      Z_OK);
  packed.resize(size);
  std::string table;
  const auto number = [&table](std::uint32_t value) {
    table.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  number(blocks), number(block), number(bytes % block);
  for (std::size_t k = 0; k < blocks; ++k) number(static_cast<std::uint32_t>(size));
  const auto text = [&](std::size_t point_count, const std::string& appended) {
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
        "compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><Piece NumberOfPoints=\"{}\" "
        "NumberOfCells=\"1\"><Points>"
        "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" "
        "offset=\"0\"/></Points><Cells><DataArray "
        "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Int32\" "
        "Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10"
        "</DataArray></Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_{}</AppendedData></VTKFile>",
        point_count, appended);
  };
  std::string all = table;
  for (std::size_t k = 0; k < blocks; ++k) all += packed;
  const auto file = folder.write("b.vtu", text(points, all));
  test::expect_bad_input([&] { open_vtk_xml(file); }, {"its points are 686 MiB", "implausible"});
}

TEST_F(VtuDamaged, ElementsNestedWithoutEndAreRefused) {
  std::string text = "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">";
  for (int k = 0; k < 1'000'000; ++k) text += "<a>";
  const auto file = folder.write("d.vtu", text + "</VTKFile>");
  test::expect_bad_input([&] { open_vtk_xml(file); }, {"nested more than 256 deep"});
  test::expect_bad_input([&] { each_xml_element(text, "d.pvtu", [](const XmlElement&) {}); }, {"nested more than"});
}

TEST_F(VtuDamaged, MissingPartsAreRefused) {
  const std::string text = vtu_file_text({}, {sample_piece()});
  for (const char* name : {"\"connectivity\"", "\"offsets\"", "\"types\""})
    EXPECT_FALSE(is_read(replaced(text, name, "\"other\""))) << name;
  for (const char* name : {"<Points>", "<Cells>", "<UnstructuredGrid>", "<VTKFile"})
    EXPECT_FALSE(is_read(replaced(text, name, "<Other>"))) << name;
  EXPECT_FALSE(is_read(replaced(text, "8 14 20", "8 14 13")));
  EXPECT_FALSE(is_read(replaced(text, "8 14 20", "8 14 21")));
  EXPECT_FALSE(is_read(replaced(text, "8 14 20", "8 14 9000000000000000")));
  EXPECT_FALSE(is_read(replaced(text, "8 14 20", "-8 14 20")));
  EXPECT_FALSE(is_read(replaced(text, "0 1 4 3", "0 12 4 3")));
  EXPECT_FALSE(is_read(replaced(text, "0 1 4 3", "0 -1 4 3")));
  EXPECT_FALSE(is_read(replaced(text, "0 1 4 3", "0 1.5 4 3")));
}

TEST_F(VtuDamaged, ChangedBytesAreReadOrRefused) {
  unsigned seed = 1;
  test::SomeCases some(5);
  for (const VtuStorage& storage : all_storages()) {
    const std::string text = vtu_file_text(storage, {sample_piece()});
    for (int k = 0; k < 150; ++k) {
      if (!some.next()) continue;
      SCOPED_TRACE(seed);
      std::mt19937 random(seed++);
      std::string changed = text;
      for (unsigned n = 0; n < 1 + random() % 4; ++n) changed[random() % changed.size()] = static_cast<char>(random());
      is_read(changed);
    }
  }
}

}  // namespace
}  // namespace tessera::io
