// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace tessera {
inline namespace v0_1 {

/// The progress of reading a file.
struct ReadProgress {
  enum class Stage : std::uint8_t {
    reading,  ///< the format's library reads the file
    copying,  ///< points and cells are copied from that library
    filling   ///< a surface is filled with tets; the progress is unknown
  };
  Stage stage = Stage::reading;
  double done = 0;  ///< of that stage, 0 to 1, as reported by the library; need not grow evenly
  /// For filling: the longest time that a valid surface with this number of facets takes, if it was measured; 0:
  /// unknown.
  double expected_seconds = 0;
};

/// Callback for ReadOptions::progress, called by the thread that opens the file: about ten times a second while another
/// program's format is read, then for each two megabytes or piece copied, so it must be fast. It is not called for
/// files that are read in less than a tenth of a second, for formats whose library reports no progress, or for formats
/// that Tessera parses itself; for VTK's XML files only for `copying`. It must not throw or call the library.
using ReadProgressFunction = std::function<void(const ReadProgress&)>;

}  // namespace v0_1
}  // namespace tessera
