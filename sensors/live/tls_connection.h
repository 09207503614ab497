// This file provides a TCP connection that is encrypted.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "sensors/live/connection.h"

namespace maploop::sensors {

// Acts as a client of TLS 1.2 or newer. The connection is open once the server has shown a
// certificate of `host` that is signed by an authority the system trusts (OpenSSL's SSL_CERT_FILE
// names others). Any error of the certificate or the connection is reported in state().problem,
// after which it stays closed. One thread at a time.
class TlsConnection final : public TwoWayStream {
 public:
  // `host` is a name or a numeric address. Throws std::runtime_error if OpenSSL cannot be
  // initialized.
  TlsConnection(Endpoint endpoint, const std::string& host);
  ~TlsConnection() override;

  std::size_t read(std::span<std::uint8_t> to, Duration patience) override;
  bool write(std::string_view text) override;
  const ConnectionState& state() const override { return state_; }
  const std::string& name() const override { return below_.name(); }

 private:
  struct Session;

  std::size_t decrypt(std::span<std::uint8_t> to);
  void shake_hands();
  bool flush();
  void fail(std::string problem);

  Connection below_;
  std::unique_ptr<Session> session_;
  ConnectionState state_;
  std::array<std::uint8_t, 4096> buffer_{};
};

}  // namespace maploop::sensors
