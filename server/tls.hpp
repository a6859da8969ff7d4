// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

namespace boost::asio::ssl {
class context;
}

namespace tessera::server {

/// For TLS 1.3, and 1.2 with forward secrecy. Throws Error(bad_input) if certificate and key cannot be read or do not
/// match, or in a build without TLS (TESSERA_TLS).
std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                       const std::filesystem::path& key);

}  // namespace tessera::server
