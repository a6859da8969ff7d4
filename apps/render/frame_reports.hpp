// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tessera::apps {

/// The entries for frames in a run's report, kept until the end of the run as one text. Trees of JSON consist of many
/// small blocks of memory. They would need three to four times the memory and fragment the heap in a long film.
class FrameReports {
 public:
  /// `kept` is false if no report is requested; then nothing is stored.
  explicit FrameReports(bool kept) : kept_(kept) {}

  /// Whether add() stores anything. If not, the caller need not make entries.
  [[nodiscard]] bool kept() const { return kept_; }
  void add(const nlohmann::ordered_json& frame);

  /// Returns `report` as text, with the entries as its last member, `frames`. Text that is not UTF-8 is replaced.
  [[nodiscard]] std::string text(const nlohmann::ordered_json& report) const;

 private:
  bool kept_;
  std::string frames_;  ///< the entries as JSON, one per line
};

}  // namespace tessera::apps
