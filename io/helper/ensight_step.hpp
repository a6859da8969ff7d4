#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/helper/ensight_case.hpp"
#include "io/helper_messages.hpp"
#include "io/scratch_file.hpp"

namespace tessera::io::helper {

/// One time step of a case with file sets, as a case without time. VTK's reader takes every file of a case with file
/// sets for one of several steps, and does not end where one is not, such as geometry that does not change.
class EnsightStep {
 public:
  EnsightStep(const EnsightCase& described, double time, const std::string& source);

  /// For as long as this lives.
  [[nodiscard]] std::filesystem::path case_file() const { return case_file_->path(); }
  [[nodiscard]] const std::vector<EnsightCase::Values>& values() const { return values_; }

 private:
  /// The path that VTK's reader opens: of a scratch file without a name, which is gone when this process ends.
  std::filesystem::path file_of(const EnsightCase::Located& located, const std::string& source);

  std::vector<std::unique_ptr<ScratchFile>> steps_;
  std::vector<Descriptor> opened_;  ///< of one step
  std::unique_ptr<ScratchFile> case_file_;
  std::vector<EnsightCase::Values> values_;
};

}  // namespace tessera::io::helper
