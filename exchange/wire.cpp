// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/wire.hpp"

namespace tessera::exchange {

FrameEnd sum(const FrameEnd& a, const FrameEnd& b) {
  FrameEnd both{a.counters, a.on_lattice + b.on_lattice, a.failed_devices + b.failed_devices, a.stopped + b.stopped,
                a.overlapping + b.overlapping};
  both.counters += b.counters;
  return both;
}

}  // namespace tessera::exchange
