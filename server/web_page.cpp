// SPDX-License-Identifier: BSD-3-Clause
#include "server/web_page.hpp"

namespace tessera::server {

std::string html_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string sentence_page(std::string_view sentence) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Tessera</title>\n<p>" +
         html_escaped(sentence) + "</p></html>\n";
}

}  // namespace tessera::server
