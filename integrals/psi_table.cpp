// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/psi_table.hpp"

#include <algorithm>

#include "integrals/segment_integrator.hpp"

namespace tessera::integrals {

PsiTable::PsiTable(int table_size)
    : size(table_size), psi(static_cast<std::size_t>(table_size) * static_cast<std::size_t>(table_size), 0.0f) {
  // If the extinction at scalar s is s, and emission is independent and white, the light of a segment of length 1 is
  // Psi.
  const double last = size - 1;
  const auto depth_of = [&](int i) { return i / (last - i); };
  const PiecewiseTable identity(scene::TransferFunction({{0, {1, 1, 1}, 0}, {last, {1, 1, 1}, last}}));
  const auto n = static_cast<std::size_t>(size);
  SegmentBatch batch;
  batch.reserve(n - 1);
  for (int row = 0; row + 1 < size; ++row) {
    batch.size = n - 1;
    for (int column = 0; column + 1 < size; ++column) {
      const auto i = static_cast<std::size_t>(column);
      batch.length[i] = 1, batch.scalar_front[i] = depth_of(row), batch.scalar_back[i] = depth_of(column);
    }
    integrate_exact(identity, scene::Emission::independent, batch);
    std::transform(batch.red.begin(), batch.red.begin() + static_cast<std::ptrdiff_t>(n - 1),
                   psi.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * n),
                   [](double value) { return static_cast<float>(value); });
  }
}

}  // namespace tessera::integrals
