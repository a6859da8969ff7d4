// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/exodus_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace tessera::readers {

ExodusFaces::Lists ExodusFaces::read(ex_entity_type type, std::int64_t id, std::int64_t count,
                                     std::int64_t total) const {
  if (count < 0 || total < 0 || static_cast<std::uint64_t>(count) > most_values_ ||
      static_cast<std::uint64_t>(total) > most_values_)
    fail_(fmt::format("block {} states {} lists with {} numbers in total, which is impossible", id, count, total));
  Lists lists;
  if (count == 0) return lists;
  lists.sizes.resize(static_cast<std::size_t>(count));
  lists.numbers.resize(static_cast<std::size_t>(total));
  const bool of_faces = type == EX_FACE_BLOCK;
  if (ex_get_entity_count_per_polyhedra(id_, type, id, lists.sizes.data()) < 0 ||
      ex_get_conn(id_, type, id, of_faces ? lists.numbers.data() : nullptr, nullptr,
                  of_faces ? nullptr : lists.numbers.data()) < 0)
    fail_(fmt::format("the faces of block {} cannot be read", id));
  std::int64_t sum = 0;
  for (const int size : lists.sizes) {
    if (size < 0) fail_(fmt::format("block {} has a list of {} numbers", id, size));
    sum += size;
  }
  if (sum != total) fail_(fmt::format("the lists of block {} have {} numbers, not {}", id, sum, total));
  return lists;
}

void ExodusFaces::read_faces() {
  has_read_ = true;
  starts_.assign(1, 0);
  const std::int64_t blocks = ex_inquire_int(id_, EX_INQ_FACE_BLK);
  if (blocks < 0 || static_cast<std::uint64_t>(blocks) > most_values_)
    fail_(fmt::format("it states {} face blocks", blocks));
  std::vector<std::int64_t> ids(static_cast<std::size_t>(std::max<std::int64_t>(blocks, 0)));
  if (!ids.empty() && ex_get_ids(id_, EX_FACE_BLOCK, ids.data()) < 0) fail_("the face blocks cannot be read");
  for (const std::int64_t id : ids) {
    ex_block info{};
    info.id = id;
    info.type = EX_FACE_BLOCK;
    if (ex_get_block_param(id_, &info) < 0) fail_("a face block cannot be read");
    const std::string topology(info.topology, ::strnlen(info.topology, sizeof info.topology));
    if (topology != "nsided" && topology != "NSIDED")
      fail_(fmt::format("face block {} holds '{}', not nsided faces", id, topology.substr(0, 20)));
    const Lists faces = read(EX_FACE_BLOCK, id, info.num_entry, info.num_nodes_per_entry);
    for (const int size : faces.sizes) starts_.push_back(starts_.back() + static_cast<std::size_t>(size));
    corners_.insert(corners_.end(), faces.numbers.begin(), faces.numbers.end());
  }
  times_used_.assign(starts_.size() - 1, 0);
}

void ExodusFaces::add(std::int64_t id, const ex_block& info, std::int64_t points, cells::CellBlock& block) {
  if (!has_read_) read_faces();
  const Lists cells = read(EX_ELEM_BLOCK, id, info.num_entry, info.num_faces_per_entry);
  block.face_locations.resize(block.types.size() - cells.sizes.size(), cells::CellBlock::no_faces);
  std::size_t next = 0;
  for (const int size : cells.sizes) {
    block.face_locations.push_back(static_cast<std::int64_t>(block.faces.size()));
    block.faces.push_back(static_cast<std::uint32_t>(size));
    for (int k = 0; k < size; ++k) {
      const std::int64_t number = cells.numbers[next++];
      if (number < 1 || static_cast<std::size_t>(number) >= starts_.size())
        fail_(
            fmt::format("block {} refers to face {}, but the file has only {} faces", id, number, starts_.size() - 1));
      const auto face = static_cast<std::size_t>(number) - 1;
      // At most two cells share a face. More uses could make the data many times as large as the file.
      if (++times_used_[face] > 2) fail_(fmt::format("face {} belongs to more than two elements", number));
      block.faces.push_back(static_cast<std::uint32_t>(starts_[face + 1] - starts_[face]));
      for (std::size_t v = starts_[face]; v < starts_[face + 1]; ++v) {
        if (corners_[v] < 1 || corners_[v] > points)
          fail_(fmt::format("face {} uses node {}, but the file has only {} nodes", number, corners_[v], points));
        block.faces.push_back(static_cast<std::uint32_t>(corners_[v] - 1));
      }
    }
  }
}

}  // namespace tessera::readers
