// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/foreign/messages/foreign_data.hpp"

class vtkAlgorithm;

namespace tessera::readers {

/// Makes a reader that supports time steps read one: the request's `time_step`, counted from 0, or the last; if the
/// reader supports pieces, the request's piece `part` of `parts`, if present. `read` receives the step. Within
/// with_quiet_vtk(). Throws Error(bad_input) for a step that does not exist.
void update_at_step(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source,
                    scene::TimeStepRead& read);

/// The time of the requested step, after UpdateInformation(); 0 for a file without time. Throws like update_at_step().
double asked_time(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source);

}  // namespace tessera::readers
