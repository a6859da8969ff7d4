// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/shared_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exchange/collectives.hpp"
#include "exchange/shared_pages.hpp"
#include "frame/ranks/field_message.hpp"
#include "io/volume/brick_file.hpp"
#include "scene/error.hpp"

namespace tessera::frame {
namespace {

using exchange::append;
using exchange::append_text;
using exchange::Bytes;
using exchange::MessageKind;
using exchange::MessageReader;

/// Returns, for each rank, the lowest rank of its machine. A rank on an unknown machine is its own leader.
std::vector<std::size_t> leaders(exchange::Transport& transport) {
  Bytes own = exchange::begin_message(MessageKind::host);
  append_text(own, exchange::machine());
  std::vector<std::string> machines;
  for (const Bytes& message : exchange::gather_all(transport, std::move(own)))
    machines.push_back(MessageReader(message, static_cast<int>(machines.size()), MessageKind::host).take_text());
  std::vector<std::size_t> leaders;
  leaders.reserve(machines.size());
  for (const std::string& name : machines)
    leaders.push_back(name.empty() ? leaders.size()
                                   : static_cast<std::size_t>(std::ranges::find(machines, name) - machines.begin()));
  return leaders;
}

/// Where a leader has written the samples. An empty path states that they are in the file itself.
struct Place {
  std::string path, folder;
  std::uint64_t bytes = 0;
};

/// Returns the message: text path, text directory, u64 bytes (Place); fields, texts: notes; text format, u8 body axes,
/// u8 body axes if it is CT; text modality, text unit, text unit of length, u8 whether values are labels, a time step,
/// u8 whether x and y are in degrees. Values are empty on a rank that has not read the file.
Bytes message_of(const io::VolumeFile& volume) {
  Place place;
  if (volume.scratch) place = {volume.scratch->path(), volume.scratch->folder(), volume.scratch->bytes()};
  Bytes message = exchange::begin_message(MessageKind::volume_facts);
  append_text(message, place.path);
  append_text(message, place.folder);
  append(message, place.bytes);
  append_fields(message, volume.fields);
  append_texts(message, volume.notes);
  append_text(message, volume.format);
  append(message, static_cast<std::uint8_t>(volume.body_axes));
  append(message, static_cast<std::uint8_t>(volume.axes_if_ct));
  append_text(message, volume.tags.modality);
  append_text(message, volume.tags.unit);
  append_text(message, volume.tags.length_unit);
  append(message, static_cast<std::uint8_t>(volume.tags.labels));
  append_time_step(message, volume.time_step);
  append(message, std::uint8_t{volume.xy_in_degrees});
  return message;
}

Place place_in(MessageReader& reader) {
  Place place;
  place.path = reader.take_text();
  place.folder = reader.take_text();
  place.bytes = reader.take<std::uint64_t>();
  return place;
}

/// Reads the whole description, but not the samples.
io::VolumeFile description_in(MessageReader& reader) {
  io::VolumeFile volume;
  volume.fields = take_fields(reader);
  volume.notes = take_texts(reader);
  volume.format = reader.take_text();
  volume.body_axes = static_cast<BodyAxes>(reader.take<std::uint8_t>());
  volume.axes_if_ct = static_cast<BodyAxes>(reader.take<std::uint8_t>());
  volume.tags.modality = reader.take_text();
  volume.tags.unit = reader.take_text();
  volume.tags.length_unit = reader.take_text();
  volume.tags.labels = reader.take<std::uint8_t>() != 0;
  volume.time_step = take_time_step(reader);
  volume.xy_in_degrees = reader.take<std::uint8_t>() != 0;
  reader.finish();
  return volume;
}

std::unique_ptr<scene::SampleSource> bricks_at(const Place& place, const io::InputFile& file) {
  try {
    return io::open_bricks(place.path, {}, file.name).source;
  } catch (const scene::Error&) {
    throw scene::bad_input(
        fmt::format("{}: a rank cannot open the samples that another rank unpacked for it in {}; convert the volume to "
                    ".bricks once and render that",
                    file.name, place.folder));
  }
}

std::string note_on(const io::InputFile& file, const Place& place, std::size_t ranks, std::size_t machines) {
  return fmt::format(
      "{} is read as a whole: its samples are kept {}, in an unnamed file of {} in {}{}, which is removed when the run "
      "ends",
      file.path.filename().string(),
      ranks > 1 ? fmt::format("once for {} ranks", ranks) : "on disk, because they may not fit into memory",
      system::size_in_words(place.bytes), place.folder,
      machines > 1 ? fmt::format(" on each of {} machines", machines) : "");
}

}  // namespace

io::VolumeFile open_shared_volume(exchange::Transport& transport, const io::InputFile& file,
                                  const ReadOptions& options) {
  const std::vector<std::size_t> leader_of = leaders(transport);
  const auto self = static_cast<std::size_t>(transport.rank());
  const auto ranks_of = [&](std::size_t leader) { return std::ranges::count(leader_of, leader); };
  const bool leads = leader_of[self] == self, shares = ranks_of(leader_of[self]) > 1;
  const auto open = [&] { return io::open_unscanned_volume(file, options, shares); };
  io::VolumeFile own;
  if (leads) own = open();
  if (leads && shares && own.in_memory) {  // some readers only return the whole volume
    own.scratch = io::scratch_bricks(*own.source, file.name);
    own.source.reset();
  }
  const std::vector<Bytes> all =
      exchange::gather_all(transport, leads ? message_of(own) : exchange::begin_message(MessageKind::volume_facts));

  std::optional<Place> first;
  std::size_t sharing = 0, machines = 0;
  io::VolumeFile volume;
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    if (leader_of[rank] != rank) continue;
    MessageReader reader(all[rank], static_cast<int>(rank), MessageKind::volume_facts);
    const Place place = place_in(reader);
    if (!place.path.empty()) {
      if (!first) first = place;
      ++machines, sharing += static_cast<std::size_t>(ranks_of(rank));
    }
    if (rank != leader_of[self]) continue;
    volume = description_in(reader);
    volume.in_memory = leads && own.in_memory && !own.scratch;
    volume.source = std::move(own.source);
    if (!volume.source) volume.source = place.path.empty() ? open().source : bricks_at(place, file);
  }
  if (first) volume.notes.push_back(note_on(file, *first, sharing, machines));
  // The leader keeps its file open until all others have opened it through the leader's descriptor.
  exchange::barrier(transport);
  return volume;
}

}  // namespace tessera::frame
