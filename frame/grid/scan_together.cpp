// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/scan_together.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "exchange/collectives.hpp"
#include "scene/error.hpp"

namespace tessera::frame {
namespace {

using exchange::append;
using exchange::append_values;
using exchange::Bytes;
using exchange::Channel;
using exchange::MessageKind;

/// A scan's contribution to the range of the whole volume.
struct ScanTotals {
  double lowest, highest;
  std::uint64_t blanks;
};
static_assert(sizeof(ScanTotals) == 24);

constexpr std::uint64_t cells_a_message = 1 << 24;  // 128 MiB; a message may have 1 GiB

/// Makes a message with `count` cells of a rank's share.
Bytes cells_of(const volume::CellScan& scan, std::uint64_t first_of_scan, std::uint64_t first, std::uint64_t count) {
  Bytes bytes =
      exchange::begin_message(MessageKind::cell_ranges, 2 * sizeof(std::uint64_t) + 2 * count * sizeof(float));
  append(bytes, first_of_scan + first);  // cells are numbered as in CellRanges
  append(bytes, count);
  append_values(bytes, std::span(scan.low).subspan(first, count));
  append_values(bytes, std::span(scan.high).subspan(first, count));
  return bytes;
}

/// Stores the cells of a message and returns their number.
std::uint64_t place(const exchange::Message& message, volume::CellScan& whole) {
  exchange::MessageReader reader(message, MessageKind::cell_ranges);
  const auto first = reader.take<std::uint64_t>(), count = reader.take<std::uint64_t>();
  if (first > whole.low.size() || count > whole.low.size() - first) reader.refuse("brings cells of another volume");
  reader.take_values(std::span(whole.low).subspan(first, count));
  reader.take_values(std::span(whole.high).subspan(first, count));
  reader.finish();
  return count;
}

}  // namespace

volume::CellRanges scan_together(exchange::Transport& transport, const scene::SampleSource& source) {
  const int ranks = transport.size(), self = transport.rank();
  const scene::GridIndex cells = volume::cells_along(source.geometry());
  const auto first_layer = [&](int rank) { return cells[2] * rank / ranks; };
  volume::CellScan own = volume::scan_cells(source, first_layer(self), first_layer(self + 1));
  if (ranks == 1) return {source.grid(), std::move(own)};

  // Each rank sends its cells to each other rank. If they passed through rank 0, like small messages, its memory would
  // have to hold all ranks' copies of all cells.
  const std::uint64_t before = static_cast<std::uint64_t>(cells[0] * cells[1] * own.first), count = own.low.size();
  for (std::uint64_t at = 0; at < count; at += cells_a_message) {
    const Bytes bytes = cells_of(own, before, at, std::min(cells_a_message, count - at));
    for (int other = 1; other < ranks; ++other) transport.send((self + other) % ranks, Channel::mesh, bytes);
  }
  volume::CellScan whole;
  whole.last = cells[2];
  whole.low.resize(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  whole.high.resize(whole.low.size());
  std::copy(own.low.begin(), own.low.end(), whole.low.begin() + static_cast<std::ptrdiff_t>(before));
  std::copy(own.high.begin(), own.high.end(), whole.high.begin() + static_cast<std::ptrdiff_t>(before));
  for (std::uint64_t there = count; there < whole.low.size();) there += place(transport.receive(Channel::mesh), whole);

  // gather_values() also ends the exchange: no rank begins the next exchange while another rank still waits for cells
  // of this one.
  const ScanTotals totals{own.lowest, own.highest, own.blanks};
  for (const ScanTotals& part : exchange::gather_values(transport, MessageKind::cell_totals, totals)) {
    whole.lowest = std::min(whole.lowest, part.lowest);
    whole.highest = std::max(whole.highest, part.highest);
    whole.blanks += part.blanks;
  }
  return {source.grid(), std::move(whole)};
}

}  // namespace tessera::frame
