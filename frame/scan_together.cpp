#include "frame/scan_together.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "frame/message_values.hpp"
#include "scene/error.hpp"

namespace tessera::frame {
namespace {

using exchange::Bytes;
using exchange::Channel;

/// Some cells of a rank's share, as they travel: this, then `count` lowest samples, then as many highest. Little
/// endian.
struct CellsHeader {
  std::uint64_t first, count;  ///< by CellRanges' numbers
};
static_assert(sizeof(CellsHeader) == 16);

/// What a scan adds to the whole volume's range.
struct ScanTotals {
  double lowest, highest;
  std::uint64_t blanks;
};
static_assert(sizeof(ScanTotals) == 24);

constexpr std::uint64_t cells_a_message = 1 << 24;  // 128 MiB, of the 1 GiB that a message may have

Bytes cells_of(const volume::CellScan& scan, std::uint64_t first_of_scan, std::uint64_t first, std::uint64_t count) {
  Bytes bytes;
  const CellsHeader header{first_of_scan + first, count};
  bytes.reserve(sizeof header + 2 * count * sizeof(float));
  append_values(bytes, std::span(&header, 1));
  append_values(bytes, std::span(scan.low).subspan(first, count));
  append_values(bytes, std::span(scan.high).subspan(first, count));
  return bytes;
}

/// Returns how many cells these are.
std::uint64_t place(const Bytes& bytes, volume::CellScan& whole) {
  const auto header = ValueReader(bytes).take<CellsHeader>();
  const std::uint64_t size = header.count * sizeof(float);
  if (header.count > cells_a_message || header.first > whole.low.size() ||
      header.count > whole.low.size() - header.first || bytes.size() != sizeof header + 2 * size)
    throw scene::Error(scene::ErrorCode::system_failure,
                       "exchange: cells of another volume came; all ranks must read the same file");
  if (header.count == 0) return 0;
  std::memcpy(&whole.low[header.first], bytes.data() + sizeof header, size);
  std::memcpy(&whole.high[header.first], bytes.data() + sizeof header + size, size);
  return header.count;
}

}  // namespace

volume::CellRanges scan_together(exchange::Transport& transport, const scene::SampleSource& source, int threads) {
  const int ranks = transport.size(), self = transport.rank();
  const scene::GridIndex cells = volume::cells_along(source.geometry());
  const auto first_layer = [&](int rank) { return cells[2] * rank / ranks; };
  volume::CellScan own = volume::scan_cells(source, first_layer(self), first_layer(self + 1), threads);
  if (ranks == 1) return {source.grid(), std::move(own)};

  // From each to each: through rank 0, as small facts go, all ranks' copies of all cells would wait in its memory.
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
  for (std::uint64_t there = count; there < whole.low.size();)
    there += place(transport.receive(Channel::mesh).bytes, whole);

  // Also the end of the exchange: no rank is in the next one while another still waits for cells of this one.
  const ScanTotals totals{own.lowest, own.highest, own.blanks};
  Bytes bytes;
  append_values(bytes, std::span(&totals, 1));
  for (const Bytes& of_rank : exchange::gather_all(transport, std::move(bytes))) {
    const auto part = ValueReader(of_rank).take<ScanTotals>();
    whole.lowest = std::min(whole.lowest, part.lowest);
    whole.highest = std::max(whole.highest, part.highest);
    whole.blanks += part.blanks;
  }
  return {source.grid(), std::move(whole)};
}

}  // namespace tessera::frame
