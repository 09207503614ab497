// Tests the WebSocket for Foxglove with right and wrong viewers.
#include "tools/dashboard/foxglove_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "tools/dashboard/foxglove_bridge.h"

namespace maploop::dashboard {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* v1 = "foxglove.websocket.v1";

class Viewer {
 public:
  explicit Viewer(int port) {
    stream_.next_layer().connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
    stream_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, v1);
    }));
    websocket::response_type response;
    stream_.handshake(response, "127.0.0.1", "/");
    chosen = std::string(response[http::field::sec_websocket_protocol]);
  }

  // The next text, or the next message's payload after its 13 bytes of header.
  json next() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    std::string bytes = beast::buffers_to_string(buffer.data());
    if (stream_.got_text()) return json::parse(bytes);
    head = bytes.substr(0, 13);
    return json::parse(bytes.substr(13), nullptr, false);
  }
  json next_of(const std::string& op) {
    for (;;)
      if (json text = next(); text.value("op", "") == op) return text;
  }
  void send(const std::string& text) {
    stream_.text(true);
    stream_.write(asio::buffer(text));
  }
  void call(const std::string& request, const std::string& encoding = "json", char service = 1) {
    const std::string bytes = std::string("\2") + service + std::string("\0\0\0\7\0\0\0", 7) +
                              static_cast<char>(encoding.size()) + std::string(3, '\0') + encoding +
                              request;
    stream_.binary(true);
    stream_.write(asio::buffer(bytes));
  }
  void subscribe(int subscription, int channel) {
    send(json{{"op", "subscribe"},
              {"subscriptions", {{{"id", subscription}, {"channelId", channel}}}}}
             .dump());
  }

  std::string chosen, head;

 private:
  asio::io_context io_;
  websocket::stream<tcp::socket> stream_{io_};
};

class Foxglove : public ::testing::Test {
 protected:
  void wait_until_wanted(int channel, bool wanted = true) {
    for (int i = 0; i < 5000 && server_.wanted(channel) != wanted; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_EQ(server_.wanted(channel), wanted);
  }

  std::string control_;
  FoxgloveServer server_{"127.0.0.1",
                         0,
                         {"https://app.foxglove.dev"},
                         [this](const std::string& run, const std::string& kind, double value) {
                           control_ = run + ' ' + kind + ' ' + std::to_string(value);
                           return kind == "fly" ? "there is no command 'fly'" : "";
                         }};
};

TEST_F(Foxglove, AViewerGetsWhatItIsSubscribedTo) {
  const int imu = server_.add({"IMU", "imu_t", R"({"type":"object"})"});
  Viewer viewer(server_.port());
  EXPECT_EQ(viewer.chosen, v1);
  EXPECT_EQ(viewer.next()["op"], "serverInfo");
  const json channels = viewer.next()["channels"];
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0]["topic"], "IMU");
  EXPECT_EQ(channels[0]["encoding"], "json");
  EXPECT_EQ(viewer.next()["services"][0]["name"], "/replay/control");

  const int fix = server_.add({"/map/fix", "foxglove.LocationFix", "{}"});
  EXPECT_EQ(viewer.next()["channels"][0]["id"], fix);
  EXPECT_FALSE(server_.wanted(imu));
  viewer.subscribe(5, imu);
  wait_until_wanted(imu);
  EXPECT_FALSE(server_.wanted(fix));
  server_.publish(fix, 1, "{}");
  server_.publish(imu, 0x0102030405060708, R"({"yaw_rate":1})");
  EXPECT_EQ(viewer.next()["yaw_rate"], 1);
  EXPECT_EQ(viewer.head, std::string("\1\5\0\0\0\10\7\6\5\4\3\2\1", 13));
  viewer.send(R"({"op":"unsubscribe","subscriptionIds":[5]})");
  wait_until_wanted(imu, false);
}

TEST_F(Foxglove, AViewerThatComesLaterGetsWhatIsKept) {
  const int channel = server_.add({"CALIBRATION", "calibration_t", "{}"});
  server_.publish(channel, 1, R"({"old":true})", true);
  server_.publish(channel, 2, R"({"part":1})", true);
  server_.publish(channel, 2, R"({"part":2})", true);
  Viewer viewer(server_.port());
  viewer.next_of("advertiseServices");
  viewer.subscribe(1, channel);
  EXPECT_EQ(viewer.next()["part"], 1);
  EXPECT_EQ(viewer.next()["part"], 2);
  server_.forget(channel);
  viewer.subscribe(2, channel);
  server_.publish(channel, 3, R"({"part":3})");
  EXPECT_EQ(viewer.next()["part"], 3) << "nothing is kept any more";
}

TEST_F(Foxglove, WhoIsNoViewerIsRefusedWithTheReason) {
  const auto asked = [&](const char* protocol, const char* origin) {
    asio::io_context io;
    beast::tcp_stream stream(io);
    stream.connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(server_.port())});
    http::request<http::empty_body> request(http::verb::get, "/", 11);
    request.set(http::field::host, "127.0.0.1");
    if (protocol != nullptr) {
      request.set(http::field::connection, "Upgrade");
      request.set(http::field::upgrade, "websocket");
      request.set(http::field::sec_websocket_version, "13");
      request.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
      request.set(http::field::sec_websocket_protocol, protocol);
    }
    if (origin != nullptr) request.set(http::field::origin, origin);
    http::write(stream, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> answer;
    http::read_header(stream, buffer, answer);
    if (answer.get().result_int() != 101U) http::read(stream, buffer, answer);
    return std::to_string(answer.get().result_int()) + ' ' + answer.get().body();
  };
  EXPECT_THAT(asked(nullptr, nullptr), HasSubstr("426 this is a WebSocket for Foxglove"));
  EXPECT_THAT(asked("chat", nullptr), HasSubstr("400 the protocol is foxglove.websocket.v1"));
  EXPECT_THAT(asked(v1, "https://elsewhere.example"),
              HasSubstr("403 pages of https://elsewhere.example may not connect"));
  EXPECT_EQ(asked("newer, foxglove.websocket.v1", "https://app.foxglove.dev"), "101 ");
}

TEST_F(Foxglove, WhatAViewerAsksWronglyIsAnswered) {
  const int channel = server_.add({"IMU", "imu_t", "{}"});
  Viewer viewer(server_.port());
  viewer.next_of("advertiseServices");
  const auto warned = [&](const std::string& text) {
    viewer.send(text);
    return viewer.next_of("status")["message"].get<std::string>();
  };
  EXPECT_THAT(warned("no JSON"), HasSubstr("no JSON object"));
  EXPECT_THAT(warned("[]"), HasSubstr("no JSON object"));
  EXPECT_THAT(warned(R"({"op":"advertise"})"), HasSubstr("'advertise' is not supported"));
  EXPECT_THAT(warned(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":9}]})"),
              HasSubstr("there is no channel 9"));
  for (const char* wrong : {R"([{"id":-1,"channelId":0}])", R"([{"id":1e30,"channelId":0}])",
                            R"([7])", R"([{"id":1,"channelId":"0"}])"}) {
    EXPECT_THAT(warned(R"({"op":"subscribe","subscriptions":)" + std::string(wrong) + "}"),
                HasSubstr("no number"));
  }
  EXPECT_THAT(warned(R"({"op":"unsubscribe","subscriptionIds":[3]})"),
              HasSubstr("there is no subscription 3"));
  viewer.subscribe(1, channel);
  EXPECT_THAT(warned(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})"),
              HasSubstr("is there already"));
  EXPECT_TRUE(server_.wanted(channel));
}

TEST_F(Foxglove, AReplayIsControlledByTheService) {
  Viewer viewer(server_.port());
  viewer.next_of("advertiseServices");
  viewer.call(R"({"run":"1a2b","kind":"seek","value":3.5})");
  viewer.next();
  EXPECT_EQ(viewer.head, std::string("\3\1\0\0\0\7\0\0\0\4\0\0\0", 13));
  EXPECT_EQ(control_, "1a2b seek 3.500000");
  const auto refused = [&] { return viewer.next_of("serviceCallFailure")["message"]; };
  viewer.call(R"({"run":"1a2b","kind":"fly"})");
  EXPECT_EQ(refused(), "there is no command 'fly'");
  for (const char* wrong : {"", "7", R"({"kind":"pause"})", R"({"run":1,"kind":"pause"})"}) {
    viewer.call(wrong);
    EXPECT_THAT(refused(), HasSubstr("a request is")) << wrong;
  }
  viewer.call("{}", "ros1");
  EXPECT_EQ(refused(), "the encoding of a request is json");
  viewer.call("{}", "json", 2);
  EXPECT_EQ(refused(), "there is no such service");
}

TEST_F(Foxglove, AViewerThatDoesNotReadLosesMessagesAndIsLeft) {
  const int channel = server_.add({"VELODYNE", "cloud", "{}"});
  Viewer reader(server_.port()), stuck(server_.port());
  reader.next_of("advertiseServices");
  reader.subscribe(1, channel);
  wait_until_wanted(channel);
  stuck.subscribe(1, channel);
  stuck.subscribe(2, channel);
  const std::string large = '"' + std::string(1U << 20U, 'x') + '"';
  for (int i = 0; i < 24; ++i) {
    server_.publish(channel, i, large);
    EXPECT_EQ(reader.next(), large.substr(1, large.size() - 2)) << "nobody waits for the other";
  }
  EXPECT_GT(server_.lost(), 0U);
  reader.send(R"({"op":"unsubscribe","subscriptionIds":[1]})");
  for (int i = 0; i < 300 && server_.wanted(channel); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(server_.wanted(channel)) << "it was disconnected";
}

TEST_F(Foxglove, APortThatIsTakenIsNamed) {
  const std::string port = std::to_string(server_.port());
  try {
    const FoxgloveServer second("127.0.0.1", server_.port(), {}, {});
    FAIL() << "two servers at one port";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("cannot listen for Foxglove at 127.0.0.1:" + port));
  }
}

TEST_F(Foxglove, AMessageOfTheBusIsDecodedForViewersAndAnotherOneASecondUntilItsChannelsAreKnown) {
  FoxgloveBridge bridge(server_);
  NavState state;
  state.stamp = from_nanoseconds(1'600'000'000'000'000'000);
  std::int64_t now_us = 1'600'000'000'000'000;
  const auto send = [&] {
    const auto bytes = schema::encoded(to_lcm(state));
    bridge.take({.time_us = now_us, .channel = channel_names::nav_state, .data = bytes});
  };
  const auto topics = [&] {
    Viewer viewer(server_.port());
    json channels = viewer.next_of("advertise")["channels"];
    std::vector<std::string> names;
    for (const json& channel : channels) names.push_back(channel["topic"]);
    return names;
  };
  send();
  EXPECT_THAT(topics(), ::testing::ElementsAre("NAV_STATE")) << "there is no position yet";
  state.status = NavStatus::aided;
  now_us += 10'000;
  send();
  EXPECT_THAT(topics(), ::testing::ElementsAre("NAV_STATE")) << "it is not looked at so soon";
  now_us += 990'000;
  send();
  EXPECT_THAT(topics(), ::testing::ElementsAre("NAV_STATE", "/map/fix", "/map/pose", "/tf"));
  const std::vector<std::uint8_t> foreign(40, 1);
  bridge.take({.time_us = now_us, .channel = "FOREIGN", .data = foreign});
  EXPECT_EQ(topics().size(), 4U);
}

}  // namespace
}  // namespace maploop::dashboard
