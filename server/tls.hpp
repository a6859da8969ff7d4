// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

namespace boost::asio::ssl {
class context;
}

namespace tessera::server {

/// Makes a context for TLS 1.3 and for TLS 1.2 with forward secrecy. Throws Error(bad_input) if the certificate and the
/// key cannot be read or do not match, and in a build without TLS (TESSERA_TLS).
std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                       const std::filesystem::path& key);

}  // namespace tessera::server
