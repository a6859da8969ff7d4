// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/default_view.hpp"

namespace tessera::io {

/// What a header says of the values and of the world beside numbers; what `convert` writes keeps it.
struct VolumeTags {
  std::string modality;     ///< DICOM's word: CT, MR, PT ...; empty: not stated
  std::string unit;         ///< of values; empty: not stated
  std::string length_unit;  ///< of the world: mm, m ...; empty: not stated
  bool labels = false;      ///< values are labels, whatever they are

  bool operator==(const VolumeTags&) const = default;
};

/// A patient's axes and tags as words by name, for the header of a file: `space` as NRRD writes it, `modality`, `unit`,
/// `length unit` and `intent` ("label"). What is not stated is left out; control characters are too.
std::vector<std::pair<std::string, std::string>> tag_words(BodyAxes axes, const VolumeTags& tags);

/// "modality CT, values in HU"; empty if neither is stated.
std::string note_on(const VolumeTags& tags);

/// The inverse of tag_words() for one word; others are left alone.
void take_word(std::string_view name, std::string_view word, BodyAxes& axes, VolumeTags& tags);

}  // namespace tessera::io
