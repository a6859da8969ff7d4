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

/// Data sets, frames and checks as JSON: the contents of `tessera render --report` and `tessera info --json`.
namespace tessera::analysis {

/// The description of a data set. It remains valid after the data set has been destroyed.
struct Description {
  explicit Description(const Dataset& data);

  bool is_mesh;
  std::string format, field_name;
  Association association;
  Box box;
  std::array<double, 2> range;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes, warnings, blocks;
  MeshCounts counts;  ///< for meshes
  HigherOrderCells higher_order;
  double higher_order_pixels = 0;  ///< HigherOrderRead::pixel_error, for reports about rendered images
  GridGeometry geometry;           ///< for grids, like the following members
  SampleType type{};
  double scale = 1, shift = 0;
  std::uint64_t blanks = 0;
};

/// The beginning of a report: program, version, commit and build (tessera/version.hpp).
nlohmann::ordered_json program_json();

/// File, format, kind and size of the data, bounds, chosen field, all fields, notes, warnings.
nlohmann::ordered_json data_json(const std::filesystem::path& input, const Description& data);

/// The function's name, its unit distance and the origin of that distance, and its knots.
nlohmann::ordered_json transfer_function_json(const LoadedTransferFunction& loaded);

/// A view in the form of camera files, so that it can be copied into one.
nlohmann::ordered_json view_json(const Camera& camera, ImageSize size);

/// The counters of a frame.
nlohmann::ordered_json counters_json(const FrameStatistics& statistics, bool is_grid);

/// How ranks shared a grid's image: for each rank the rectangle, samples and CPU time, and the imbalance of the ranks.
nlohmann::ordered_json balance_json(Balance balance, const FrameStatistics& statistics);

nlohmann::ordered_json verification_json(const Verification& verification);
nlohmann::ordered_json check_json(const MeshCheck& check);

/// The imbalance of work: (largest - least) / mean; 0 if there is no work.
double deviation(const std::vector<double>& work);

/// Words for reports: `point` or `cell`; `accurate`, `backface`, ...
const char* word(Association association);
const char* word(Balance balance);

}  // namespace tessera::analysis
