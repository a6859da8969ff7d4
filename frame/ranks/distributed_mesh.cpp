// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/distributed_mesh.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "cells/block_choice.hpp"
#include "cells/mesh_selection.hpp"
#include "exchange/collectives.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/field_message.hpp"
#include "frame/ranks/reduce.hpp"
#include "frame/ranks/shared_repetitions.hpp"
#include "io/mesh/mesh_parts.hpp"
#include "projection/prepared_mesh.hpp"

namespace tessera::frame {
namespace {

using exchange::append;
using exchange::append_text;
using exchange::Bytes;
using exchange::MessageKind;
using exchange::MessageReader;
using exchange::Transport;

// The facts of a mesh that ranks agree on. exchange/message.hpp lists the messages.

Bytes message_of(const std::vector<cells::FieldTally>& tallies, const scene::Box& box,
                 const std::vector<std::string>& block_names) {
  Bytes message = exchange::begin_message(MessageKind::field_tallies);
  append(message, std::uint64_t{tallies.size()});
  for (const cells::FieldTally& t : tallies) {
    append_field(message, t.summary);
    append(message, t.numbers);
    append(message, std::uint8_t{t.blocks_count_up});
  }
  append(message, box);
  append_texts(message, block_names);
  return message;
}

/// Adds the part's box and names to `box` and `block_names`.
std::vector<cells::FieldTally> tallies_in(MessageReader& reader, scene::Box& box,
                                          std::vector<std::string>& block_names) {
  std::vector<cells::FieldTally> tallies;
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    cells::FieldTally tally{take_field(reader)};
    tally.numbers = reader.take<cells::NumberTally>();
    tally.blocks_count_up = reader.take<std::uint8_t>() != 0;
    tallies.push_back(std::move(tally));
  }
  box = cells::joined(box, reader.take<scene::Box>());
  for (std::string& name : take_texts(reader)) block_names.push_back(std::move(name));
  reader.finish();
  return tallies;
}

Bytes message_of(const cells::MeshFile& file) {
  Bytes message = exchange::begin_message(MessageKind::mesh_description);
  append(message, file.counts);
  append(message, file.higher_order);
  append_fields(message, file.fields);
  append_texts(message, file.notes);
  append_texts(message, file.blocks);
  append_texts(message, file.surfaces);
  append_text(message, file.format);
  append_time_step(message, file.time_step);
  append(message, file.axis_scale);
  append_text(message, file.mesh.field_name);
  append(message, static_cast<std::uint8_t>(file.mesh.association));
  return message;
}

cells::MeshFile description_in(MessageReader& reader) {
  cells::MeshFile file;
  file.counts = reader.take<MeshCounts>();
  file.higher_order = reader.take<HigherOrderCells>();
  file.fields = take_fields(reader);
  file.notes = take_texts(reader);
  file.blocks = take_texts(reader);
  file.surfaces = take_texts(reader);
  file.format = reader.take_text();
  file.time_step = take_time_step(reader);
  file.axis_scale = reader.take<glm::dvec3>();
  file.mesh.field_name = reader.take_text();
  file.mesh.association = take_association(reader);
  reader.finish();
  return file;
}

/// Reads all projectors' messages in the order of the projectors. The other ranks send empty messages.
template <class Read>
void gather(Transport& transport, MessageKind kind, Bytes own, std::span<const int> projectors, const Read& read) {
  const std::vector<Bytes> all = exchange::gather_all(transport, std::move(own));
  for (const int rank : projectors) {
    MessageReader reader(all[static_cast<std::size_t>(rank)], rank, kind);
    read(reader);
  }
}

/// Sends the first projector's description to all ranks.
cells::MeshFile share_description(Transport& transport, std::span<const int> projectors, const cells::MeshFile& own) {
  const int speaker = projectors.front();
  const Bytes message = exchange::broadcast(transport, speaker, message_of(own));
  MessageReader reader(message, speaker, MessageKind::mesh_description);
  return description_in(reader);
}

/// Reduces every rank's part to the selection. Returns the facts and samples of the whole mesh before the selection;
/// null if everything is selected. Collective.
std::shared_ptr<const FieldOfAll> select_part(Transport& transport, const Selection& selection,
                                              const std::string& source, scene::TetMesh& part, MeshCounts& counts) {
  if (selection.all()) return nullptr;
  auto all = std::make_shared<FieldOfAll>();
  all->facts = agree_facts(transport, part);
  // Samples depend on the order of each tet's corners. Corners are therefore brought into the order that renderers use,
  // so that the samples are those that one process would take from the whole mesh.
  std::vector<scene::Tet> as_read = part.tets;
  std::vector<double> values;
  if (const auto fill = find_fill_value(transport, part, all->facts); fill && fill->is_outside(selection.threshold)) {
    all->facts.scalar_range = {fill->others.low, fill->others.high};
    values = part.scalars;
    for (double& value : part.scalars)  // samples avoid fill values
      if (std::ranges::binary_search(fill->values, value)) value = std::numeric_limits<double>::quiet_NaN();
  }
  projection::order_corners(part);
  all->samples = gather_field_samples(transport, part, numbered_by_rank(transport, part.tets.size()), all->facts);
  part.tets = std::move(as_read);
  if (!values.empty()) part.scalars = std::move(values);
  cells::select(part, selection, counts, source);
  return all;
}

/// The first projector reads all files.
DistributedMesh read_whole(Transport& transport, std::span<const std::filesystem::path> files,
                           const io::InputFile& first, const ReadOptions& options, std::span<const int> projectors) {
  DistributedMesh result;
  cells::MeshFile file;
  const bool reads = transport.rank() == projectors.front();
  if (reads) file = io::read_mesh(identify_pieces(files, first), options);
  const std::string source = files.front().string();
  result.of_all = select_part(transport, options.selection, source, file.mesh, file.counts);
  if (reads) cells::require_selected(file.counts, source);
  result.description = share_description(transport, projectors, file);
  result.part.mesh = std::move(file.mesh);
  return result;
}

/// Each projector reads a part.
DistributedMesh read_parts(Transport& transport, const io::InputFile& input, const ReadOptions& options,
                           std::span<const int> projectors) {
  const auto place = std::find(projectors.begin(), projectors.end(), transport.rank());
  const bool reads = place != projectors.end();
  const auto part = static_cast<std::size_t>(place - projectors.begin());
  std::optional<io::MeshPartReading> reading;
  if (reads) reading.emplace(input, options, static_cast<int>(part), static_cast<int>(projectors.size()));

  std::vector<std::vector<cells::FieldTally>> tallies;
  std::vector<std::string> block_names;
  scene::Box box = cells::higher_order_box({});
  gather(transport, MessageKind::field_tallies,
         reads ? message_of(reading->tallies(), reading->box(), reading->block_names()) : message_of({}, box, {}),
         projectors, [&](MessageReader& reader) { tallies.push_back(tallies_in(reader, box, block_names)); });
  if (reads) reading->choose(tallies, box, cells::distinct_names(std::move(block_names)));
  cells::ExcessTally excess{};
  gather(transport, MessageKind::higher_order,
         exchange::message_of(MessageKind::higher_order, reads ? reading->excess() : excess), projectors,
         [&](MessageReader& reader) {
           const auto own = reader.take<cells::ExcessTally>();
           for (std::size_t bin = 0; bin < own.size(); ++bin) excess[bin] += own[bin];
           reader.finish();
         });
  io::MeshFilePart own;
  if (reads) own = reading->finish(excess);
  reading.reset();
  if (reads)  // the channel `mesh` is free: all ranks have reached the gather() above
    own.summary.counts.cells_duplicate =
        count_shared_repetitions(transport, std::exchange(own.cell_keys, {}), projectors);

  DistributedMesh result;
  result.of_all = select_part(transport, options.selection, input.name, own.mesh, own.summary.counts);
  const io::PartSummary& s = own.summary;
  std::vector<io::PartSummary> summaries;
  std::uint64_t words = 0, first_tet = 0;
  Bytes message = exchange::message_of(MessageKind::part_summary, s.counts);
  append(message, s.higher_order);
  append_time_step(message, s.time_step);
  append_texts(message, s.reading_notes);
  append_texts(message, s.cell_notes);
  append_texts(message, s.surfaces);
  append(message, std::uint64_t{s.used_points.size()});
  gather(transport, MessageKind::part_summary, std::move(message), projectors, [&](MessageReader& reader) {
    io::PartSummary& summary = summaries.emplace_back();
    summary.counts = reader.take<MeshCounts>();
    summary.higher_order = reader.take<HigherOrderCells>();
    summary.time_step = take_time_step(reader);
    summary.reading_notes = take_texts(reader);
    summary.cell_notes = take_texts(reader);
    summary.surfaces = take_texts(reader);
    words = std::max(words, reader.take<std::uint64_t>());
    reader.finish();
    if (summaries.size() <= part) first_tet += summary.counts.tets_made;
  });
  own.summary.used_points.resize(words, 0);
  summaries.front().used_points = reduce_all(transport, std::move(own.summary.used_points), Reduction::bit_or);

  cells::MeshFile description;
  if (transport.rank() == projectors.front()) description = io::joined(own, summaries, input.path);
  description.axis_scale = options.axis_scale.value_or(glm::dvec3(1));
  result.description = share_description(transport, projectors, description);
  result.part.mesh = std::move(own.mesh);
  result.part.mesh.original_cell = {};  // its numbers count only this part's cells
  result.part.global_tet.resize(result.part.mesh.tets.size());
  std::iota(result.part.global_tet.begin(), result.part.global_tet.end(), first_tet);
  return result;
}

}  // namespace

DistributedMesh read_distributed(Transport& transport, std::span<const std::filesystem::path> files,
                                 const io::InputFile& first, const ReadOptions& options,
                                 const projection::Partition& partition, std::span<const int> projectors) {
  DistributedMesh result;
  try {
    {
      const scene::TraceScope scope(options.trace, "read");
      // One rank decides, so that all do the same.
      std::uint8_t in_parts = 0;
      if (transport.rank() == projectors.front() && transport.size() > 1)
        in_parts = files.size() == 1 && io::readable_in_parts(first, options) ? 1 : 0;
      in_parts = exchange::broadcast_value(transport, projectors.front(), MessageKind::read_in_parts, in_parts);
      result = in_parts != 0 ? read_parts(transport, first, options, projectors)
                             : read_whole(transport, files, first, options, projectors);
    }
    result.facts = agree_facts(transport, result.part.mesh);
    if (transport.size() > 1) {
      scene::TraceScope scope(options.trace, "partition");
      const auto before = transport.sent(exchange::Channel::mesh);
      result.part = redistribute(transport, std::move(result.part), result.facts, partition, projectors);
      const auto after = transport.sent(exchange::Channel::mesh);
      scope.moved(after.bytes - before.bytes, static_cast<std::uint32_t>(after.messages - before.messages));
    }
  } catch (const std::bad_alloc&) {
    throw scene::Error(scene::ErrorCode::system_failure,
                       first.name + ": memory ran out; use more processes or larger machines");
  }
  // A rank without tets gets these two values from the other ranks.
  result.part.mesh.field_name = result.description.mesh.field_name;
  result.part.mesh.association = result.description.mesh.association;
  return result;
}

}  // namespace tessera::frame
