// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/settings.hpp"

namespace tessera::frame {

using tessera::assign_roles;
using tessera::Roles;

}  // namespace tessera::frame
