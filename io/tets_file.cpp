#include "io/tets_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "scene/error.hpp"

namespace tessera::io {
namespace {

// The arrays are copied as they lie; a big-endian host would have to swap them.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t header_bytes = 16, vertex_bytes = 16, tet_bytes = 16;

std::int64_t read_count(std::span<const std::byte> bytes, std::size_t at) {
  std::int64_t n;
  std::memcpy(&n, bytes.data() + at, sizeof n);
  return n;
}

}  // namespace

glm::dvec3 TetsLayout::position(std::uint64_t vertex) const {
  float p[3];
  std::memcpy(p, xyz + 12 * vertex, sizeof p);
  return {p[0], p[1], p[2]};
}

double TetsLayout::scalar_of(std::uint64_t vertex) const {
  float s;
  std::memcpy(&s, scalar + 4 * vertex, sizeof s);
  return s;
}

scene::Tet TetsLayout::tet(std::uint64_t tet, const std::string& source) const {
  std::int32_t corner[4];
  std::memcpy(corner, corners + tet_bytes * tet, sizeof corner);
  scene::Tet result;
  for (std::size_t k = 0; k < 4; ++k) {
    if (corner[k] < 0 || static_cast<std::uint64_t>(corner[k]) >= vertices)
      throw scene::bad_input(
          fmt::format("{}: tet {} uses vertex {}, the file holds {}; write tets and vertices from one mesh", source,
                      tet, corner[k], vertices));
    result[k] = static_cast<std::uint32_t>(corner[k]);
  }
  return result;
}

TetsLayout tets_layout(std::span<const std::byte> bytes, const std::string& source) {
  if (bytes.size() < header_bytes)
    throw scene::bad_input(fmt::format("{}: {} bytes are too few for a .tets header of {}; write the file anew", source,
                                       bytes.size(), header_bytes));
  const std::int64_t vertex_count = read_count(bytes, 0), tet_count = read_count(bytes, 8);
  constexpr std::int64_t max_count = INT32_MAX;  // vertex indices are int32
  if (vertex_count < 0 || tet_count < 0 || vertex_count > max_count || tet_count > (INT64_MAX >> 5))
    throw scene::bad_input(
        fmt::format("{}: the header promises {} vertices and {} tets; this is no little-endian .tets file", source,
                    vertex_count, tet_count));
  const auto nverts = static_cast<std::uint64_t>(vertex_count), ntets = static_cast<std::uint64_t>(tet_count);
  const std::uint64_t expected = header_bytes + vertex_bytes * nverts + tet_bytes * ntets;
  if (bytes.size() != expected)
    throw scene::bad_input(fmt::format(
        "{}: {} vertices and {} tets need {} bytes, the file has {}; {}", source, nverts, ntets, expected, bytes.size(),
        bytes.size() < expected ? "it is truncated, copy it anew" : "it is another format or was written twice"));

  TetsLayout layout{nverts, ntets, bytes.data() + header_bytes, nullptr, nullptr};
  layout.scalar = layout.xyz + 12 * nverts;
  layout.corners = layout.scalar + 4 * nverts;
  return layout;
}

scene::TetMesh parse_tets(std::span<const std::byte> bytes, const std::string& source) {
  const TetsLayout file = tets_layout(bytes, source);
  scene::TetMesh mesh;
  mesh.field_name = "scalar";
  mesh.positions.resize(file.vertices);
  mesh.scalars.resize(file.vertices);
  mesh.tets.reserve(file.tets);
  for (std::uint64_t v = 0; v < file.vertices; ++v) {
    mesh.positions[v] = file.position(v);
    mesh.scalars[v] = file.scalar_of(v);
  }
  for (std::uint64_t t = 0; t < file.tets; ++t) mesh.tets.push_back(file.tet(t, source));
  return mesh;
}

TetsRange parse_tets_range(const TetsLayout& file, std::uint64_t first, std::uint64_t last, const std::string& source) {
  TetsRange range;
  range.mesh.field_name = "scalar";
  range.mesh.tets.reserve(last - first);
  // A bit a vertex of the file, and how many are set before each word of bits: the vertex's number here.
  std::vector<std::uint64_t> used((file.vertices + 63) / 64, 0);
  for (std::uint64_t t = first; t < last; ++t) {
    range.mesh.tets.push_back(file.tet(t, source));
    for (const std::uint32_t v : range.mesh.tets.back()) used[v / 64] |= std::uint64_t{1} << v % 64;
  }
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
  for (const std::uint32_t v : range.file_vertex) {
    range.mesh.positions.push_back(file.position(v));
    range.mesh.scalars.push_back(file.scalar_of(v));
  }
  return range;
}

}  // namespace tessera::io
