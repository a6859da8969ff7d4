// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "io/foreign/client/foreign_file.hpp"

namespace tessera::io {

/// An image (kind image of io/foreign/messages/foreign_data.hpp) of cells, or trees of cells.
struct OpenedAmrBlock {
  const ForeignFile* file;  ///< null if no reader program holds it; then it has no ghosts
  const ForeignPart* part;
};

/// A file with refinement levels, without its numbers, which stay in the helper or are mapped.
struct OpenedAmr {
  std::deque<ForeignFile> files;       ///< held by the helper; addresses stay valid
  std::deque<ForeignPart> parts;       ///< of our own parser; addresses stay valid
  std::vector<OpenedAmrBlock> blocks;  ///< images or trees, each in one of `files` or `parts`
  std::vector<cells::CellBlock>
      fields;  ///< per block, with its name; no cells. Empty for the helper's: not requested yet
  std::string format;
  std::vector<std::string> notes;

  void add(ForeignFile opened);
};

/// Opens VTK's list of blocks. Each block is read by itself, so that errors name its file. The spacing determines the
/// level of a block.
OpenedAmr open_amr_list(const InputFile& file);

/// Opens VTK's trees, whole or in pieces, each read by itself.
OpenedAmr open_hyper_trees(const InputFile& file);

}  // namespace tessera::io
