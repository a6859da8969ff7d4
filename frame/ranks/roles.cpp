// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

bool contains(const std::vector<int>& ranks, int rank) {
  return std::find(ranks.begin(), ranks.end(), rank) != ranks.end();
}

std::vector<int> consecutive(int first, int count) {
  std::vector<int> ranks(static_cast<std::size_t>(count));
  std::iota(ranks.begin(), ranks.end(), first);
  return ranks;
}

}  // namespace

bool Roles::projects(int rank) const { return contains(projectors, rank); }
bool Roles::composites(int rank) const { return contains(compositors, rank); }

Roles assign_roles(int ranks, std::optional<int> projectors, std::optional<int> compositors) {
  for (const auto& [asked, setting] : {std::pair{projectors, "`projectors`"}, std::pair{compositors, "`compositors`"}})
    if (asked && (*asked < 1 || *asked > ranks))
      throw scene::bad_input(fmt::format("{} {}: this job has {} rank{}; give 1 to {}, or start more with mpirun -n",
                                         setting, *asked, ranks, ranks == 1 ? "" : "s", ranks));
  const auto rest = [&](int taken) { return taken < ranks ? ranks - taken : ranks; };
  const int n = projectors.value_or(compositors ? rest(*compositors) : ranks);
  const int p = compositors.value_or(projectors ? rest(*projectors) : ranks);
  if (n + p == ranks) return {consecutive(0, n), consecutive(n, p)};
  if (std::max(n, p) == ranks) return {consecutive(0, n), consecutive(0, p)};
  throw scene::bad_input(
      fmt::format("`projectors` {} `compositors` {}: on {} ranks they must add up to {}, or, if ranks have both roles, "
                  "the larger must be {}; start mpirun -n {}",
                  n, p, ranks, ranks, ranks, n + p));
}

}  // namespace v0_1
}  // namespace tessera
