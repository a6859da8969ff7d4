// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_elements.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <tuple>

#include "cells/mix_bits.hpp"
#include "readers/gmsh/gmsh_tags.hpp"
#include "readers/gmsh/gmsh_types.hpp"
#include "readers/gmsh/gmsh_views.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Returns a cell type as described by Gmsh's library, which is called when the type first occurs.
const GmshCell& cell_of(int type, std::map<int, GmshCell>& known, std::vector<std::string>& notes) {
  const auto [found, is_new] = known.try_emplace(type);
  if (!is_new) return found->second;
  const GmshElementType of = gmsh_element_type(type);
  if (of.corners == 6 && of.nodes == 0)
    found->second = gmsh_cell(1, 6, std::vector<double>(18)), found->second.by_corners = true;
  else if (of.corners >= 4 && of.corners <= 8 && of.corners != 7 && of.places.size() == 3 * of.nodes)
    found->second = gmsh_cell(of.order, of.corners, of.places);
  if (found->second.by_corners)
    notes.push_back(fmt::format("cells of type {} are rendered as linear cells with the same corners", of.name));
  return found->second;
}

/// Numbers memberships in the order of occurrence.
class Memberships {
 public:
  explicit Memberships(std::vector<GmshMembership>& list) : list_(list) {}
  std::uint32_t number_of(const GmshMembership& membership) {
    const auto [found, is_new] = numbers_.try_emplace(membership, static_cast<std::uint32_t>(list_.size()));
    if (is_new) list_.push_back(membership);
    return found->second;
  }

 private:
  std::vector<GmshMembership>& list_;
  std::map<GmshMembership, std::uint32_t> numbers_;
};

GmshMembership membership_of_entity(int entity) {
  GmshMembership membership;
  gmsh::model::getPhysicalGroupsForEntity(3, entity, membership.groups);
  for (int& group : membership.groups) group = std::abs(group);
  std::sort(membership.groups.begin(), membership.groups.end());
  std::vector<int> partitions;
  gmsh::model::getPartitions(3, entity, partitions);
  if (!partitions.empty()) membership.partition = partitions.front();
  return membership;
}

/// Merges elements that are listed several times, once for each group. Duplicates within a group are kept.
class Repetitions {
 public:
  Repetitions(GmshVolumes& volumes, Memberships& memberships) : volumes_(volumes), memberships_(memberships) {}

  void merge() {
    std::vector<Key> keys;
    for (std::uint32_t e = 0; e < volumes_.elements.size(); ++e)
      for (std::size_t k = 0; k < volumes_.elements[e].tags.size(); ++k) keys.push_back({hash_of(e, k), e, k});
    std::sort(keys.begin(), keys.end());
    std::vector<std::vector<std::uint8_t>> is_gone(volumes_.elements.size());
    for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
      for (last = first + 1; last < keys.size() && keys[last].hash == keys[first].hash; ++last) {
      }
      constexpr std::size_t most = 64;  // limit of groups per element, so that damaged files do not take quadratic time
      for (std::size_t a = first; a + 1 < last; ++a)
        for (std::size_t b = a + 1; b < std::min(last, a + most); ++b)
          if (takes(keys[a], keys[b], is_gone)) mark(keys[b], is_gone);
    }
    for (std::size_t e = 0; e < is_gone.size(); ++e)
      if (!is_gone[e].empty()) remove(volumes_.elements[e], is_gone[e]);
    std::sort(volumes_.other_tags.begin(), volumes_.other_tags.end());
  }

 private:
  struct Key {
    std::uint64_t hash = 0;
    std::uint32_t elements = 0;
    std::size_t place = 0;
    bool operator<(const Key& other) const {
      return std::tie(hash, elements, place) < std::tie(other.hash, other.elements, other.place);
    }
  };
  using Gone = std::vector<std::vector<std::uint8_t>>;

  [[nodiscard]] std::span<const std::size_t> nodes_of(std::uint32_t elements, std::size_t place) const {
    const GmshElements& of = volumes_.elements[elements];
    return std::span(of.nodes).subspan(place * of.nodes_a_cell, of.nodes_a_cell);
  }
  [[nodiscard]] std::uint64_t hash_of(std::uint32_t elements, std::size_t place) const {
    std::uint64_t sum = 0;
    for (const std::size_t node : nodes_of(elements, place)) sum += cells::mix(node + 1);
    return sum;
  }
  void mark(const Key& key, Gone& is_gone) const {
    is_gone[key.elements].resize(volumes_.elements[key.elements].tags.size());
    is_gone[key.elements][key.place] = 1;
  }
  static bool is_marked(const Key& key, const Gone& is_gone) {
    return !is_gone[key.elements].empty() && is_gone[key.elements][key.place] != 0;
  }

  /// Whether `b` is element `a` in another group. If so, adds that group to `a`.
  bool takes(const Key& a, const Key& b, const Gone& is_gone) {
    if (is_marked(a, is_gone) || is_marked(b, is_gone)) return false;
    GmshElements &of_a = volumes_.elements[a.elements], &of_b = volumes_.elements[b.elements];
    if (of_a.cell != of_b.cell) return false;
    const auto nodes_a = nodes_of(a.elements, a.place), nodes_b = nodes_of(b.elements, b.place);
    if (!std::is_permutation(nodes_a.begin(), nodes_a.end(), nodes_b.begin(), nodes_b.end())) return false;
    GmshMembership both = volumes_.memberships[of_a.members[a.place]];
    const GmshMembership& other = volumes_.memberships[of_b.members[b.place]];
    if (other.groups.empty() || both.groups.empty()) return false;
    for (const int group : other.groups) {
      const auto at = std::lower_bound(both.groups.begin(), both.groups.end(), group);
      if (at != both.groups.end() && *at == group) return false;
      both.groups.insert(at, group);
    }
    of_a.members[a.place] = memberships_.number_of(both);
    volumes_.other_tags.emplace_back(of_a.tags[a.place], of_b.tags[b.place]);
    return true;
  }

  static void remove(GmshElements& elements, const std::vector<std::uint8_t>& is_gone) {
    const std::size_t n = elements.nodes_a_cell;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < elements.tags.size(); ++k) {
      if (is_gone[k] != 0) continue;
      elements.tags[kept] = elements.tags[k], elements.members[kept] = elements.members[k];
      std::copy_n(&elements.nodes[k * n], n, &elements.nodes[kept * n]);
      ++kept;
    }
    elements.tags.resize(kept), elements.members.resize(kept), elements.nodes.resize(kept * n);
  }

  GmshVolumes& volumes_;
  Memberships& memberships_;
};

/// Sets memberships for individual elements, as listed in MSH 1 and 2.
void take_element_tags(const std::vector<GmshElementTags>& tags, GmshVolumes& volumes, Memberships& memberships) {
  std::vector<std::size_t> numbers;
  numbers.reserve(tags.size());
  for (const GmshElementTags& each : tags) numbers.push_back(each.element);
  const TagIndex places(numbers);
  bool has_groups = false;
  int first_group = 0;
  for (GmshElements& elements : volumes.elements)
    for (std::size_t k = 0; k < elements.tags.size(); ++k) {
      const std::size_t place = places.find(elements.tags[k]);
      if (place == TagIndex::none) continue;  // numbered differently; keeps the groups of its entity
      GmshMembership membership;
      const int group = std::abs(tags[place].group);
      if (group != 0) membership.groups.push_back(group);
      membership.partition = std::abs(tags[place].partition);
      elements.members[k] = memberships.number_of(membership);
      if (first_group == 0) first_group = group;
      has_groups = has_groups || (group != 0 && group != first_group);
    }
  if (has_groups) Repetitions(volumes, memberships).merge();
}

}  // namespace

GmshVolumes gmsh_volumes(const std::filesystem::path& file, const std::string& source,
                         std::vector<std::string>& notes) {
  GmshVolumes volumes;
  Memberships memberships(volumes.memberships);
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities, 3);
  for (const auto& [dimension, entity] : entities) {
    std::string kind;
    gmsh::model::getType(3, entity, kind);
    if (kind.starts_with("Ghost")) continue;  // elements of ghost entities also belong to another partition
    const std::uint32_t member = memberships.number_of(membership_of_entity(entity));
    std::vector<int> element_types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(element_types, tags, nodes, 3, entity);
    for (std::size_t k = 0; k < element_types.size(); ++k) {
      if (tags[k].empty()) continue;
      const GmshCell& cell = cell_of(element_types[k], volumes.cells, notes);
      if (cell.type == CellType::empty_cell)
        throw scene::bad_input(
            fmt::format("{}: its cells of Gmsh's type {} are not rendered; split them into "
                        "tetrahedra",
                        source, element_types[k]));
      GmshElements elements{&cell, nodes[k].size() / tags[k].size(), std::move(tags[k]), std::move(nodes[k]), {}};
      elements.members.assign(elements.tags.size(), member);
      volumes.elements.push_back(std::move(elements));
    }
  }
  if (!file.empty())
    if (const auto tags = gmsh_element_tags(file)) take_element_tags(*tags, volumes, memberships);
  return volumes;
}

}  // namespace tessera::readers
