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

scene::TetMesh parse_tets(std::span<const std::byte> bytes, const std::string& source) {
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

  scene::TetMesh mesh;
  mesh.field_name = "scalar";
  mesh.positions.resize(nverts);
  mesh.scalars.resize(nverts);
  mesh.tets.resize(ntets);
  const std::byte* xyz = bytes.data() + header_bytes;
  const std::byte* scalar = xyz + 12 * nverts;
  const std::byte* corners = scalar + 4 * nverts;
  for (std::uint64_t v = 0; v < nverts; ++v) {
    float p[3], s;
    std::memcpy(p, xyz + 12 * v, sizeof p);
    std::memcpy(&s, scalar + 4 * v, sizeof s);
    mesh.positions[v] = {p[0], p[1], p[2]};
    mesh.scalars[v] = s;
  }
  for (std::uint64_t t = 0; t < ntets; ++t) {
    std::int32_t corner[4];
    std::memcpy(corner, corners + tet_bytes * t, sizeof corner);
    for (int k = 0; k < 4; ++k) {
      if (corner[k] < 0 || corner[k] >= vertex_count)
        throw scene::bad_input(
            fmt::format("{}: tet {} uses vertex {}, the file holds {}; write tets and vertices from one mesh", source,
                        t, corner[k], nverts));
      mesh.tets[t][k] = static_cast<std::uint32_t>(corner[k]);
    }
  }
  return mesh;
}

}  // namespace tessera::io
