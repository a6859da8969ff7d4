// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

class vtkAlgorithm;
class vtkDataSetReader;

namespace tessera::readers {

/// Runs one read or write by VTK, catches VTK's messages instead of printing them, and returns its warnings.
///
/// VTK's output window and log level are global to the process. So sessions run one at a time, and restore the previous
/// window and level. VTK does not throw; an error that it reports becomes error_of_vtk(). Running out of memory also
/// becomes an error; for a small file its cause is a wrong count in the file. Messages that contain one of the words in
/// `passed_over` are neither errors nor warnings.
std::string with_quiet_vtk(const std::string& source, const std::string& remedy, const std::function<void()>& work,
                           std::initializer_list<const char*> passed_over = {});

/// Reports a reader's progress (readers/common/serve.hpp).
void watch_progress(vtkAlgorithm& reader);

/// Reads a legacy file, of meshes or grids, with all arrays instead of only the active ones. Must be called within
/// with_quiet_vtk().
void read_all_arrays(vtkDataSetReader& reader, const std::string& source);

}  // namespace tessera::readers
