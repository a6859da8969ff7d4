// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "readers/vtk/ensight_case.hpp"
#include "system/descriptor.hpp"

namespace tessera::readers {

/// One time step of a case with file sets, converted to a case without time. Needed because VTK's reader assumes that
/// every file of a case with file sets has several steps, and does not terminate if a file has a single step, for
/// example for geometry that does not change.
class EnsightStep {
 public:
  EnsightStep(const EnsightCase& described, double time);

  /// The case file and the values to read. Valid during the lifetime of this object.
  [[nodiscard]] std::filesystem::path case_file() const { return case_file_; }
  [[nodiscard]] const std::vector<EnsightCase::Values>& values() const { return values_; }

 private:
  /// Returns the path for VTK's reader: that of the file, or of a copy in memory of one step of the file.
  std::filesystem::path file_of(const EnsightCase::Located& located);
  std::filesystem::path in_memory(std::string_view before, std::string_view lines);
  std::filesystem::path keep(system::Descriptor opened);

  std::vector<system::Descriptor> opened_;
  std::filesystem::path case_file_;
  std::vector<EnsightCase::Values> values_;
};

}  // namespace tessera::readers
