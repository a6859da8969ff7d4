// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame/grid/sort_first.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/distributed.hpp"
#include "tessera/settings.hpp"
#include "volume/render.hpp"

/// A session's settings as the renderers have them.
namespace tessera::api {

frame::RenderSettings mesh_settings(const Settings& settings);

/// Throws Error(bad_input) for methods that grids do not have.
volume::RenderSettings grid_settings(const Settings& settings);

frame::SortFirstSettings sort_first_settings(const Settings& settings);

/// Of a mesh: on several ranks, or on devices.
frame::CompositingSettings compositing_settings(const DeviceSettings& settings);

/// `ranks`: of the job.
frame::DistributedSettings distributed_settings(const Settings& settings, int ranks);

}  // namespace tessera::api
