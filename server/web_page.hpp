// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera::server {

/// A file of server/web/, embedded in the program.
struct WebFile {
  std::string_view name, type, text;
};

/// Returns the file of this name; null for an unknown name. The page itself is "index.html".
const WebFile* web_file(std::string_view name);

/// Returns a page that contains one sentence.
std::string sentence_page(std::string_view sentence);

}  // namespace tessera::server
