// SPDX-License-Identifier: BSD-3-Clause
#include "cells/duplicate_cells.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <memory>
#include <new>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "cells/mix_bits.hpp"
#include "scene/position_order.hpp"

namespace tessera::cells {
namespace {

using scene::Tet;
using scene::TetMesh;
using scene::TetMeshView;

constexpr std::size_t grain = 32768;

template <class T>
struct Freed {
  void operator()(T* memory) const { std::free(memory); }
};

/// Returns a hash of a position; those of -0 and 0 differ.
std::uint64_t key_of_place(const glm::dvec3& p) {
  const auto word = [](double x, std::uint64_t odd, int turn) {
    return std::rotl(std::bit_cast<std::uint64_t>(x) * odd, turn);
  };
  const std::uint64_t sum =
      word(p.x, 0x9e3779b97f4a7c15, 0) ^ word(p.y, 0xbf58476d1ce4e5b9, 21) ^ word(p.z, 0x94d049bb133111eb, 42);
  return mix((sum ^ sum >> 32) * 0xff51afd7ed558ccd);
}

/// Computes a key for each cell, which depends only on the positions of the corners of its tets, in any order.
class CellKeys {
 public:
  explicit CellKeys(const TetMeshView& mesh)
      : mesh_(mesh), of_vertex_(std::make_unique_for_overwrite<std::uint64_t[]>(mesh.positions.size())) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), grain), [&](const auto& range) {
      for (std::size_t v = range.begin(); v < range.end(); ++v) of_vertex_[v] = key_of_place(mesh.positions[v]);
    });
  }

  /// Calls `begin()` for each range of cells, from several threads. Then calls the function that `begin()` returned
  /// with `(first tet, tet after the last, key)` for each cell of the range.
  template <class Begin>
  void each(const Begin& begin) const {
    const std::size_t tets = mesh_.tets.size();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tets, grain), [&](const auto& range) {
      auto use = begin();
      std::size_t t = range.begin();
      while (t > 0 && t < range.end() && mesh_.cell_of(t) == mesh_.cell_of(t - 1)) ++t;
      while (t < range.end()) {
        const std::size_t first = t;
        const std::uint64_t cell = mesh_.cell_of(t);
        std::uint64_t key = 0;
        do key += key_of(mesh_.tets[t++]);
        while (t < tets && mesh_.cell_of(t) == cell);
        use(first, t, key);
      }
    });
  }

 private:
  [[nodiscard]] std::uint64_t key_of(const Tet& tet) const {
    return of_vertex_[tet[0]] + of_vertex_[tet[1]] + of_vertex_[tet[2]] + of_vertex_[tet[3]];
  }

  TetMeshView mesh_;
  std::unique_ptr<std::uint64_t[]> of_vertex_;
};

/// A set of keys that identifies a key by its slot and 32 of its bits. For 10 million different keys, it reports a
/// false match in about one of several hundred meshes, so the cells of matches are then compared.
class KeySet {
 public:
  explicit KeySet(std::size_t keys)
      : places_(keys + keys / 2 + 64),
        words_(static_cast<std::uint32_t*>(std::calloc(places_, sizeof(std::uint32_t)))) {
    if (words_ == nullptr) throw std::bad_alloc();
  }

  void prefetch(std::uint64_t key) const { __builtin_prefetch(words_.get() + place_of(key), 1); }

  /// Whether the key seems to have been inserted before.
  bool insert(std::uint64_t key) {
    const std::uint32_t word = std::max<std::uint32_t>(static_cast<std::uint32_t>(key), 1);
    std::size_t place = place_of(key);
    while (true) {
      std::atomic_ref<std::uint32_t> there(words_.get()[place]);
      std::uint32_t found = there.load(std::memory_order_relaxed);
      if (found == 0 && there.compare_exchange_strong(found, word, std::memory_order_relaxed)) return false;
      if (found == word) return true;
      if (++place == places_) place = 0;
    }
  }

 private:
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const {
    __extension__ using Product = unsigned __int128;
    return static_cast<std::size_t>(static_cast<Product>(key) * places_ >> 64);
  }

  std::size_t places_;
  std::unique_ptr<std::uint32_t, Freed<std::uint32_t>> words_;
};

/// Inserts keys some time after prefetching their slots, which hides most of the memory latency.
class DelayedInsertion {
 public:
  DelayedInsertion(KeySet& set, std::vector<std::uint64_t>& seen_again) : set_(set), seen_again_(seen_again) {}
  ~DelayedInsertion() {
    for (std::size_t k = count_ - std::min(count_, delay); k < count_; ++k) insert(waiting_[k % delay]);
  }
  DelayedInsertion(const DelayedInsertion&) = delete;
  DelayedInsertion& operator=(const DelayedInsertion&) = delete;

  void operator()(std::size_t /*first*/, std::size_t /*last*/, std::uint64_t key) {
    std::uint64_t& place = waiting_[count_ % delay];
    if (count_++ >= delay) insert(place);
    set_.prefetch(place = key);
  }

 private:
  void insert(std::uint64_t key) {
    if (set_.insert(key)) seen_again_.push_back(key);
  }

  static constexpr std::size_t delay = 16;
  KeySet& set_;
  std::vector<std::uint64_t>& seen_again_;
  std::array<std::uint64_t, delay> waiting_{};
  std::size_t count_ = 0;
};

template <class T>
std::vector<T> joined_lists(tbb::enumerable_thread_specific<std::vector<T>>& lists) {
  std::vector<T> all;
  for (std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end()), list = {};
  return all;
}

template <class T>
std::vector<T> sorted_lists(tbb::enumerable_thread_specific<std::vector<T>>& lists) {
  std::vector<T> all = joined_lists(lists);
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

/// A cell with the tets [first, last).
struct KeyedCell {
  std::uint64_t key = 0;
  std::size_t first = 0, last = 0;
  bool operator<(const KeyedCell& other) const { return std::tie(key, first) < std::tie(other.key, other.first); }
};

using Corners = std::array<glm::dvec3, 4>;

/// Returns the corners of the tets, in an order that depends only on positions.
void sorted_corners(const TetMeshView& mesh, const KeyedCell& cell, std::vector<Corners>& corners) {
  corners.clear();
  for (std::size_t t = cell.first; t < cell.last; ++t) {
    Corners of_tet;
    for (std::size_t k = 0; k < 4; ++k) of_tet[k] = mesh.positions[mesh.tets[t][k]];
    std::sort(of_tet.begin(), of_tet.end(), scene::is_before);
    corners.push_back(of_tet);
  }
  std::sort(corners.begin(), corners.end(), [](const Corners& a, const Corners& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), scene::is_before);
  });
}

/// Returns the keys that seem to occur several times, each once. The keys are those of `each(begin)` as in CellKeys.
template <class Each>
std::vector<std::uint64_t> repeated_keys(std::size_t count, const Each& each) {
  KeySet seen(count);
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> seen_again;
  each([&] { return DelayedInsertion(seen, seen_again.local()); });
  std::vector<std::uint64_t> repeated = sorted_lists(seen_again);
  repeated.erase(std::unique(repeated.begin(), repeated.end()), repeated.end());
  return repeated;
}

std::size_t cells_of(const TetMeshView& mesh) {
  return mesh.original_cell.empty() ? mesh.tets.size()
                                    : std::min<std::size_t>(mesh.tets.size(), mesh.original_cell.back() + 1);
}

/// Returns the cells with the same corners as an earlier cell, in order.
std::vector<KeyedCell> duplicates_of(const TetMeshView& mesh) {
  const CellKeys keys(mesh);
  const std::vector<std::uint64_t> repeated =
      repeated_keys(cells_of(mesh), [&](const auto& begin) { keys.each(begin); });
  if (repeated.empty()) return {};
  tbb::enumerable_thread_specific<std::vector<KeyedCell>> found;
  keys.each([&] {
    return [&list = found.local(), &repeated](std::size_t first, std::size_t last, std::uint64_t key) {
      if (std::binary_search(repeated.begin(), repeated.end(), key)) list.push_back({key, first, last});
    };
  });
  std::vector<KeyedCell> cells = sorted_lists(found);
  std::vector<std::uint8_t> is_duplicate(cells.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size(), 1024), [&](const auto& range) {
    std::vector<Corners> corners, others;
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      if (k > 0 && cells[k - 1].key == cells[k].key) continue;
      sorted_corners(mesh, cells[k], corners);
      for (std::size_t other = k + 1; other < cells.size() && cells[other].key == cells[k].key; ++other) {
        sorted_corners(mesh, cells[other], others);
        is_duplicate[other] = corners == others ? 1 : 0;
      }
    }
  });
  std::vector<KeyedCell> duplicates;
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (is_duplicate[k] != 0) duplicates.push_back(cells[k]);
  std::sort(duplicates.begin(), duplicates.end(),
            [](const KeyedCell& a, const KeyedCell& b) { return a.first < b.first; });
  return duplicates;
}

/// Removes the tets of these cells and the attributes of the tets.
void remove(const std::vector<KeyedCell>& cells, TetMesh& mesh) {
  if (mesh.original_cell.empty()) {
    mesh.original_cell.resize(mesh.tets.size());
    std::iota(mesh.original_cell.begin(), mesh.original_cell.end(), std::uint64_t{0});
  }
  const auto without = [&](auto& list) {
    auto to = list.begin() + static_cast<std::ptrdiff_t>(cells.front().first);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::size_t next = k + 1 < cells.size() ? cells[k + 1].first : list.size();
      to = std::move(list.begin() + static_cast<std::ptrdiff_t>(cells[k].last),
                     list.begin() + static_cast<std::ptrdiff_t>(next), to);
    }
    list.erase(to, list.end());
  };
  without(mesh.tets);
  without(mesh.original_cell);
  if (mesh.association == scene::Association::cell) without(mesh.scalars);
}

}  // namespace

std::uint64_t find_duplicate_cells(TetMesh& mesh, bool drop) {
  if (mesh.tets.size() < 2) return 0;
  const std::vector<KeyedCell> duplicates = duplicates_of(mesh);
  if (drop && !duplicates.empty()) remove(duplicates, mesh);
  return static_cast<std::uint64_t>(duplicates.size());
}

std::uint64_t count_duplicate_cells(const TetMeshView& mesh) {
  if (mesh.tets.size() < 2) return 0;
  return duplicates_of(mesh).size();
}

std::vector<std::uint64_t> duplicate_keys(const TetMeshView& mesh) {
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> lists;
  CellKeys(mesh).each(
      [&] { return [&list = lists.local()](std::size_t, std::size_t, std::uint64_t key) { list.push_back(key); }; });
  return joined_lists(lists);
}

std::uint64_t count_repetitions(const std::vector<std::uint64_t>& keys) {
  const std::vector<std::uint64_t> repeated = repeated_keys(keys.size(), [&](const auto& begin) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), grain), [&](const auto& range) {
      auto use = begin();
      for (std::size_t k = range.begin(); k < range.end(); ++k) use(k, k + 1, keys[k]);
    });
  });
  std::vector<std::uint64_t> times(repeated.size(), 0);
  std::uint64_t count = 0;
  if (!repeated.empty())
    for (const std::uint64_t key : keys)
      if (const auto at = std::lower_bound(repeated.begin(), repeated.end(), key); at != repeated.end() && *at == key)
        if (times[static_cast<std::size_t>(at - repeated.begin())]++ > 0) ++count;
  return count;
}

}  // namespace tessera::cells
