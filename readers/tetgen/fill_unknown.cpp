// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "readers/tetgen/surface_fields.hpp"

namespace tessera::readers {

void fill_unknown(const FilledSurface& mesh, std::size_t known, std::vector<double>& values) {
  std::vector<bool> is_known(mesh.points.size());
  std::fill_n(is_known.begin(), known, true);
  values.resize(mesh.points.size(), 0.0);
  for (bool progress = true; progress;) {
    progress = false;
    std::vector<double> sum(values.size(), 0.0), count(values.size(), 0.0);
    for (std::size_t t = 0; t < mesh.tets.size(); t += 4)
      for (std::size_t a = t; a < t + 4; ++a)
        for (std::size_t b = t; b < t + 4; ++b)
          if (!is_known[mesh.tets[a]] && is_known[mesh.tets[b]]) {
            sum[mesh.tets[a]] += values[mesh.tets[b]];
            ++count[mesh.tets[a]];
          }
    for (std::size_t v = 0; v < values.size(); ++v)
      if (count[v] > 0) {
        values[v] = sum[v] / count[v];
        is_known[v] = progress = true;
      }
  }
}

}  // namespace tessera::readers
