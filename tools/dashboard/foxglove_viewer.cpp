#include "tools/dashboard/foxglove_viewer.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>

#include "tools/dashboard/foxglove_protocol.h"
#include "tools/dashboard/foxglove_server.h"
#include "tools/dashboard/json_text.h"

namespace maploop::dashboard {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using nlohmann::json;
using namespace foxglove;

constexpr std::size_t longest_message = 1U << 16U;  // bytes that a viewer may send at once
constexpr std::size_t most_subscriptions = 1024;

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

void FoxgloveViewer::start(bool full) {
  stream_.next_layer().expires_after(FoxgloveServer::patience);
  http::async_read(stream_.next_layer(), read_, request_,
                   [self = shared_from_this(), full](error_code error, std::size_t) {
                     if (error) return self->leave();
                     self->take_request(full);
                   });
}

void FoxgloveViewer::take_request(bool full) {
  using http::status;
  const std::string origin(view(request_[http::field::origin]));
  if (!beast::websocket::is_upgrade(request_))
    return refuse(status::upgrade_required, "this is a WebSocket for Foxglove, and no page");
  if (!origin.empty() && !server_.allows(origin)) {
    return refuse(
        status::forbidden,
        "pages of " + origin + " may not connect: maploop dashboard --origin allows them");
  }
  if (!offers_protocol(view(request_[http::field::sec_websocket_protocol])))
    return refuse(status::bad_request, "the protocol is " + std::string(protocol));
  if (full) return refuse(status::service_unavailable, "there are too many viewers already");
  stream_.next_layer().expires_never();
  stream_.read_message_max(longest_message);
  stream_.set_option(
      beast::websocket::stream_base::decorator([](beast::websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol,
                     beast::string_view(protocol.data(), protocol.size()));
      }));
  stream_.async_accept(request_, [self = shared_from_this()](error_code error) {
    if (error) return self->leave();
    self->read_.clear();
    self->open_ = true;
    self->send(json_text(server_info()));
    self->send(self->server_.channels());
    self->send(json_text(services()));
    self->read();
  });
}

void FoxgloveViewer::refuse(http::status status, std::string_view why) {
  auto response = std::make_shared<http::response<http::string_body>>(status, request_.version());
  response->set(http::field::content_type, "text/plain");
  response->body() = std::string(why) + '\n';
  response->prepare_payload();
  http::async_write(
      stream_.next_layer(), *response,
      [self = shared_from_this(), response](error_code, std::size_t) { self->leave(); });
}

void FoxgloveViewer::read() {
  stream_.async_read(read_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->leave();
    const auto bytes = self->read_.data();
    const std::string_view message(static_cast<const char*>(bytes.data()), bytes.size());
    self->stream_.got_text() ? self->take_text(message) : self->take_call(message);
    self->read_.clear();
    self->read();
  });
}

void FoxgloveViewer::take_text(std::string_view message) {
  const json asked = json::parse(message, nullptr, false);
  const std::string op = asked.is_object() ? text(asked, "op") : "";
  if (op == "subscribe") {
    for (const json& each : list(asked, "subscriptions")) {
      const auto id = integer(each, "id"), channel = integer(each, "channelId");
      if (!id || !channel || *id < 0 || *id > UINT32_MAX || *channel < 0 || *channel > INT32_MAX) {
        warn("a subscription has no number, or no channel");
        continue;
      }
      subscribe(static_cast<std::uint32_t>(*id), static_cast<int>(*channel));
    }
  } else if (op == "unsubscribe") {
    for (const json& each : list(asked, "subscriptionIds"))
      if (each.is_number_unsigned()) unsubscribe(each.get<std::uint32_t>());
  } else {
    warn(op.empty() ? "a text is no JSON object with \"op\"" : "'" + op + "' is not supported");
  }
}

// The service and the call are numbers, then come the length and the name of the encoding, and the
// request.
void FoxgloveViewer::take_call(std::string_view bytes) {
  constexpr std::size_t header = 13;
  if (bytes.size() < header || bytes[0] != call_request)
    return warn("a binary message is no call of a service");
  const std::uint32_t service = number_at(bytes, 1), call = number_at(bytes, 5);
  const std::size_t encoding = number_at(bytes, 9);
  const auto fail = [&](std::string_view why) {
    send(json_text({{"op", "serviceCallFailure"},
                    {"serviceId", service},
                    {"callId", call},
                    {"message", why}}));
  };
  if (service != 1) return fail("there is no such service");
  if (encoding > bytes.size() - header || bytes.substr(header, encoding) != "json")
    return fail("the encoding of a request is json");
  const json request = json::parse(bytes.substr(header + encoding), nullptr, false);
  if (!request.is_object() || text(request, "run").empty() || text(request, "kind").empty())
    return fail("a request is {\"run\": ..., \"kind\": ..., \"value\": ...}; RUN names the runs");
  const auto value = request.find("value");
  const bool number = value != request.end() && value->is_number();
  const std::string why = server_.control(text(request, "run"), text(request, "kind"),
                                          number ? value->get<double>() : 0.0);
  if (!why.empty()) return fail(why);
  Frame answer;
  answer.head = call_response;
  append(answer.head, service);
  append(answer.head, call);
  append(answer.head, std::uint32_t{4});
  answer.head += "json{}";
  queue(std::move(answer));
}

void FoxgloveViewer::subscribe(std::uint32_t subscription, int channel) {
  if (!server_.has(channel)) return warn("there is no channel " + std::to_string(channel));
  if (subscriptions_.size() >= most_subscriptions) return warn("there are too many subscriptions");
  if (!subscriptions_.emplace(subscription, channel).second)
    return warn("subscription " + std::to_string(subscription) + " is there already");
  server_.subscribed(channel, 1);
  for (const Message& message : server_.kept(channel)) queue_message(subscription, message);
}

void FoxgloveViewer::unsubscribe(std::uint32_t subscription) {
  const auto found = subscriptions_.find(subscription);
  if (found == subscriptions_.end())
    return warn("there is no subscription " + std::to_string(subscription));
  server_.subscribed(found->second, -1);
  subscriptions_.erase(found);
}

void FoxgloveViewer::warn(std::string_view what) {
  constexpr int warning = 1;
  send(json_text({{"op", "status"}, {"level", warning}, {"message", what}}));
}

void FoxgloveViewer::send(std::string text) {
  queue({true, std::move(text), nullptr});
}

void FoxgloveViewer::send_message(int channel, const Message& message) {
  for (const auto& [subscription, subscribed] : subscriptions_)
    if (subscribed == channel) queue_message(subscription, message);
}

void FoxgloveViewer::queue_message(std::uint32_t subscription, const Message& message) {
  Frame frame{false, std::string(1, message_data), message.json};
  append(frame.head, subscription);
  append(frame.head, message.nanoseconds);
  queue(std::move(frame));
}

void FoxgloveViewer::queue(Frame frame) {
  if (!open_) return;
  waiting_bytes_ += frame.size();
  waiting_.push_back(std::move(frame));
  // Texts are few, and say what messages mean; messages are lost from the oldest on.
  const auto is_message = [](const Frame& f) { return f.body != nullptr; };
  while (waiting_bytes_ > FoxgloveServer::most_waiting) {
    const auto oldest = std::find_if(waiting_.begin() + 1, waiting_.end(), is_message);
    if (oldest == waiting_.end()) break;
    waiting_bytes_ -= oldest->size();
    waiting_.erase(oldest);
    server_.lost();
    if (!told_of_loss_) {
      told_of_loss_ = true;
      return warn("this viewer is too slow for what it is subscribed to, and loses messages");
    }
  }
  if (!sending_since_) write();
}

void FoxgloveViewer::write() {
  if (waiting_.empty() || !open_) return;
  sending_since_ = std::chrono::steady_clock::now();
  const Frame& frame = waiting_.front();
  stream_.text(frame.text);
  const std::array<boost::asio::const_buffer, 2> parts{
      boost::asio::buffer(frame.head),
      frame.body ? boost::asio::buffer(*frame.body) : boost::asio::const_buffer{}};
  stream_.async_write(parts, [self = shared_from_this()](error_code error, std::size_t) {
    self->sending_since_.reset();
    if (error || !self->open_) return self->leave();
    self->waiting_bytes_ -= self->waiting_.front().size();
    self->waiting_.pop_front();
    self->write();
  });
}

bool FoxgloveViewer::is_stuck(std::chrono::steady_clock::time_point now) const {
  return sending_since_ && now - *sending_since_ > FoxgloveServer::patience;
}

void FoxgloveViewer::close() {
  open_ = false;
  stream_.next_layer().close();
}

void FoxgloveViewer::leave() {
  if (std::exchange(left_, true)) return;
  close();
  for (const auto& [subscription, channel] : subscriptions_) server_.subscribed(channel, -1);
  subscriptions_.clear();
  server_.left(shared_from_this());
}

}  // namespace maploop::dashboard
