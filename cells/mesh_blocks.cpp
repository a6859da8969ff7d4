// SPDX-License-Identifier: BSD-3-Clause
#include "cells/mesh_blocks.hpp"

#include <algorithm>

namespace tessera::cells {

void add_notes(const std::vector<std::string>& more, std::vector<std::string>& notes) {
  for (const std::string& note : more)
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

}  // namespace tessera::cells
