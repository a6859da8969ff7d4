// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tessera/dataset.hpp"
#include "tessera/mesh_check.hpp"
#include "tessera/statistics.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/verification.hpp"

/// Data sets, frames and checks as JSON: what `tessera render --report` and `tessera info --json` hold.
namespace tessera::analysis {

/// What is to be said of a data set, kept when it is gone.
struct Description {
  explicit Description(const Dataset& data);

  bool is_mesh;
  std::string format, field_name;
  Association association;
  Box box;
  std::array<double, 2> range;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes, warnings, blocks;
  MeshCounts counts;  ///< meshes
  HigherOrderCells higher_order;
  double higher_order_pixels = 0;  ///< HigherOrderRead::pixel_error, where a picture is made
  GridGeometry geometry;           ///< grids, and so on
  SampleType type{};
  double scale = 1, shift = 0;
  std::uint64_t blanks = 0;
};

/// Program, version, commit and build (tessera/version.hpp): how a report begins.
nlohmann::ordered_json program_json();

/// File, format, what it is made of, bounds, chosen field, all fields, notes, warnings.
nlohmann::ordered_json data_json(const std::filesystem::path& input, const Description& data);

/// Name, unit distance and its source, knots.
nlohmann::ordered_json transfer_function_json(const LoadedTransferFunction& loaded);

/// A view in the words of camera files, so that it can be cut out and used as one.
nlohmann::ordered_json view_json(const Camera& camera, ImageSize size);

/// What a frame took, counted.
nlohmann::ordered_json counters_json(const FrameStatistics& statistics, bool is_grid);

/// How ranks shared a grid's picture: of each its rectangle, samples and CPU time, and how uneven these are.
nlohmann::ordered_json balance_json(Balance balance, const FrameStatistics& statistics);

nlohmann::ordered_json verification_json(const Verification& verification);
nlohmann::ordered_json check_json(const MeshCheck& check);

/// (largest - least) / mean: how unevenly work is shared; 0 if there is none.
double deviation(const std::vector<double>& work);

/// `point` or `cell`; `accurate`, `backface`, ...
const char* word(Association association);
const char* word(Balance balance);

}  // namespace tessera::analysis
