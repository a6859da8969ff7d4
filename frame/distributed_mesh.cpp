#include "frame/distributed_mesh.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <numeric>

#include "frame/mesh_input.hpp"
#include "frame/reduce.hpp"
#include "io/mesh_parts.hpp"

namespace tessera::frame {
namespace {

using exchange::Bytes;
using exchange::Transport;
using nlohmann::json;

// What ranks agree on travels as CBOR, which keeps doubles to the bit and takes any bytes as text.

Bytes bytes_of(const json& value) {
  std::vector<std::uint8_t> cbor = json::to_cbor(value);
  const auto* first = reinterpret_cast<const std::byte*>(cbor.data());
  return Bytes(first, first + cbor.size());
}

json json_of(const Bytes& bytes) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return json::from_cbor(first, first + bytes.size());
}

json to_json(const io::FieldSummary& f) {
  return {f.name,  f.association == scene::Association::point, f.components, f.type, f.low, f.high, f.nan_count,
          f.active};
}

io::FieldSummary field_of(const json& j) {
  return {j[0], j[1].get<bool>() ? scene::Association::point : scene::Association::cell, j[2], j[3], j[4], j[5], j[6],
          j[7]};
}

using CountArray = std::array<std::uint64_t, sizeof(io::MeshCounts) / sizeof(std::uint64_t)>;

json to_json(const io::MeshCounts& counts) { return std::bit_cast<CountArray>(counts); }
io::MeshCounts counts_of(const json& j) { return std::bit_cast<io::MeshCounts>(j.get<CountArray>()); }

json to_json(const std::vector<io::FieldTally>& tallies) {
  json list = json::array();
  for (const io::FieldTally& t : tallies) list.push_back({to_json(t.summary), t.any_finite});
  return list;
}

std::vector<io::FieldTally> tallies_of(const json& list) {
  std::vector<io::FieldTally> tallies;
  for (const json& j : list) tallies.push_back({field_of(j[0]), j[1]});
  return tallies;
}

json to_json(const io::MeshFile& file) {
  json fields = json::array();
  for (const io::FieldSummary& f : file.fields) fields.push_back(to_json(f));
  return {{"counts", to_json(file.counts)},
          {"fields", fields},
          {"notes", file.notes},
          {"format", file.format},
          {"field_name", file.mesh.field_name},
          {"point", file.mesh.association == scene::Association::point}};
}

io::MeshFile description_of(const json& j) {
  io::MeshFile file;
  file.counts = counts_of(j["counts"]);
  for (const json& f : j["fields"]) file.fields.push_back(field_of(f));
  file.notes = j["notes"].get<std::vector<std::string>>();
  file.format = j["format"];
  file.mesh.field_name = j["field_name"];
  file.mesh.association = j["point"].get<bool>() ? scene::Association::point : scene::Association::cell;
  return file;
}

/// All ranks' values, in the order of `projectors`; the others have nothing to say.
std::vector<json> gather(Transport& transport, const json& own, std::span<const int> projectors) {
  const std::vector<Bytes> all = exchange::gather_all(transport, bytes_of(own));
  std::vector<json> values;
  for (const int rank : projectors) values.push_back(json_of(all[static_cast<std::size_t>(rank)]));
  return values;
}

/// The description is the first projector's.
io::MeshFile share_description(Transport& transport, std::span<const int> projectors, const io::MeshFile& own) {
  const bool speaks = transport.rank() == projectors.front();
  const Bytes bytes = speaks ? bytes_of(to_json(own)) : Bytes{};
  return description_of(json_of(exchange::broadcast(transport, projectors.front(), bytes)));
}

/// The whole by the first projector.
DistributedMesh read_whole(Transport& transport, std::span<const std::filesystem::path> files,
                           const io::MeshOptions& options, std::span<const int> projectors) {
  DistributedMesh result;
  io::MeshFile file;
  if (transport.rank() == projectors.front()) file = read_input(files, options);
  result.description = share_description(transport, projectors, file);
  result.part.mesh = std::move(file.mesh);
  return result;
}

/// A part by each projector.
DistributedMesh read_parts(Transport& transport, const std::filesystem::path& input, const io::MeshOptions& options,
                           std::span<const int> projectors) {
  const auto place = std::find(projectors.begin(), projectors.end(), transport.rank());
  const bool reads = place != projectors.end();
  const auto part = static_cast<std::size_t>(place - projectors.begin());
  std::optional<io::MeshPartReading> reading;
  if (reads) reading.emplace(input, options, static_cast<int>(part), static_cast<int>(projectors.size()));

  std::vector<std::vector<io::FieldTally>> tallies;
  for (const json& j : gather(transport, reads ? to_json(reading->tallies()) : json::array(), projectors))
    tallies.push_back(tallies_of(j));
  io::MeshFilePart own;
  if (reads) own = reading->finish(tallies);
  reading.reset();

  const io::PartSummary& s = own.summary;
  std::vector<io::PartSummary> summaries;
  std::uint64_t words = 0, first_tet = 0;
  for (const json& j :
       gather(transport, {to_json(s.counts), s.reading_notes, s.cell_notes, s.used_points.size()}, projectors)) {
    summaries.push_back(
        {counts_of(j[0]), {}, j[1].get<std::vector<std::string>>(), j[2].get<std::vector<std::string>>()});
    if (summaries.size() <= part) first_tet += summaries.back().counts.tets_made;
    words = std::max(words, j[3].get<std::uint64_t>());
  }
  own.summary.used_points.resize(words, 0);
  summaries.front().used_points = reduce_all(transport, std::move(own.summary.used_points), Reduction::bit_or);

  DistributedMesh result;
  io::MeshFile description;
  if (transport.rank() == projectors.front()) description = io::joined(own, summaries, input);
  result.description = share_description(transport, projectors, description);
  result.part.mesh = std::move(own.mesh);
  result.part.mesh.original_cell = {};  // it counts this part's cells
  result.part.global_tet.resize(result.part.mesh.tets.size());
  std::iota(result.part.global_tet.begin(), result.part.global_tet.end(), first_tet);
  return result;
}

}  // namespace

DistributedMesh read_distributed(Transport& transport, std::span<const std::filesystem::path> files,
                                 const io::MeshOptions& options, const projection::Partition& partition,
                                 std::span<const int> projectors, int threads, scene::Trace* trace) {
  DistributedMesh result;
  if (transport.size() == 1) {
    {
      const scene::TraceScope scope(trace, "read");
      result.description = read_input(files, options);
    }
    result.part.mesh = std::move(result.description.mesh);
    result.description.mesh = {};
    result.description.mesh.field_name = result.part.mesh.field_name;
    result.description.mesh.association = result.part.mesh.association;
    result.facts = scene::facts_of(result.part.mesh, threads);
    return result;
  }
  try {
    {
      const scene::TraceScope scope(trace, "read");
      // One rank looks, so that all do the same.
      Bytes in_parts(1);
      if (transport.rank() == projectors.front())
        in_parts[0] = std::byte{files.size() == 1 && io::readable_in_parts(files.front(), options)};
      in_parts = exchange::broadcast(transport, projectors.front(), std::move(in_parts));
      result = in_parts[0] != std::byte{0} ? read_parts(transport, files.front(), options, projectors)
                                           : read_whole(transport, files, options, projectors);
    }
    result.facts = agree_facts(transport, result.part.mesh, threads);
    result.part = redistribute(transport, std::move(result.part), result.facts, partition, projectors, trace);
  } catch (const scene::Error& error) {
    transport.fail(error);
    transport.check();  // throws the run's error, which may be another rank's
    throw;
  } catch (const std::bad_alloc&) {
    transport.fail(scene::Error(scene::ErrorCode::system_failure,
                                files.front().string() + ": memory ran out; use more processes or larger machines"));
    transport.check();
    throw;
  }
  // A rank without tets knows these from the others.
  result.part.mesh.field_name = result.description.mesh.field_name;
  result.part.mesh.association = result.description.mesh.association;
  return result;
}

}  // namespace tessera::frame
