// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "readers/vtk/ensight_case.hpp"
#include "system/descriptor.hpp"

namespace tessera::readers {

/// One time step of a case with file sets, as a case without time. VTK's reader assumes that every file of a case with
/// file sets has several steps, and does not terminate if one has a single step, such as geometry that does not change.
class EnsightStep {
 public:
  EnsightStep(const EnsightCase& described, double time);

  /// Valid during the lifetime of this object.
  [[nodiscard]] std::filesystem::path case_file() const { return case_file_; }
  [[nodiscard]] const std::vector<EnsightCase::Values>& values() const { return values_; }

 private:
  /// The path for VTK's reader: of the file itself, or of its step in memory.
  std::filesystem::path file_of(const EnsightCase::Located& located);
  std::filesystem::path in_memory(std::string_view before, std::string_view lines);
  std::filesystem::path keep(system::Descriptor opened);

  std::vector<system::Descriptor> opened_;
  std::filesystem::path case_file_;
  std::vector<EnsightCase::Values> values_;
};

}  // namespace tessera::readers
