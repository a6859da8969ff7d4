// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/extents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace tessera::readers {

bool holds(const Extent& extent, const Extent& part) {
  for (std::size_t a = 0; a < 3; ++a)
    if (part[2 * a] < extent[2 * a] || part[2 * a + 1] > extent[2 * a + 1]) return false;
  return true;
}

double cells_in(const Extent& extent) {
  double cells = 1;
  for (std::size_t a = 0; a < 3; ++a)
    cells *= std::max(0.0, static_cast<double>(extent[2 * a + 1]) - static_cast<double>(extent[2 * a]));
  return cells;
}

double cells_covered(std::span<const Extent> pieces) {
  // All planes at which pieces begin or end. There are only a few boxes between them, because pieces are in rows.
  std::array<std::vector<int>, 3> planes;
  double boxes = 1, sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const Extent& piece : pieces) planes[a].insert(planes[a].end(), {piece[2 * a], piece[2 * a + 1]});
    std::sort(planes[a].begin(), planes[a].end());
    planes[a].erase(std::unique(planes[a].begin(), planes[a].end()), planes[a].end());
    boxes *= static_cast<double>(planes[a].size());
  }
  for (const Extent& piece : pieces) sum += cells_in(piece);
  if (boxes * static_cast<double>(pieces.size()) > 1e9)
    return sum;  // for thousands of pieces that are not in rows, the sum of their sizes is used
  double covered = 0;
  for (std::size_t k = 1; k < planes[2].size(); ++k)
    for (std::size_t j = 1; j < planes[1].size(); ++j)
      for (std::size_t i = 1; i < planes[0].size(); ++i) {
        const Extent box{planes[0][i - 1], planes[0][i],     planes[1][j - 1],
                         planes[1][j],     planes[2][k - 1], planes[2][k]};
        if (std::any_of(pieces.begin(), pieces.end(), [&](const Extent& piece) { return holds(piece, box); }))
          covered += cells_in(box);
      }
  return covered;
}

Extent box_of(std::span<const Extent> pieces) {
  Extent box{0, -1, 0, -1, 0, -1};
  for (std::size_t n = 0; n < pieces.size(); ++n)
    for (std::size_t a = 0; a < 3; ++a) {
      box[2 * a] = n == 0 ? pieces[n][2 * a] : std::min(box[2 * a], pieces[n][2 * a]);
      box[2 * a + 1] = n == 0 ? pieces[n][2 * a + 1] : std::max(box[2 * a + 1], pieces[n][2 * a + 1]);
    }
  return box;
}

std::string words_of(const Extent& extent) { return fmt::format("{}", fmt::join(extent, " ")); }

}  // namespace tessera::readers
