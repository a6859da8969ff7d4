// SPDX-License-Identifier: BSD-3-Clause
// Eight hexahedra from arrays, as a solver has them, to a picture.
#include <iostream>
#include <vector>

#include "tessera/tessera.hpp"

int main() try {
  constexpr int n = 3;  // points along each side
  std::vector<double> points, pressure;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        points.insert(points.end(), {0.5 * i, 0.5 * j, 0.5 * k});
        pressure.push_back(i + 2 * j - k);
      }
  std::vector<std::int64_t> connectivity, offsets{0};
  for (int k = 0; k + 1 < n; ++k)
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + 1 < n; ++i) {
        const std::int64_t a = i + n * (j + n * k), b = a + n * n;
        connectivity.insert(connectivity.end(), {a, a + 1, a + n + 1, a + n, b, b + 1, b + n + 1, b + n});
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
  tessera::MeshArrays mesh;
  mesh.points = points, mesh.connectivity = connectivity, mesh.offsets = offsets, mesh.scalars = pressure;
  const std::vector<tessera::CellType> types(offsets.size() - 1, tessera::CellType::hexahedron);
  mesh.types = types;

  const tessera::Dataset data = tessera::Dataset::of(mesh);
  const tessera::View view = data.default_view({640, 480});
  const auto frame = tessera::Session(data).render(view, data.transfer_function("viridis").function);
  tessera::write_image(frame.image, "mesh.png");
  std::cout << data.tet_count() << " tets, " << frame.statistics.milliseconds << " ms: mesh.png\n";
} catch (const tessera::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
