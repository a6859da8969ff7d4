// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tets_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "io/mesh/mesh_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

// The arrays are copied without conversion; a big-endian host would have to swap them.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t header_bytes = 16, vertex_bytes = 16, tet_bytes = 16;

std::uint64_t scalars_begin(const TetsHeader& header) { return header_bytes + 12 * header.vertices; }
std::uint64_t corners_begin(const TetsHeader& header) { return header_bytes + vertex_bytes * header.vertices; }

/// Passes the items [first, last) of an array, which begins at a position in the file, to `use`, some at a time:
/// use(index of the first item, items).
template <class Item, class Use>
void each_part(const TetsBytes& file, std::uint64_t begin, std::uint64_t first, std::uint64_t last, const Use& use) {
  constexpr std::uint64_t at_once = (std::uint64_t{1} << 18) / sizeof(Item);
  std::vector<Item> items(std::min(at_once, last - first));
  for (; first < last; first += at_once) {
    const std::uint64_t count = std::min(at_once, last - first);
    file.copy(begin + first * sizeof(Item), reinterpret_cast<std::byte*>(items.data()), count * sizeof(Item));
    use(first, std::span<const Item>(items).first(count));
  }
}

using Corners = std::array<std::int32_t, 4>;
using Point = std::array<float, 3>;

/// Throws if a corner is not the index of a vertex.
scene::Tet checked_tet(const Corners& corners, std::uint64_t tet, std::uint64_t vertices, const std::string& source) {
  scene::Tet result{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (corners[k] < 0 || static_cast<std::uint64_t>(corners[k]) >= vertices)
      throw scene::bad_input(fmt::format(
          "{}: tet {} uses vertex {}, but the file has only {} vertices; write tets and vertices from one mesh", source,
          tet, corners[k], vertices));
    result[k] = static_cast<std::uint32_t>(corners[k]);
  }
  return result;
}

void append_tets(const TetsBytes& file, const TetsHeader& header, std::uint64_t first, std::uint64_t last,
                 const std::string& source, std::vector<scene::Tet>& tets) {
  tets.reserve(last - first);
  each_part<Corners>(file, corners_begin(header), first, last, [&](std::uint64_t at, std::span<const Corners> part) {
    for (const Corners& corners : part) tets.push_back(checked_tet(corners, at++, header.vertices, source));
  });
}

void append_vertices(const TetsBytes& file, const TetsHeader& header, std::uint64_t first, std::uint64_t last,
                     scene::TetMesh& mesh) {
  each_part<Point>(file, header_bytes, first, last, [&](std::uint64_t, std::span<const Point> part) {
    for (const Point& p : part) mesh.positions.emplace_back(p[0], p[1], p[2]);
  });
  each_part<float>(file, scalars_begin(header), first, last, [&](std::uint64_t, std::span<const float> part) {
    mesh.scalars.insert(mesh.scalars.end(), part.begin(), part.end());
  });
}

}  // namespace

TetsBytes::TetsBytes(std::span<const std::byte> bytes)
    : size(bytes.size()), copy([bytes](std::uint64_t at, std::byte* to, std::uint64_t count) {
        std::memcpy(to, bytes.data() + at, count);
      }) {}

TetsBytes::TetsBytes(const system::PositionalFile& file)
    : size(file.size()),
      copy([&file](std::uint64_t at, std::byte* to, std::uint64_t count) { file.read(at, to, count); }) {}

TetsHeader tets_header(const TetsBytes& file, const std::string& source) {
  if (file.size < header_bytes)
    throw scene::bad_input(fmt::format("{}: {} bytes are too few for a .tets header of {}; write the file again",
                                       source, file.size, header_bytes));
  std::array<std::int64_t, 2> counts{};
  file.copy(0, reinterpret_cast<std::byte*>(counts.data()), header_bytes);
  constexpr std::int64_t max_count = INT32_MAX;  // vertex indices are int32
  if (counts[0] < 0 || counts[1] < 0 || counts[0] > max_count || counts[1] > (INT64_MAX >> 5))
    throw scene::bad_input(
        fmt::format("{}: its header states {} vertices and {} tets, which is impossible; the file is not a "
                    "little-endian .tets file",
                    source, counts[0], counts[1]));
  const TetsHeader header{static_cast<std::uint64_t>(counts[0]), static_cast<std::uint64_t>(counts[1])};
  const std::uint64_t expected = corners_begin(header) + tet_bytes * header.tets;
  if (file.size != expected)
    throw scene::bad_input(fmt::format(
        "{}: {} vertices and {} tets need {} bytes, but the file has {}; {}", source, header.vertices, header.tets,
        expected, file.size,
        file.size < expected ? "it is truncated, copy it again" : "it is another format or was written twice"));
  return header;
}

void read_scalars(const TetsBytes& file, const TetsHeader& header, std::uint64_t first, std::span<double> out) {
  auto to = out.begin();
  each_part<float>(file, scalars_begin(header), first, first + out.size(),
                   [&](std::uint64_t, std::span<const float> part) { to = std::copy(part.begin(), part.end(), to); });
}

scene::TetMesh parse_tets(const TetsBytes& file, const std::string& source) {
  const TetsHeader header = tets_header(file, source);
  scene::TetMesh mesh;
  mesh.field_name = "scalar";
  mesh.positions.reserve(header.vertices);
  mesh.scalars.reserve(header.vertices);
  append_vertices(file, header, 0, header.vertices, mesh);
  append_tets(file, header, 0, header.tets, source, mesh.tets);
  return mesh;
}

TetsRange parse_tets_range(const TetsBytes& file, std::uint64_t first, std::uint64_t last, const std::string& source) {
  const TetsHeader header = tets_header(file, source);
  TetsRange range;
  range.mesh.field_name = "scalar";
  append_tets(file, header, first, last, source, range.mesh.tets);
  // The bit of a vertex is set if the range uses the vertex. `before` contains, for each word, the number of bits set
  // before the word: the index in the mesh of the word's first vertex that is used.
  std::vector<std::uint64_t> used((header.vertices + 63) / 64, 0);
  for (const scene::Tet& tet : range.mesh.tets)
    for (const std::uint32_t v : tet) used[v / 64] |= std::uint64_t{1} << v % 64;
  std::vector<std::uint32_t> before(used.size());
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < used.size(); ++w) {
    before[w] = count;
    count += static_cast<std::uint32_t>(std::popcount(used[w]));
  }
  for (scene::Tet& tet : range.mesh.tets)
    for (std::uint32_t& v : tet)
      v = before[v / 64] + static_cast<std::uint32_t>(std::popcount(used[v / 64] & ((std::uint64_t{1} << v % 64) - 1)));
  range.file_vertex.reserve(count);
  for (std::size_t w = 0; w < used.size(); ++w)
    for (std::uint64_t bits = used[w]; bits != 0; bits &= bits - 1)
      range.file_vertex.push_back(static_cast<std::uint32_t>(64 * w) +
                                  static_cast<std::uint32_t>(std::countr_zero(bits)));
  range.mesh.positions.reserve(count);
  range.mesh.scalars.reserve(count);
  // The vertices that are used are mostly close together, and reading a short gap costs less than another read.
  constexpr std::uint32_t longest_gap = 256, longest_run = 1 << 20;
  scene::TetMesh run;
  for (std::size_t k = 0; k < count;) {
    const std::uint32_t begin = range.file_vertex[k];
    std::size_t end = k + 1;
    while (end < count && range.file_vertex[end] - range.file_vertex[end - 1] <= longest_gap &&
           range.file_vertex[end] - begin < longest_run)
      ++end;
    run.positions.clear(), run.scalars.clear();
    append_vertices(file, header, begin, range.file_vertex[end - 1] + std::uint64_t{1}, run);
    for (; k < end; ++k) {
      range.mesh.positions.push_back(run.positions[range.file_vertex[k] - begin]);
      range.mesh.scalars.push_back(run.scalars[range.file_vertex[k] - begin]);
    }
  }
  return range;
}

cells::MeshBlocks blocks_of_tets(scene::TetMesh mesh) {
  cells::CellBlock block;
  block.positions = std::move(mesh.positions);
  block.tets = std::move(mesh.tets);
  block.fields.push_back(
      cells::field_of_values("scalar", "float", scene::Association::point, 1, std::move(mesh.scalars)));
  cells::MeshBlocks result;
  result.format = "raw tetrahedra (.tets)";
  result.blocks.push_back(std::move(block));
  return result;
}

cells::MeshBlocks read_tets(const InputFile& file, const MeshOptions& /*options*/) {
  return blocks_of_tets(parse_tets(TetsBytes(system::PositionalFile(file.path)), file.name));
}

}  // namespace tessera::io
