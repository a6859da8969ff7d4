// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/options/cli_fwd.hpp"
#include "tessera/annotation.hpp"
#include "tessera/image_file.hpp"

namespace tessera::apps {

/// The options that annotate pictures, as they stand on the command line. annotation_options.cpp declares each once.
struct AnnotationWords {
  std::string color_bar, title, range, scale, unit, axes, outline, scale_bar, length_unit, color, size, layer;
  std::vector<std::string> texts;
};

/// What they say.
struct AnnotationOptions {
  /// Nothing to be drawn: none. Texts and title have words in braces still.
  std::optional<Annotation> annotation{};
  std::filesystem::path layer{};   ///< where the annotation goes alone; empty: over the picture
  nlohmann::ordered_json given{};  ///< the options that were given, as words
};

void add_annotation_options(CLI::App& command, AnnotationWords& words);

/// `image` has the picture's background and colours. Throws Error(bad_input) naming the option, also for those that
/// say how to draw what is not drawn.
AnnotationOptions annotation_options(const AnnotationWords& words, const ImageFileOptions& image);

}  // namespace tessera::apps
