// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tessera::apps {

/// The entries of a run's report for its frames, kept until the end as one text. Trees of JSON consist of many small
/// blocks: they would need three to four times the memory and fragment a long film's heap.
class FrameReports {
 public:
  /// If not `kept`, no report is requested, and nothing is stored.
  explicit FrameReports(bool kept) : kept_(kept) {}

  /// Whether add() stores anything; otherwise the caller need not make it.
  [[nodiscard]] bool kept() const { return kept_; }
  void add(const nlohmann::ordered_json& frame);

  /// `report` with the frames as its last member, `frames`. Text that is not UTF-8 is replaced.
  [[nodiscard]] std::string text(const nlohmann::ordered_json& report) const;

 private:
  bool kept_;
  std::string frames_;  ///< JSON, one per line
};

}  // namespace tessera::apps
