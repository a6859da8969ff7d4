// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/mechanisms.hpp"
#include "tessera/optical_model.hpp"

/// Conversion of option words to values. Every function throws Error(bad_input), whose message begins with `option` and
/// contains the given and the allowed values.
namespace tessera::api {

/// `WxH` in pixels, each 1 to max_image_side.
ImageSize parse_size(const std::string& option, const std::string& text);

/// A number of bytes, with an optional suffix K, M, G or T (powers of 1024; `MB` and `MiB` mean `M`).
/// At least 1M.
std::uint64_t parse_bytes(const std::string& option, const std::string& text);

/// Returns the index of `text` in `known`.
std::size_t parse_choice(const std::string& option, std::string_view text, std::span<const std::string_view> known);

/// `exact`, `sampled:N` with N from 1 to 4096, `preintegrated` or `preintegrated:N` with N from 8 to 512, `partial`, or
/// `auto`.
Integrator parse_integrator(const std::string& option, const std::string& text);

struct WithoutWords {
  Mechanisms use;
  bool merging = true;  ///< whether touching segments are composited before they are sent
};

/// Mechanisms to switch off: culling, skipping, termination, lattice, sharing and merging, separated by commas. Empty
/// text switches off none.
WithoutWords parse_without(const std::string& option, const std::string& text);

/// `R,G,B` as linear light, each >= 0; `#rrggbb` or `#rgb` as sRGB; or a CSS colour name (api/options/color_names.hpp).
glm::dvec3 parse_color(const std::string& option, const std::string& text);

/// `X,Y,Z`, three finite numbers. If `positive`, each must be above zero.
glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool positive);

/// Splits `text` at commas. The result has at least one word; words may be empty.
std::vector<std::string> split_at_commas(const std::string& text);

/// `count` finite numbers, separated by commas. `form` describes them in the message: "MIN,MAX, two numbers".
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count,
                                  const std::string& form);

/// A number that is finite and above zero.
double parse_positive(const std::string& option, const std::string& text);

/// A whole number from `low` to `high`.
int parse_count(const std::string& option, const std::string& text, int low, int high);

}  // namespace tessera::api
