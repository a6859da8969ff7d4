// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/default_view.hpp"

namespace tessera::io {

/// Non-numeric metadata in a header about the values and the world; `convert` preserves it.
struct VolumeTags {
  std::string modality;     ///< DICOM's code: CT, MR, PT ...; empty: not stated
  std::string unit;         ///< of values; empty: not stated
  std::string length_unit;  ///< of the world: mm, m ...; empty: not stated
  bool labels = false;      ///< the values are declared to be labels

  bool operator==(const VolumeTags&) const = default;
};

/// A patient's axes and tags as name-value pairs for the header of a file: `space` as in NRRD, `modality`, `unit`,
/// `length unit` and `intent` ("label"). Omits what is not stated, and control characters.
std::vector<std::pair<std::string, std::string>> tag_words(BodyAxes axes, const VolumeTags& tags);

/// "modality CT, values in HU"; empty if neither is stated.
std::string note_on(const VolumeTags& tags);

/// The inverse of tag_words() for one pair; ignores other names.
void take_word(std::string_view name, std::string_view word, BodyAxes& axes, VolumeTags& tags);

}  // namespace tessera::io
