// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "io/foreign/client/foreign_file.hpp"

namespace tessera::io {

/// An image (kind image of io/foreign/messages/foreign_data.hpp) of cells, or trees of cells.
struct OpenedAmrBlock {
  const ForeignFile* file;  ///< null if no reader program holds the block; the block then has no ghosts
  const ForeignPart* part;
};

/// A file with refinement levels, without its numbers, which stay in the helper or in the mapped file.
struct OpenedAmr {
  std::deque<ForeignFile> files;         ///< files held by the helper; addresses stay valid
  std::deque<ForeignPart> parts;         ///< parts from our own parser; addresses stay valid
  std::vector<OpenedAmrBlock> blocks;    ///< images or trees, each in one of `files` or `parts`
  std::vector<cells::CellBlock> fields;  ///< per AMR block, a block with its name and fields, but no cells. Empty for
                                         ///< files of the helper: not requested yet
  std::string format;
  std::vector<std::string> notes;

  void add(ForeignFile opened);
};

/// Opens VTK's list of blocks. Each block is read separately, so that errors name its file. The spacing determines the
/// level of a block.
OpenedAmr open_amr_list(const InputFile& file);

/// Opens VTK's trees, in one file or in pieces. Each piece is read separately.
OpenedAmr open_hyper_trees(const InputFile& file);

}  // namespace tessera::io
