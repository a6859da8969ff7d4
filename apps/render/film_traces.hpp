// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/trace.hpp"

namespace tessera::apps {

/// Where the times of one rank's run are recorded (--timing). All pointers are null unless that is asked for.
class FilmTraces {
 public:
  /// `overlapping`: frames are rendered while others are composited and written, by roles of their own.
  FilmTraces(bool timed, bool overlapping)
      : trace_(overlapping ? TraceRole::projector : TraceRole::both),
        compositing_(trace_, TraceRole::compositor),
        rendering_(timed ? &trace_ : nullptr),
        writing_(timed && overlapping ? &compositing_ : rendering_) {}
  FilmTraces(const FilmTraces&) = delete;
  FilmTraces& operator=(const FilmTraces&) = delete;

  [[nodiscard]] Trace* rendering() const { return rendering_; }
  /// Of finished frames: writing and verifying.
  [[nodiscard]] Trace* writing() const { return writing_; }

 private:
  Trace trace_, compositing_;
  Trace *rendering_, *writing_;
};

}  // namespace tessera::apps
