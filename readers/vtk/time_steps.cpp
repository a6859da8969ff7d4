// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/time_steps.hpp"

#include <vtkAlgorithm.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "readers/vtk/vtk_session.hpp"

namespace tessera::readers {

double asked_time(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source) {
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  auto* const key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  vtkInformation* const about = reader.GetOutputInformation(0);
  const int steps = about != nullptr && about->Has(key) ? std::max(about->Length(key), 0) : 0;
  const std::size_t step = scene::chosen_step(requested, static_cast<std::size_t>(steps), source).step;
  return steps == 0 ? 0 : about->Get(key, static_cast<int>(step));
}

void update_at_step(vtkAlgorithm& reader, const nlohmann::json& request, const std::string& source,
                    scene::TimeStepRead& read) {
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  watch_progress(reader);
  reader.UpdateInformation();
  auto* const key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  vtkInformation* const about = reader.GetOutputInformation(0);
  const auto steps =
      static_cast<std::size_t>(about != nullptr && about->Has(key) ? std::max(about->Length(key), 0) : 0);
  read = scene::chosen_step(requested, steps, source);
  std::vector<double> times;
  for (std::size_t k = 0; k < steps; ++k) times.push_back(about->Get(key, static_cast<int>(k)));
  scene::set_times(read, times);
  const int part = request.value("part", 0), parts = request.value("parts", 1);
  if (steps == 0) {
    if (parts > 1)
      reader.UpdatePiece(part, parts, 0);
    else
      reader.Update();
    return;
  }
  const double time = times[read.step];
  if (parts > 1)
    reader.UpdateTimeStep(time, part, parts);
  else
    reader.UpdateTimeStep(time);
}

}  // namespace tessera::readers
