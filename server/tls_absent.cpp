#include "server/connection.hpp"
#include "server/tls.hpp"
#include "tessera/error.hpp"

namespace tessera::server {

std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                       const std::filesystem::path& /*key*/) {
  throw bad_input(certificate.string() +
                  ": this build has no TLS; configure with -DTESSERA_TLS=ON, or use an SSH tunnel");
}

void start_tls_connection(boost::asio::ip::tcp::socket /*socket*/, Network& /*network*/,
                          boost::asio::ssl::context& /*tls*/) {}

}  // namespace tessera::server
