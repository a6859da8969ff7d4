// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "io/foreign/client/foreign_file.hpp"

namespace tessera::io {

/// An image (kind image of io/foreign/messages/foreign_data.hpp) of cells, or trees of them.
struct OpenedAmrBlock {
  const ForeignFile* file;  ///< null if no reader program holds it; then it has no ghosts
  const ForeignPart* part;
};

/// Everything of a file with levels of refinement but its numbers, which are with the helper, or mapped.
struct OpenedAmr {
  std::deque<ForeignFile> files;       ///< that the helper holds; stay where they are
  std::deque<ForeignPart> parts;       ///< of a parser of ours; stay too
  std::vector<OpenedAmrBlock> blocks;  ///< images, or trees, of one of these
  std::vector<cells::CellBlock>
      fields;  ///< of each block, and its name; no cells. Of the helper's empty: not asked for yet
  std::string format;
  std::vector<std::string> notes;

  void add(ForeignFile opened);
};

/// VTK's list of blocks, each read by itself, so that faults name the file. What level a block has is seen from its
/// spacing.
OpenedAmr open_amr_list(const InputFile& file);

/// VTK's trees, whole or in pieces, each of which is read by itself.
OpenedAmr open_hyper_trees(const InputFile& file);

}  // namespace tessera::io
