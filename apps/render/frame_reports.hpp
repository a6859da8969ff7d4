// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tessera::apps {

/// What a run's report says of each frame, kept until the end as one piece of text. Trees of JSON are many small
/// pieces: three to four times the memory, and between them a long film's heap cannot give back what a frame took.
class FrameReports {
 public:
  /// Not `kept`: no report is asked for, and nothing is.
  explicit FrameReports(bool kept) : kept_(kept) {}

  /// Whether add() keeps what it is given; else the caller need not make it.
  [[nodiscard]] bool kept() const { return kept_; }
  void add(const nlohmann::ordered_json& frame);

  /// `report` with the frames as its last member, `frames`. Text that is not UTF-8 is replaced.
  [[nodiscard]] std::string text(const nlohmann::ordered_json& report) const;

 private:
  bool kept_;
  std::string frames_;  ///< JSON, one a line
};

}  // namespace tessera::apps
