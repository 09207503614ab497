// These tests check NTRIP requests, the replies of casters of both versions, and RTKLIB's caster.
#include "sensors/live/ntrip_client.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <thread>

#include "sensors/clock/host_clock.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using testing::TcpServer;

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Feeds the text in pieces, and takes the stream in pieces of 5 bytes.
std::string taken(NtripReply& reply, const std::string& text, std::size_t piece) {
  std::string all;
  std::array<std::uint8_t, 5> to{};
  for (std::size_t i = 0; i < text.size(); i += piece) {
    const std::string part = text.substr(i, piece);
    auto from = as_bytes(part);
    while (!from.empty()) {
      const std::size_t size = reply.take(from, to);
      all.append(reinterpret_cast<const char*>(to.data()), size);
    }
  }
  return all;
}

TEST(NtripReply, StreamsOfBothVersions) {
  const std::string chunked =
      "HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nTransfer-Encoding: chunked\r\n\r\n"
      "5\r\nhello\r\nA;name=value\r\n, \r\nworld!\r\n0\r\n\r\nbehind";
  const std::string plain = "HTTP/1.0 200 OK\r\nContent-Type: gnss/data\r\n\r\nhello, \r\nworld!";
  const std::string first = "ICY 200 OK\r\nhello, \r\nworld!";
  for (const std::size_t piece : {1UL, 3UL, 1000UL}) {
    NtripReply a, b, c;
    EXPECT_EQ(taken(a, chunked, piece), "hello, \r\nworld!");
    EXPECT_EQ(a.state(), NtripReply::State::ended);
    EXPECT_EQ(taken(b, plain, piece), "hello, \r\nworld!");
    EXPECT_EQ(taken(c, first, piece), "hello, \r\nworld!");
    EXPECT_EQ(c.state(), NtripReply::State::stream);
  }
}

TEST(NtripReply, ReportsWhyThereIsNoStream) {
  const auto problem = [](const std::string& text) {
    NtripReply reply;
    EXPECT_EQ(taken(reply, text, 7), "");
    EXPECT_EQ(reply.state(), NtripReply::State::refused) << text;
    return reply.problem();
  };
  EXPECT_THAT(problem("SOURCETABLE 200 OK\r\nServer: x\r\n"), HasSubstr("source table"));
  EXPECT_THAT(problem("HTTP/1.1 200 OK\r\nContent-Type: gnss/sourcetable\r\n\r\nSTR;"),
              HasSubstr("not have this mountpoint"));
  EXPECT_THAT(problem("HTTP/1.1 401 Unauthorized\r\n\r\n"), HasSubstr("user and password"));
  EXPECT_THAT(problem("HTTP/1.1 404 Not Found\r\n\r\n"), HasSubstr("not have this mountpoint"));
  EXPECT_THAT(problem("ERROR - Bad Password\r\n"), HasSubstr("'ERROR - Bad Password'"));
  EXPECT_THAT(problem("HTTP/1.1 503 Busy\r\n\r\n"), HasSubstr("'HTTP/1.1 503 Busy'"));
  EXPECT_THAT(problem("220 mail server\r\n"), HasSubstr("is it an NTRIP caster?"));
  EXPECT_THAT(problem("HTTP/1.1 200 OK\r\nX: " + std::string(20'000, 'x')),
              HasSubstr("does not end"));
  const std::string chunked = "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n";
  EXPECT_THAT(problem(chunked + "\r\n"), HasSubstr("without a length"));
  EXPECT_THAT(problem(chunked + "xyz\r\n"), HasSubstr("is not a number"));
  EXPECT_THAT(problem(chunked + "fffffffff\r\n"), HasSubstr("is not a number"));
  EXPECT_THAT(problem(chunked + "1" + std::string(500, ' ')), HasSubstr("no end"));
}

TEST(Ntrip, Addresses) {
  const NtripAddress a =
      parse_ntrip("ntrip://me:p@ss:w@caster.org:2102/SSRA00?version=1&gga=48.5,-8.25,115");
  EXPECT_EQ(a.user, "me");
  EXPECT_EQ(a.password, "p@ss:w");
  EXPECT_EQ(a.host, "caster.org");
  EXPECT_EQ(a.port, 2102);
  EXPECT_EQ(a.mountpoint, "SSRA00");
  EXPECT_EQ(a.version, 1);
  EXPECT_EQ(a.text, "ntrip://***@caster.org:2102/SSRA00?version=1&gga=48.5,-8.25,115");
  ASSERT_TRUE(a.position);
  EXPECT_EQ(ntrip_gga(*a.position, std::chrono::hours(10) + seconds(62)),
            testing::sentence(
                "GPGGA,100102.00,4830.0000000,N,00815.0000000,W,1,10,1.0,115.000,M,0.0,M,,"));
  EXPECT_EQ(parse_ntrip("ntrip://10.0.0.1/M").port, 2101);
  EXPECT_FALSE(parse_ntrip("ntrip://10.0.0.1/M").encrypted);
  EXPECT_EQ(parse_ntrip("ntrips://10.0.0.1/M").port, 443);
  EXPECT_TRUE(parse_ntrip("ntrips://10.0.0.1/M").encrypted);
  for (const char* text :
       {"ntrip://", "ntrip://host", "ntrip://host/", "ntrip:///M", "ntrip://h:0/M",
        "ntrip://h:99999/M", "ntrip://h/M?version=3", "ntrip://h/M?gga=1,2",
        "ntrip://h/M?gga=91,0,0", "ntrip://h/M\r\nX: y", "ntrip://h/M?else=1"}) {
    EXPECT_THROW(parse_ntrip(text), std::invalid_argument) << text;
  }
  EXPECT_THAT([] { parse_ntrip("ntrip://me:secret@host"); },
              ThrowsMessage<std::invalid_argument>(Not(HasSubstr("secret"))));
}

// Reads until `text` has come; returns what came.
std::string read_until(ByteStream& stream, const std::string& text, Duration most = seconds(15)) {
  std::string heard;
  std::array<std::uint8_t, 64> to{};
  const HostClock clock;
  const Time end = clock.now() + most;
  while (clock.now() < end && heard.find(text) == std::string::npos) {
    const std::size_t size = stream.read(to, milliseconds(20));
    heard.append(reinterpret_cast<const char*>(to.data()), size);
  }
  return heard;
}

// Expects that the client gives up, within 10 s, for a reason that contains `text`.
void expect_problem(ByteStream& stream, const std::string& text) {
  std::array<std::uint8_t, 64> to{};
  for (int i = 0; i < 500 && stream.state().problem.find(text) == std::string::npos; ++i)
    stream.read(to, milliseconds(20));
  EXPECT_THAT(stream.state().problem, HasSubstr(text));
}

TEST(NtripClient, AsksAgainAfterARefusalAndAfterTheEndOfTheStream) {
  TcpServer server;
  std::vector<std::string> requests;
  std::jthread caster([&] {
    for (const std::string& reply :
         {std::string("HTTP/1.1 401 Unauthorized\r\n\r\n"),
          std::string(
              "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6\r\nfirst.\r\n0\r\n\r\n"),
          std::string("ICY 200 OK\r\nsecond.")}) {
      if (!server.answer()) return;
      requests.push_back(server.receive_until("\r\n\r\n"));
      server.send(reply);
    }
    std::string position;  // again, a second later
    for (int i = 0; i < 3 && position.empty(); ++i) position = server.receive_until("\r\n");
    requests.push_back(position);
  });
  NtripClient stream(parse_ntrip("ntrip://me:secret@127.0.0.1:" + std::to_string(server.port()) +
                                 "/M1?gga=48.5,8.25,115"),
                     seconds(1));
  expect_problem(stream, "401");
  EXPECT_FALSE(stream.state().open);
  EXPECT_EQ(read_until(stream, "."), "first.");
  EXPECT_EQ(read_until(stream, "."), "second.");
  EXPECT_TRUE(stream.state().open);
  EXPECT_EQ(stream.state().opened, 2u);
  read_until(stream, "nothing", seconds(2));
  caster.join();
  ASSERT_EQ(requests.size(), 4u);
  EXPECT_THAT(requests[0], AllOf(StartsWith("GET /M1 HTTP/1.1\r\nHost: 127.0.0.1:"),
                                 HasSubstr("\r\nNtrip-Version: Ntrip/2.0\r\n"),
                                 HasSubstr("\r\nNtrip-GGA: $GPGGA,"),
                                 HasSubstr("\r\nAuthorization: Basic bWU6c2VjcmV0\r\n")));
  EXPECT_THAT(requests[3], StartsWith("$GPGGA,"));
}

TEST(NtripClient, ReportsThatThereIsNoAnswerAndThatANameIsInvalid) {
  const auto nobody =
      open_stream("ntrip://127.0.0.1:" + std::to_string(testing::free_port()) + "/M");
  expect_problem(*nobody, "cannot be connected to");
  const auto unnamed = open_stream("ntrip://no-such-host.invalid/M");
  expect_problem(*unnamed, "'no-such-host.invalid' has no address");
  EXPECT_THROW(open_stream("ntrip://host"), std::invalid_argument);
}

// This is OpenSSL's own server as a caster of one mountpoint M, with a certificate made for the
// test.
class TlsCaster : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/bin/openssl"))
      GTEST_SKIP() << "SKIPPED, NOT TESTED: no openssl; it is in Debian's package openssl";
    std::ofstream(folder_.path() / "M") << "hello, world.";
  }
  void TearDown() override { unsetenv("SSL_CERT_FILE"); }

  // The certificate is self-signed. `names` is a text such as DNS:localhost,IP:127.0.0.1.
  void begin(const std::string& names) {
    ASSERT_EQ(testing::run({"openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                            "ec_paramgen_curve:prime256v1", "-nodes", "-keyout", file("key.pem"),
                            "-out", file("certificate.pem"), "-days", "2", "-subj", "/CN=caster",
                            "-addext", "subjectAltName=" + names})
                  .status,
              0);
    port_ = std::to_string(testing::free_port());
    server_.emplace(std::vector<std::string>{"sh", "-c",
                                             "cd " + folder_.path().string() +
                                                 " && exec openssl s_server -WWW -accept " + port_ +
                                                 " -cert certificate.pem -key key.pem"});
  }
  void trust() const { setenv("SSL_CERT_FILE", file("certificate.pem").c_str(), 1); }
  std::string file(const char* name) const { return (folder_.path() / name).string(); }
  std::unique_ptr<ByteStream> open(const std::string& host) const {
    return open_stream("ntrips://me:secret@" + host + ":" + port_ + "/M");
  }

  testing::TemporaryFolder folder_;
  std::string port_;
  std::optional<testing::Process> server_;
};

TEST_F(TlsCaster, IsReadByNameAndByAddress) {
  begin("DNS:localhost,IP:127.0.0.1");
  trust();
  for (const char* host : {"localhost", "127.0.0.1"}) {
    const auto stream = open(host);
    EXPECT_EQ(read_until(*stream, ".", seconds(30)), "hello, world.") << stream->state().problem;
    EXPECT_EQ(stream->name(), "ntrips://***@" + std::string(host) + ":" + port_ + "/M");
  }
}

TEST_F(TlsCaster, IsRefusedWithoutATrustedCertificate) {
  begin("IP:127.0.0.1");
  const auto stream = open("127.0.0.1");
  expect_problem(*stream, "is not trusted: self-signed");
  EXPECT_THAT(stream->state().problem, HasSubstr("SSL_CERT_FILE"));
  EXPECT_FALSE(stream->state().open);
}

TEST_F(TlsCaster, IsRefusedWhereItsCertificateIsOfAnother) {
  begin("DNS:other.example.org");
  trust();
  const auto by_address = open("127.0.0.1");
  expect_problem(*by_address, "is not trusted: IP address mismatch");
  const auto by_name = open("localhost");
  expect_problem(*by_name, "hostname mismatch");
}

TEST(NtripClient, ReportsACasterWithoutTls) {
  TcpServer server;
  std::jthread caster([&] {
    if (server.answer()) server.send("ICY 200 OK\r\nhello, world.");
  });
  const auto stream = open_stream("ntrips://127.0.0.1:" + std::to_string(server.port()) + "/M");
  expect_problem(*stream, "failed the TLS handshake");
}

// RTKLIB's str2str acts as the caster and forwards what it receives.
// It is ended by force, because it does not always end when it is asked to.
TEST(NtripClient, ReadsFromRtklibsCaster) {
  if (!std::filesystem::exists("/usr/bin/str2str"))
    GTEST_SKIP() << "SKIPPED, NOT TESTED: no str2str; it is in Debian's package rtklib";
  std::string sent;
  std::mt19937 random(4);
  for (int i = 0; i < 4000; ++i) sent += static_cast<char>('a' + random() % 26);
  TcpServer source;
  const std::string port = std::to_string(testing::free_port());
  testing::Process caster({"str2str", "-in", "tcpcli://127.0.0.1:" + std::to_string(source.port()),
                           "-out", "ntripc://:" + port + "/MAPLOOP"});
  ASSERT_TRUE(source.answer());
  const auto stream = open_stream("ntrip://127.0.0.1:" + port + "/MAPLOOP");
  std::array<std::uint8_t, 64> to{};
  for (int i = 0; i < 500 && !stream->state().open; ++i) stream->read(to, milliseconds(20));
  ASSERT_TRUE(stream->state().open) << stream->state().problem;
  ASSERT_TRUE(source.send(sent + "END."));
  EXPECT_EQ(read_until(*stream, "END.", seconds(30)), sent + "END.") << stream->state().problem;
}

}  // namespace
}  // namespace maploop::sensors
