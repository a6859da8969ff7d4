// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <new>
#include <vector>

#include "io/mesh/mesh_reader.hpp"
#include "io/text/xml_elements.hpp"
#include "system/atomic_file.hpp"
#include "tessera/cell_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// The declaration of one array and the number of its values. `fill` supplies bytes of the values from `first` on.
struct WrittenArray {
  std::string attributes;  ///< attributes of the array's <DataArray>
  std::size_t numbers, number_size;
  std::function<void(std::size_t first, std::size_t count, std::byte* to)> fill;
};

template <class T, class Of>
WrittenArray array_of(std::string attributes, std::size_t numbers, const Of& of) {
  return {std::move(attributes), numbers, sizeof(T), [of](std::size_t first, std::size_t count, std::byte* to) {
            for (std::size_t k = 0; k < count; ++k) {
              const T number = of(first + k);
              std::memcpy(to + k * sizeof(T), &number, sizeof(T));
            }
          }};
}

/// Writes VTK's compressed form ("VTK XML Formats" in VTK's wiki): the number of blocks, the size of a block, the size
/// of the last block if that is not full, otherwise 0, and the compressed size of each block, all as uint64; then the
/// blocks, compressed by zlib.
void write_compressed(const WrittenArray& array, system::AtomicFile& out) {
  constexpr std::size_t block_bytes = 1 << 18;
  const std::size_t numbers_a_block = block_bytes / array.number_size,
                    blocks = (array.numbers + numbers_a_block - 1) / numbers_a_block;
  std::vector<std::uint64_t> head(3 + blocks, 0);
  head[0] = blocks, head[1] = block_bytes;
  head[2] = array.numbers % numbers_a_block * array.number_size;
  const std::uint64_t start = out.position();
  out.write(head.data(), head.size() * sizeof head[0]);
  std::vector<std::byte> plain(block_bytes);
  std::vector<Bytef> packed(::compressBound(block_bytes));
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * numbers_a_block, count = std::min(numbers_a_block, array.numbers - first);
    array.fill(first, count, plain.data());
    uLongf size = packed.size();
    if (::compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(plain.data()), count * array.number_size,
                    Z_DEFAULT_COMPRESSION) != Z_OK)
      throw std::bad_alloc();  // the only possible failure
    head[3 + b] = size;
    out.write(packed.data(), size);
  }
  const std::uint64_t end = out.position();
  out.seek(start);
  out.write(head.data(), head.size() * sizeof head[0]);
  out.seek(end);
}

/// The text of a file with placeholders for the positions of its arrays.
class VtuText {
 public:
  void add(std::string_view text) { text_ += text; }
  /// Adds a section that contains `arrays`, with placeholders for their positions.
  void add_section(const char* opening, const char* closing, std::span<const WrittenArray> arrays) {
    text_ += fmt::format("      <{}>\n", opening);
    for (const WrittenArray& array : arrays) {
      text_ += fmt::format("        <DataArray {} format=\"appended\" offset=\"", array.attributes);
      places_.push_back(text_.size());
      text_.append(width, ' ');
      text_ += "\"/>\n";
    }
    text_ += fmt::format("      </{}>\n", closing);
  }
  void write(system::AtomicFile& out) const { out.write(text_); }
  /// Replaces an array's placeholder by its position.
  void enter(std::size_t array, std::uint64_t offset, system::AtomicFile& out) const {
    const std::uint64_t end = out.position();
    out.seek(places_[array]);
    out.write(fmt::format("{:0{}}", offset, width));
    out.seek(end);
  }

 private:
  static constexpr std::size_t width = 15;
  std::string text_;
  std::vector<std::size_t> places_;
};

}  // namespace

void write_vtu(const scene::TetMeshView& mesh, const std::filesystem::path& file) {
  const std::size_t points = mesh.positions.size(), tets = mesh.tets.size();
  const std::array<WrittenArray, 1> places{
      array_of<double>("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", 3 * points,
                       [&](std::size_t k) { return mesh.positions[k / 3][static_cast<int>(k % 3)]; })};
  const std::array<WrittenArray, 3> cells{
      array_of<std::int64_t>("type=\"Int64\" Name=\"connectivity\"", 4 * tets,
                             [&](std::size_t k) { return std::int64_t{mesh.tets[k / 4][k % 4]}; }),
      array_of<std::int64_t>("type=\"Int64\" Name=\"offsets\"", tets,
                             [](std::size_t k) { return static_cast<std::int64_t>(4 * (k + 1)); }),
      array_of<std::uint8_t>("type=\"UInt8\" Name=\"types\"", tets,
                             [](std::size_t) { return vtk_number(CellType::tetra); })};
  const std::string name = xml_escaped(mesh.field_name.empty() ? "scalar" : std::string(mesh.field_name));
  const WrittenArray scalars = array_of<double>(fmt::format("type=\"Float64\" Name=\"{}\"", name), mesh.scalars.size(),
                                                [&](std::size_t k) { return mesh.scalars[k]; });
  const bool at_points = mesh.association == scene::Association::point;
  std::vector<WrittenArray> point_data, cell_data;
  (at_points ? point_data : cell_data).push_back(scalars);
  if (!mesh.original_cell.empty())
    cell_data.push_back(array_of<std::int64_t>("type=\"Int64\" Name=\"OriginalCellId\"", tets, [&](std::size_t k) {
      return static_cast<std::int64_t>(mesh.original_cell[k]);
    }));

  VtuText text;
  text.add(fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n    <Piece "
      "NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      points, tets));
  const std::string active = fmt::format(" Scalars=\"{}\"", name);
  text.add_section(("PointData" + (at_points ? active : std::string())).c_str(), "PointData", point_data);
  text.add_section(("CellData" + (at_points ? std::string() : active)).c_str(), "CellData", cell_data);
  text.add_section("Points", "Points", places);
  text.add_section("Cells", "Cells", cells);
  text.add("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _");

  system::AtomicFile out(file);
  text.write(out);
  const std::uint64_t start = out.position();
  std::size_t number = 0;
  for (const std::span<const WrittenArray> section :
       {std::span<const WrittenArray>(point_data), std::span<const WrittenArray>(cell_data),
        std::span<const WrittenArray>(places), std::span<const WrittenArray>(cells)})
    for (const WrittenArray& array : section) {
      text.enter(number++, out.position() - start, out);
      write_compressed(array, out);
    }
  out.write("\n  </AppendedData>\n</VTKFile>\n");
  out.commit();
}

}  // namespace tessera::io
