// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace tessera {
inline namespace v0_1 {

/// How far the reading of a file is.
struct ReadProgress {
  enum class Stage : std::uint8_t {
    reading,  ///< the library of its format reads the file
    copying,  ///< points and cells come from there
    filling   ///< a surface is filled with tets: nobody knows how far that is
  };
  Stage stage = Stage::reading;
  double done = 0;  ///< of that stage, 0 to 1, as far as the library says: it need not grow evenly
  /// Of filling, what a sound surface of as many facets takes at most, where that was measured; 0: not known.
  double expected_seconds = 0;
};

/// Hears of it, for ReadOptions::progress. Called by the thread that opens the file, while another program's format is
/// read about ten times a second, then for each two megabytes or piece that comes, so that it has to be quick. Not
/// called for files that are read in less than a tenth of a second, nor for formats whose library says nothing of how
/// far it is, nor for those that Tessera parses itself, of VTK's XML files for `copying` alone. It must not throw, and
/// not call the library.
using ReadProgressFunction = std::function<void(const ReadProgress&)>;

}  // namespace v0_1
}  // namespace tessera
