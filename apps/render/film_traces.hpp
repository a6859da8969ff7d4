// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/trace.hpp"

namespace tessera::apps {

/// Traces of one rank's run (--timing). All pointers are null unless traces are requested.
class FilmTraces {
 public:
  /// If `overlapping`, frames are rendered while other frames are composited and written, in separate roles.
  FilmTraces(bool timed, bool overlapping)
      : trace_(overlapping ? TraceRole::projector : TraceRole::both),
        compositing_(trace_, TraceRole::compositor),
        rendering_(timed ? &trace_ : nullptr),
        writing_(timed && overlapping ? &compositing_ : rendering_) {}
  FilmTraces(const FilmTraces&) = delete;
  FilmTraces& operator=(const FilmTraces&) = delete;

  [[nodiscard]] Trace* rendering() const { return rendering_; }
  /// The trace for writing and verifying finished frames.
  [[nodiscard]] Trace* writing() const { return writing_; }

 private:
  Trace trace_, compositing_;
  Trace *rendering_, *writing_;
};

}  // namespace tessera::apps
