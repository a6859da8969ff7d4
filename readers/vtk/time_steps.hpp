// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/foreign/messages/foreign_data.hpp"

class vtkAlgorithm;

namespace tessera::readers {

/// Has a reader that knows its file's time steps read one: the request's `time_step`, counted from 0, or the last; of
/// readers that know pieces the request's piece `part` of `parts`, if it has these. `read` says which step. Within
/// with_quiet_vtk(). Throws Error(bad_input) for a step that there is not.
void update_at_step(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source,
                    scene::TimeStepRead& read);

/// The time of the step that the request asks for, after UpdateInformation(); 0 of a file without time. Throws as
/// update_at_step().
double asked_time(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source);

}  // namespace tessera::readers
