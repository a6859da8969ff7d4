// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/default_view.hpp"

namespace tessera::io {

/// Non-numeric metadata in a header about the values and the world coordinates. `convert` preserves them.
struct VolumeTags {
  std::string modality;     ///< DICOM's code: CT, MR, PT ...; empty: not stated
  std::string unit;         ///< unit of the values; empty: not stated
  std::string length_unit;  ///< unit of world coordinates: mm, m ...; empty: not stated
  bool labels = false;      ///< the values are declared to be labels

  bool operator==(const VolumeTags&) const = default;
};

/// Returns a patient's axes and the tags as name-value pairs for the header of a file: `space` as in NRRD, `modality`,
/// `unit`, `length unit` and `intent` ("label"). Omits tags that are not stated, and control characters.
std::vector<std::pair<std::string, std::string>> tag_words(BodyAxes axes, const VolumeTags& tags);

/// Returns a note like "modality CT, values in HU"; empty if neither is stated.
std::string note_on(const VolumeTags& tags);

/// Sets the tag that one pair of tag_words() describes; ignores other names.
void take_word(std::string_view name, std::string_view word, BodyAxes& axes, VolumeTags& tags);

}  // namespace tessera::io
