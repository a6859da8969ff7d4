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
    copying,  ///< points and cells are copied from the format's library
    filling   ///< a surface is filled with tets; the progress is unknown
  };
  Stage stage = Stage::reading;
  double done = 0;  ///< completed fraction of the stage, 0 to 1, as reported by the library; it may grow unevenly
  /// For `filling`: the longest time measured for valid surfaces with this number of facets; 0: unknown.
  double expected_seconds = 0;
};

/// Callback for ReadOptions::progress. The thread that opens the file calls it about ten times a second while the
/// format's library reads the file, then once for each piece or each two megabytes copied, so it must be fast. It is
/// not called for files that are read in less than a tenth of a second, for formats whose library reports no progress,
/// and for formats that Tessera parses itself. For VTK's XML files it is only called in the stage `copying`. It must
/// not throw or call the library.
using ReadProgressFunction = std::function<void(const ReadProgress&)>;

}  // namespace v0_1
}  // namespace tessera
