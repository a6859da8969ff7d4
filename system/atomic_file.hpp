// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/error.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::system {

using tessera::AtomicFile;
using tessera::check_writable;
using tessera::OutputFault;

}  // namespace tessera::system
