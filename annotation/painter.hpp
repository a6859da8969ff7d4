// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "annotation/drawing.hpp"
#include "annotation/ink.hpp"
#include "annotation/tiled_layer.hpp"
#include "annotation/typeface.hpp"

namespace tessera::annotation {

/// Renders a drawing to pixels. Parts outside the image are not drawn. Throws Error(system_failure) if Cairo fails.
void paint(const Drawing& drawing, const Ink& ink, const Typeface& typeface, TiledLayer& layer);

}  // namespace tessera::annotation
