#pragma once

#include "scene/error.hpp"
#include "tessera/output_file.hpp"

namespace tessera::io {

using tessera::AtomicFile;
using tessera::check_writable;
using tessera::OutputFault;

}  // namespace tessera::io
