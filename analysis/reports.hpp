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

/// The description of a data set, which remains valid after the data set is gone.
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
  double higher_order_pixels = 0;  ///< HigherOrderRead::pixel_error, if an image is rendered
  GridGeometry geometry;           ///< grids; the following members too
  SampleType type{};
  double scale = 1, shift = 0;
  std::uint64_t blanks = 0;
};

/// Program, version, commit and build (tessera/version.hpp): the beginning of a report.
nlohmann::ordered_json program_json();

/// File, format, kind and size of the data, bounds, chosen field, all fields, notes, warnings.
nlohmann::ordered_json data_json(const std::filesystem::path& input, const Description& data);

/// Name, unit distance and its source, knots.
nlohmann::ordered_json transfer_function_json(const LoadedTransferFunction& loaded);

/// A view in the form of camera files, so that it can be copied into one.
nlohmann::ordered_json view_json(const Camera& camera, ImageSize size);

/// The counters of a frame.
nlohmann::ordered_json counters_json(const FrameStatistics& statistics, bool is_grid);

/// How ranks shared a grid's image: the rectangle, samples and CPU time of each, and their imbalance.
nlohmann::ordered_json balance_json(Balance balance, const FrameStatistics& statistics);

nlohmann::ordered_json verification_json(const Verification& verification);
nlohmann::ordered_json check_json(const MeshCheck& check);

/// (largest - least) / mean: the imbalance of work; 0 without work.
double deviation(const std::vector<double>& work);

/// `point` or `cell`; `accurate`, `backface`, ...
const char* word(Association association);
const char* word(Balance balance);

}  // namespace tessera::analysis
