// SPDX-License-Identifier: BSD-3-Clause
#include "server/web_page.hpp"

#include "tessera/program/text.hpp"

namespace tessera::server {

std::string sentence_page(std::string_view sentence) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Tessera</title>\n<p>" +
         xml_escaped(sentence) + "</p></html>\n";
}

}  // namespace tessera::server
