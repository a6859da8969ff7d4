#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

#include "frame/compositing_device.hpp"

namespace tessera::apps {

struct RenderWords;

/// Declares --compositor, --backend, --framebuffer and --egl-device.
void add_compositing_options(CLI::App& command, RenderWords& words);

/// What they say. Nothing said: no backends, which is the CPU without a word about devices. Throws
/// scene::Error(bad_input).
frame::CompositingSettings compositing_settings(const RenderWords& words, bool for_volume);

/// Whether some compositor works as Juliachs et al. 2007 printed it.
bool composites_as_printed(const frame::CompositingSettings& settings);

/// Throws unless `text` is one of `known`.
void check_word(const char* option, const std::string& text, std::initializer_list<std::string_view> known);

}  // namespace tessera::apps
