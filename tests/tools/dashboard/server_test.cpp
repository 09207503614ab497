// Tests the dashboard's server with requests of browsers and of other sites' pages.
#include "tools/dashboard/server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace maploop::dashboard {
namespace {

// The library makes internal tables at its first request, behind a guard that the thread sanitizer
// does not see, because the library was not built with it. This thread makes them and ends before
// any other begins.
class FirstRequest : public ::testing::Environment {
  void SetUp() override {
    httplib::Server server;
    const int port = server.bind_to_any_port("127.0.0.1");
    std::thread serving([&] { server.listen_after_bind(); });
    httplib::Client("127.0.0.1", port).Get("/");
    server.stop();
    serving.join();
  }
};
const auto* const first_request = ::testing::AddGlobalTestEnvironment(new FirstRequest);

Server::Handlers handlers() {
  return {[](const std::string&) { return std::string("{}"); },
          [](const std::string&, const std::string&, double) { return std::string(); },
          [](const Geodetic&) { return std::string("{}"); }};
}

class DashboardServer : public ::testing::Test {
 protected:
  int asked(const std::string& host, const httplib::Headers& more = {}) const {
    httplib::Client client("127.0.0.1", server_.port());
    httplib::Headers headers = more;
    headers.emplace("Host", host);
    const auto answer = client.Get("/trail", headers);
    return answer ? answer->status : -1;
  }
  std::string here(const std::string& host) const {
    return host + ":" + std::to_string(server_.port());
  }

  LiveChannels channels_;
  Server server_{"127.0.0.1", 0, channels_, handlers()};
};

TEST_F(DashboardServer, AnswersToItsOwnNamesAlone) {
  EXPECT_EQ(asked(here("127.0.0.1")), 200);
  EXPECT_EQ(asked(here("localhost")), 200);
  EXPECT_EQ(asked(here("[::1]")), 200);
  EXPECT_EQ(asked("localhost:9000"), 200) << "through a tunnel";
  // A site whose name was made to resolve to this machine.
  EXPECT_EQ(asked(here("evil.example.org")), 403);
  EXPECT_EQ(asked(here("localhost.example.org")), 403);
  EXPECT_EQ(asked(here("10.0.0.1")), 403);
  EXPECT_EQ(asked(here("evil.example.org"), {{"Origin", "http://" + here("evil.example.org")}}),
            403);
}

TEST_F(DashboardServer, AnswersToItsOwnPageAlone) {
  EXPECT_EQ(asked(here("localhost"), {{"Origin", "http://" + here("localhost")}}), 200);
  EXPECT_EQ(asked(here("localhost"), {{"Origin", "http://evil.example.org"}}), 403);
  EXPECT_EQ(asked(here("localhost"), {{"Origin", "http://localhost:1"}}), 403);
  EXPECT_EQ(asked(here("localhost"), {{"Origin", "null"}}), 403);
}

TEST_F(DashboardServer, CommandsFromElsewhereAreRefused) {
  httplib::Client client("127.0.0.1", server_.port());
  const std::string pause = "{\"run\": \"0123abcd\", \"kind\": \"pause\", \"value\": 0}";
  EXPECT_EQ(client.Post("/control", pause, "application/json")->status, 200);
  const httplib::Headers bound{{"Host", here("evil.example.org")}};
  EXPECT_EQ(client.Post("/control", bound, pause, "application/json")->status, 403);
}

TEST_F(DashboardServer, APortIsOfOneDashboard) {
  try {
    const Server second("127.0.0.1", server_.port(), channels_, handlers());
    ADD_FAILURE();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("--port 0"), std::string::npos) << e.what();
  }
}

TEST(DashboardAddress, OfEveryInterfaceIsAnsweredByNumberAlone) {
  LiveChannels channels;
  const Server server("0.0.0.0", 0, channels, handlers());
  httplib::Client client("127.0.0.1", server.port());
  EXPECT_EQ(client.Get("/trail", {{"Host", "192.168.1.7:8080"}})->status, 200);
  EXPECT_EQ(client.Get("/trail", {{"Host", "evil.example.org"}})->status, 403);
}

TEST_F(DashboardServer, ThePageAsksForNoIcon) {
  httplib::Client client("127.0.0.1", server_.port());
  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_NE(page->body.find("<link rel=\"icon\" href=\"data:,\">"), std::string::npos);
}

// A browser that requests the events and never reads them.
class StalledBrowser {
 public:
  explicit StalledBrowser(int port) {
    const int small = 4096;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    const std::string request = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_EQ(write(fd_, request.data(), request.size()), static_cast<ssize_t>(request.size()));
  }
  ~StalledBrowser() { close(fd_); }
  StalledBrowser(const StalledBrowser&) = delete;
  StalledBrowser& operator=(const StalledBrowser&) = delete;

 private:
  int fd_ = socket(AF_INET, SOCK_STREAM, 0);
};

TEST_F(DashboardServer, WhoStopsReadingMakesRoomForOthers) {
  std::vector<std::unique_ptr<StalledBrowser>> stalled;
  for (int i = 0; i < Server::most_browsers; ++i) {
    stalled.push_back(std::make_unique<StalledBrowser>(server_.port()));
  }
  const auto status = [&] {
    channels_.put("", "BIG", "\"" + std::string(1 << 20, 'x') + "\"");
    httplib::Client client("127.0.0.1", server_.port());
    int status = -1;
    std::string refused;
    client.Get(
        "/events",
        [&](const httplib::Response& response) {
          status = response.status;
          return true;
        },
        [&](const char* data, std::size_t size) {
          refused.append(data, size);
          return status != 200;
        });
    if (status == 503) {
      EXPECT_NE(refused.find("24 browsers"), std::string::npos) << refused;
    }
    return status;
  };
  const auto comes_to = [&](int wanted) {
    for (int i = 0; i < 600; ++i) {
      if (status() == wanted) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  };
  EXPECT_TRUE(comes_to(503)) << "the places are taken";
  EXPECT_TRUE(comes_to(200)) << "they are free again";
}

}  // namespace
}  // namespace maploop::dashboard
