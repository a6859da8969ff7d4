// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "scene/label_source.hpp"

namespace tessera::frame {

/// scene::label_values() computed on rank 0 and sent to every rank. Collective. Throws what reading samples throws.
scene::LabelValues shared_labels(exchange::Transport& transport, const scene::SampleSource& source, bool stated);

}  // namespace tessera::frame
