// SPDX-License-Identifier: BSD-3-Clause
// A grid by several processes: mpirun -n 4 grid_on_ranks. Each has all samples here; of a file each reads what it
// needs.
#include <cmath>
#include <iostream>
#include <vector>

#include "tessera/mpi.hpp"
#include "tessera/tessera.hpp"

int main(int argc, char** argv) {
  int provided = 0, status = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
  try {
    constexpr int n = 64;
    std::vector<float> samples;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) samples.push_back(std::sin(0.2f * i) * std::cos(0.15f * j) + 0.02f * k);
    tessera::GridArrays grid;
    grid.geometry.points = {n, n, n};
    grid.samples = samples;

    const tessera::Dataset data = tessera::Dataset::of(grid);
    const tessera::View view = data.default_view({640, 480});
    tessera::Session session(data, {}, tessera::communicator(MPI_COMM_WORLD));
    const auto frame = session.render(view, data.transfer_function().function);
    if (session.assembles()) {
      tessera::write_image(frame.image, "grid.png");
      for (const tessera::PixelRect& rect : frame.statistics.rectangles)
        std::cout << "a rank made " << rect.width() << "x" << rect.height() << " pixels\n";
    }
  } catch (const tessera::Error& error) {
    std::cerr << error.what() << '\n';
    status = static_cast<int>(error.code());
  }
  MPI_Finalize();
  return status;
}
