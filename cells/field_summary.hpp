// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/field_info.hpp"
#include "tessera/mesh_counts.hpp"

namespace tessera::cells {

using tessera::HigherOrderCells;
using tessera::MeshCounts;

using FieldSummary = tessera::FieldInfo;

}  // namespace tessera::cells
