// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "scene/label_source.hpp"

namespace tessera::frame {

/// Computes scene::label_values() on rank 0 and sends the result to every rank. Collective. Throws the errors of
/// reading samples.
scene::LabelValues shared_labels(exchange::Transport& transport, const scene::SampleSource& source, bool stated);

}  // namespace tessera::frame
