// SPDX-License-Identifier: BSD-3-Clause
#include "server/tls.hpp"

#include <fmt/format.h>
#include <openssl/ssl.h>

#include <boost/asio/ssl/context.hpp>

#include "tessera/error.hpp"

namespace tessera::server {

std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                       const std::filesystem::path& key) {
  using boost::asio::ssl::context;
  auto tls = std::make_shared<context>(context::tls_server);
  tls->set_options(context::default_workarounds | context::no_sslv2 | context::no_sslv3 | context::no_tlsv1 |
                   context::no_tlsv1_1);
  // For TLS 1.2, only ciphers with forward secrecy and authenticated encryption are allowed. All ciphers of TLS 1.3
  // have both.
  if (::SSL_CTX_set_cipher_list(tls->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20:!PSK") != 1)
    throw Error(ErrorCode::system_failure, "--tls-certificate", "this OpenSSL has no safe ciphers",
                "use another OpenSSL, or an SSH tunnel");
  boost::system::error_code error;
  tls->use_certificate_chain_file(certificate.string(), error);
  if (error)
    throw bad_input(fmt::format("{}: it is not a readable PEM certificate ({}); give a PEM certificate",
                                certificate.string(), error.message()));
  tls->use_private_key_file(key.string(), context::pem, error);
  if (error)
    throw bad_input(fmt::format("{}: it is not a readable PEM key that belongs to {} ({}); give the certificate's key",
                                key.string(), certificate.string(), error.message()));
  return tls;
}

}  // namespace tessera::server
