// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::io {

/// Cell type of a Tecplot zone.
enum class TecplotZoneType : std::uint8_t { ordered, lines_or_faces, tetrahedra, bricks, polyhedra };

/// The record of a zone in a Tecplot text file, without the zone's numbers, which begin at `numbers_at`. Zones and
/// variables are numbered from 0.
struct TecplotZone {
  std::string name;
  std::size_t record_at = 0, numbers_at = 0, end = 0;
  TecplotZoneType type = TecplotZoneType::ordered;
  std::size_t i = 1, j = 1, k = 1;                                 ///< dimensions of an ordered zone
  std::size_t nodes = 0, elements = 0, faces = 0, face_nodes = 0;  ///< ordered zones have nodes and elements, too
  std::optional<bool> by_point;                                    ///< whether values are packed by points; no value if
                                                                   ///< the record does not state it
  std::vector<bool> of_cells, is_passive;                          ///< per variable
  std::map<std::size_t, std::size_t> shared_from;                  ///< variable -> the zone whose values are shared
  std::optional<std::size_t> connectivity_from;                    ///< another zone whose elements this zone shares
  std::optional<std::int64_t> strand;
  std::optional<double> time;
};

struct TecplotHeader {
  std::vector<std::string> variables;
  std::vector<TecplotZone> zones;
};

/// Parses the variables and zones of a Tecplot text file; texts, geometries and auxiliary data are skipped. Throws
/// Error(bad_input) with file, line and remedy, also for unsupported records. Checks that the text is long enough for
/// the numbers of points and elements in the result.
///
/// Source  Tecplot, Inc., "Data Format Guide", chapter "ASCII Data".
TecplotHeader parse_tecplot_header(std::string_view text, const std::string& source);

/// Throws Error(bad_input) that names the line of a position in the text.
[[noreturn]] void refuse_tecplot(std::string_view text, std::size_t at, const std::string& source,
                                 const std::string& what);

}  // namespace tessera::io
