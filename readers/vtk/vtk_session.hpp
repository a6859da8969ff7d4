// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

class vtkAlgorithm;
class vtkDataSetReader;

namespace tessera::readers {

/// Runs one read or write by VTK with VTK's messages caught instead of printed, and returns what it warned of.
///
/// VTK's output window and log level are process-wide, so sessions run one at a time and put back what they found.
/// An error that VTK reports (it does not throw) becomes error_of_vtk(), as does running out of memory, which with
/// small files means wrong counts. Messages with one of the words `passed_over` in them are no errors, nor warnings.
std::string with_quiet_vtk(const std::string& source, const std::string& remedy, const std::function<void()>& work,
                           std::initializer_list<const char*> passed_over = {});

/// Has a reader's progress reported (readers/common/serve.hpp).
void watch_progress(vtkAlgorithm& reader);

/// Reads a legacy file, of meshes or grids, with all of its arrays instead of the active ones alone. Within
/// with_quiet_vtk().
void read_all_arrays(vtkDataSetReader& reader, const std::string& source);

}  // namespace tessera::readers
