// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/foreign/messages/foreign_data.hpp"

class vtkAlgorithm;

namespace tessera::readers {

/// Makes a VTK reader read one time step: the request's `time_step`, counted from 0, or the last. If the reader
/// supports pieces and the request contains `part` and `parts`, that piece is read. `read` receives the step. Must be
/// called within with_quiet_vtk(). Throws Error(bad_input) for a step that does not exist.
void update_at_step(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source,
                    scene::TimeStepRead& read);

/// Returns the time of the requested step; 0 for a file without time. Must be called after UpdateInformation(). Throws
/// like update_at_step().
double asked_time(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source);

}  // namespace tessera::readers
