#include "sensors/live/tls_connection.h"

#include <arpa/inet.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <stdexcept>
#include <utility>

namespace maploop::sensors {
namespace {

std::string reason_of_openssl() {
  const unsigned long code = ERR_get_error();
  const char* reason = code != 0 ? ERR_reason_error_string(code) : nullptr;
  ERR_clear_error();
  return reason != nullptr ? reason : "no reason given";
}

bool expect_host(SSL* ssl, const std::string& host) {
  in_addr ignored{};
  if (inet_pton(AF_INET, host.c_str(), &ignored) == 1) {
    return X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), host.c_str()) == 1;
  }
  return SSL_set1_host(ssl, host.c_str()) == 1 && SSL_set_tlsext_host_name(ssl, host.c_str()) == 1;
}

}  // namespace

struct TlsConnection::Session {
  explicit Session(const std::string& host) : context(SSL_CTX_new(TLS_client_method())) {
    if (context == nullptr) return;
    SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
    SSL_CTX_set_verify(context, SSL_VERIFY_PEER, nullptr);
    const bool trusts = SSL_CTX_set_default_verify_paths(context) == 1;
    ssl = SSL_new(context);
    if (ssl == nullptr) return;
    from_host = BIO_new(BIO_s_mem());
    to_host = BIO_new(BIO_s_mem());
    SSL_set_bio(ssl, from_host, to_host);  // the session owns them from here on
    SSL_set_connect_state(ssl);
    good = trusts && expect_host(ssl, host);
  }
  ~Session() {
    SSL_free(ssl);
    SSL_CTX_free(context);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SSL_CTX* context;
  SSL* ssl = nullptr;
  BIO *from_host = nullptr, *to_host = nullptr;  // encrypted data, in memory
  bool good = false;
  bool over = false;  // closed permanently
};

TlsConnection::TlsConnection(Endpoint endpoint, const std::string& host)
    : below_(std::move(endpoint)), session_(std::make_unique<Session>(host)) {
  if (!session_->good) {
    throw std::runtime_error("TLS to '" + host + "' cannot start: " + reason_of_openssl());
  }
}

TlsConnection::~TlsConnection() = default;

void TlsConnection::fail(std::string problem) {
  session_->over = true;
  state_.open = false;
  state_.problem = std::move(problem);
}

bool TlsConnection::flush() {
  std::array<char, 4096> bytes{};
  while (BIO_pending(session_->to_host) > 0) {
    const int size = BIO_read(session_->to_host, bytes.data(), static_cast<int>(bytes.size()));
    if (size <= 0 || !below_.write({bytes.data(), static_cast<std::size_t>(size)})) return false;
  }
  return true;
}

void TlsConnection::shake_hands() {
  ERR_clear_error();
  const int result = SSL_do_handshake(session_->ssl);
  const int error = SSL_get_error(session_->ssl, result);
  const bool sent = flush();  // also sends the alert of a refusal
  if (result == 1) {
    state_.open = true;
    ++state_.opened;
    state_.problem.clear();
  } else if (error != SSL_ERROR_WANT_READ) {
    const long verdict = SSL_get_verify_result(session_->ssl);
    fail(verdict != X509_V_OK ? std::string("shows a certificate that is not trusted: ") +
                                    X509_verify_cert_error_string(verdict) +
                                    "; set SSL_CERT_FILE to a file of other authorities"
                              : "failed the TLS handshake: " + reason_of_openssl());
  } else if (!sent) {
    fail("does not accept the data sent");
  }
}

std::size_t TlsConnection::decrypt(std::span<std::uint8_t> to) {
  if (!state_.open || to.empty()) return 0;
  ERR_clear_error();
  const int size = SSL_read(session_->ssl, to.data(), static_cast<int>(to.size()));
  if (size > 0) {
    state_.bytes += static_cast<std::size_t>(size);
    return static_cast<std::size_t>(size);
  }
  const int error = SSL_get_error(session_->ssl, size);
  if (error == SSL_ERROR_ZERO_RETURN) fail("was closed by the other side");
  if (error == SSL_ERROR_SSL) fail("sends data that cannot be decrypted: " + reason_of_openssl());
  return 0;
}

std::size_t TlsConnection::read(std::span<std::uint8_t> to, Duration patience) {
  if (session_->over) return 0;
  if (const std::size_t size = decrypt(to); size > 0) return size;
  const std::size_t size = below_.read(buffer_, patience);
  const ConnectionState& below = below_.state();
  if (below.opened == 0) {
    state_.problem = below.problem;
    return 0;
  }
  if (size > 0) BIO_write(session_->from_host, buffer_.data(), static_cast<int>(size));
  if (!state_.open && !session_->over) shake_hands();
  const std::size_t decrypted = decrypt(to);
  const bool gone = !below.open || below.opened > 1;
  if (decrypted == 0 && gone && !session_->over) {
    fail(below.problem.empty() ? "was closed by the other side" : below.problem);
  }
  return decrypted;
}

bool TlsConnection::write(std::string_view text) {
  if (!state_.open) return false;
  ERR_clear_error();
  return SSL_write(session_->ssl, text.data(), static_cast<int>(text.size())) ==
             static_cast<int>(text.size()) &&
         flush();
}

}  // namespace maploop::sensors
