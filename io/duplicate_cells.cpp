#include "io/duplicate_cells.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "io/mix_bits.hpp"
#include "scene/threads.hpp"

namespace tessera::io {
namespace {

using scene::Tet;
using scene::TetMesh;

constexpr std::size_t grain = 32768;

template <class T>
struct Freed {
  void operator()(T* memory) const { std::free(memory); }
};

std::uint64_t key_of_place(const glm::dvec3& p) { return mix(hash_of_place(p)); }

/// A number for each cell that depends on its tets' corners' positions alone, in whatever order they are.
class CellKeys {
 public:
  explicit CellKeys(const TetMesh& mesh)
      : mesh_(mesh), of_vertex_(std::make_unique_for_overwrite<std::uint64_t[]>(mesh.positions.size())) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), grain), [&](const auto& range) {
      for (std::size_t v = range.begin(); v < range.end(); ++v) of_vertex_[v] = key_of_place(mesh.positions[v]);
    });
  }

  /// Calls `use(first tet, tet after the last, key)` for each cell, from several threads.
  template <class Use>
  void each(const Use& use) const {
    const std::size_t tets = mesh_.tets.size();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tets, grain), [&](const auto& range) {
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

  const TetMesh& mesh_;
  std::unique_ptr<std::uint64_t[]> of_vertex_;
};

/// A set of keys, of which it keeps a place and 32 bits: of 10 million different ones it takes two for the same once in
/// some hundred meshes, and they are then compared.
class KeySet {
 public:
  explicit KeySet(std::size_t keys)
      : places_(keys + keys / 2 + 64),
        words_(static_cast<std::uint32_t*>(std::calloc(places_, sizeof(std::uint32_t)))) {
    if (words_ == nullptr) throw std::bad_alloc();
  }

  /// Whether it seems to have been there already.
  bool insert(std::uint64_t key) {
    const std::uint32_t word = std::max<std::uint32_t>(static_cast<std::uint32_t>(key), 1);
    __extension__ using Product = unsigned __int128;
    auto place = static_cast<std::size_t>(static_cast<Product>(key) * places_ >> 64);
    while (true) {
      std::atomic_ref<std::uint32_t> there(words_.get()[place]);
      std::uint32_t found = there.load(std::memory_order_relaxed);
      if (found == 0 && there.compare_exchange_strong(found, word, std::memory_order_relaxed)) return false;
      if (found == word) return true;
      if (++place == places_) place = 0;
    }
  }

 private:
  std::size_t places_;
  std::unique_ptr<std::uint32_t, Freed<std::uint32_t>> words_;
};

template <class T>
std::vector<T> joined_lists(tbb::enumerable_thread_specific<std::vector<T>>& lists) {
  std::vector<T> all;
  for (std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end()), list = {};
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

/// Some cell's tets, [first, last).
struct KeyedCell {
  std::uint64_t key = 0;
  std::size_t first = 0, last = 0;
  bool operator<(const KeyedCell& other) const { return std::tie(key, first) < std::tie(other.key, other.first); }
};

using Corners = std::array<glm::dvec3, 4>;

bool is_before(const glm::dvec3& p, const glm::dvec3& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); }

/// The tets' corners, in an order that depends on positions alone.
void sorted_corners(const TetMesh& mesh, const KeyedCell& cell, std::vector<Corners>& corners) {
  corners.clear();
  for (std::size_t t = cell.first; t < cell.last; ++t) {
    Corners of_tet;
    for (std::size_t k = 0; k < 4; ++k) of_tet[k] = mesh.positions[mesh.tets[t][k]];
    std::sort(of_tet.begin(), of_tet.end(), is_before);
    corners.push_back(of_tet);
  }
  std::sort(corners.begin(), corners.end(), [](const Corners& a, const Corners& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
  });
}

/// Cells that an earlier one has the corners of, in their order.
std::vector<KeyedCell> duplicates_of(const TetMesh& mesh) {
  const CellKeys keys(mesh);
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> seen_again;
  {
    KeySet seen(mesh.original_cell.empty() ? mesh.tets.size()
                                           : std::min<std::size_t>(mesh.tets.size(), mesh.original_cell.back() + 1));
    keys.each([&](std::size_t, std::size_t, std::uint64_t key) {
      if (seen.insert(key)) seen_again.local().push_back(key);
    });
  }
  std::vector<std::uint64_t> repeated = joined_lists(seen_again);
  if (repeated.empty()) return {};
  repeated.erase(std::unique(repeated.begin(), repeated.end()), repeated.end());
  tbb::enumerable_thread_specific<std::vector<KeyedCell>> found;
  keys.each([&](std::size_t first, std::size_t last, std::uint64_t key) {
    if (std::binary_search(repeated.begin(), repeated.end(), key)) found.local().push_back({key, first, last});
  });
  std::vector<KeyedCell> cells = joined_lists(found);
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

/// Tets and what goes with them but those of these cells.
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

bool DuplicateSample::has_repetitions(const TetMesh& mesh, std::span<const std::size_t> tets) {
  KeySet seen(tets.size());
  return std::ranges::any_of(tets, [&](std::size_t t) {
    std::uint64_t key = 0;
    for (const std::uint32_t v : mesh.tets[t]) key += key_of_place(mesh.positions[v]);
    return seen.insert(key);
  });
}

std::uint64_t find_duplicate_cells(TetMesh& mesh, bool drop, int threads) {
  if (mesh.tets.size() < 2) return 0;
  return tbb::task_arena(scene::threads_for(threads)).execute([&] {
    const std::vector<KeyedCell> duplicates = duplicates_of(mesh);
    if (drop && !duplicates.empty()) remove(duplicates, mesh);
    return static_cast<std::uint64_t>(duplicates.size());
  });
}

}  // namespace tessera::io
