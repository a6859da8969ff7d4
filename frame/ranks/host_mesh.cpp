// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/host_mesh.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "exchange/shared_pages.hpp"

namespace tessera::frame {
namespace {

using scene::Team;

/// A sum over all members, and a sum over the members before this one.
struct Counts {
  std::uint64_t before = 0, all = 0;
  Counts(Team& team, std::uint64_t own) {
    const std::vector<std::uint64_t> each = team.gather(own);
    before = std::accumulate(each.begin(), each.begin() + team.rank(), std::uint64_t{0});
    all = std::accumulate(each.begin(), each.end(), std::uint64_t{0});
  }
};

/// Returns the position of each of this member's tets in the list of all members' tets. That list is sorted by index;
/// each member's indices must ascend. Equal indices, which occur in parts without global indices, are sorted by member.
std::vector<std::uint64_t> places_of(Team& team, std::span<const std::uint64_t> own) {
  const std::vector<std::uint64_t> sizes = team.gather(own.size());
  std::vector<std::span<std::uint64_t>> lists;
  auto* const all = team.memory_of<std::uint64_t>(Team::Room::early_numbers,
                                                  std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0}));
  std::uint64_t first = 0;
  for (const std::uint64_t size : sizes) {
    lists.emplace_back(all + first, size);
    first += size;
  }
  std::copy(own.begin(), own.end(), lists[static_cast<std::size_t>(team.rank())].data());
  team.barrier();
  std::vector<std::uint64_t> places(own.size());
  std::vector<std::size_t> passed(lists.size());
  const auto rank = static_cast<std::size_t>(team.rank());
  for (std::size_t t = 0; t < own.size(); ++t) {
    places[t] = t;
    for (std::size_t l = 0; l < lists.size(); ++l) {
      if (l == rank) continue;
      while (passed[l] < lists[l].size() && lists[l][passed[l]] + (l < rank ? 0 : 1) <= own[t]) ++passed[l];
      places[t] += passed[l];
    }
  }
  team.barrier();
  return places;
}

}  // namespace

HostMesh HostMesh::made(Team& team, const scene::TetMeshView& part, std::span<const scene::Tet> tets,
                        std::span<const std::uint64_t> global_tet) {
  const Counts vertices(team, part.positions.size()), cells(team, tets.size());
  const std::uint64_t scalars = part.association == scene::Association::point ? vertices.all : cells.all;
  const std::uint64_t bytes = vertices.all * sizeof(glm::dvec3) + cells.all * (sizeof(scene::Tet) + 8) + scalars * 8;
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  const bool fits = vertices.all <= most && cells.all <= most && bytes <= exchange::available_memory() / 2;
  if (scene::least_of(std::uint64_t{fits && cells.all > 0}, &team) == 0) return {};

  std::vector<std::uint64_t> numbers(global_tet.begin(), global_tet.end());
  if (numbers.empty()) {
    numbers.resize(tets.size());
    std::iota(numbers.begin(), numbers.end(), std::uint64_t{0});
  }
  // If these are all tets of the whole mesh, their indices are their positions.
  const bool whole = scene::largest_of(numbers.empty() ? 0 : numbers.back() + 1, &team) == cells.all;
  const std::vector<std::uint64_t> found = whole ? std::vector<std::uint64_t>() : places_of(team, numbers);
  const std::vector<std::uint64_t>& places = whole ? numbers : found;

  auto* const positions = team.memory_of<glm::dvec3>(Team::Room::positions, vertices.all);
  auto* const all_tets = team.memory_of<scene::Tet>(Team::Room::tets, cells.all);
  auto* const all_scalars = team.memory_of<double>(Team::Room::scalars, scalars);
  std::uint64_t* const all_numbers = whole ? nullptr : team.memory_of<std::uint64_t>(Team::Room::numbers, cells.all);
  const bool per_point = part.association == scene::Association::point;
  std::copy(part.positions.begin(), part.positions.end(), positions + vertices.before);
  if (per_point) std::copy(part.scalars.begin(), part.scalars.end(), all_scalars + vertices.before);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const std::uint64_t place = places[t];
    for (int corner = 0; corner < 4; ++corner)
      all_tets[place][corner] = tets[t][corner] + static_cast<std::uint32_t>(vertices.before);
    if (!per_point) all_scalars[place] = part.scalars[t];
    if (!whole) all_numbers[place] = numbers[t];
  }
  team.barrier();

  HostMesh made;
  made.mesh.positions = {positions, vertices.all};
  made.mesh.tets = {all_tets, cells.all};
  made.mesh.scalars = {all_scalars, scalars};
  made.mesh.association = part.association;
  made.mesh.field_name = part.field_name;
  if (!whole) made.global_tet = {all_numbers, cells.all};
  return made;
}

}  // namespace tessera::frame
