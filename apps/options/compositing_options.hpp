// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "apps/options/cli_fwd.hpp"
#include "tessera/settings.hpp"

namespace tessera::apps {

struct RenderWords;

/// Declares --compositor, --backend, --framebuffer and --egl-device.
void add_compositing_options(CLI::App& command, RenderWords& words);

/// What they say. Nothing said: no backends, which is the CPU without a word about devices. Throws
/// Error(bad_input).
DeviceSettings device_settings(const RenderWords& words, bool for_volume);

/// Throws unless `text` is one of `known`.
void check_word(const char* option, const std::string& text, std::initializer_list<std::string_view> known);

}  // namespace tessera::apps
