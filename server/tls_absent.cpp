// SPDX-License-Identifier: BSD-3-Clause
#include "server/byte_stream.hpp"
#include "server/tls.hpp"
#include "tessera/error.hpp"

namespace tessera::server {

std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                       const std::filesystem::path& /*key*/) {
  throw bad_input(certificate.string() +
                  ": this build has no TLS; configure with -DTESSERA_TLS=ON, or use an SSH tunnel");
}

std::unique_ptr<Bytes> tls_bytes(boost::asio::ip::tcp::socket /*socket*/, boost::asio::ssl::context& /*tls*/) {
  return nullptr;  // never called: tls_context() throws
}

}  // namespace tessera::server
