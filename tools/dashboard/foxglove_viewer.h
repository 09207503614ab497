// One viewer of foxglove_server.h: its connection, its subscriptions, and what waits to be sent.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::dashboard {

// Everything happens on the thread of the server's io_context.
class FoxgloveViewer : public std::enable_shared_from_this<FoxgloveViewer> {
 public:
  struct Message {
    std::int64_t nanoseconds = 0;
    std::shared_ptr<const std::string> json;
  };
  // What the server is asked and told; it must outlive the viewer's connection.
  struct Server {
    std::function<bool(const std::string& origin)> allows;
    std::function<std::string()> channels;  // the text that advertises all channels
    std::function<bool(int channel)> has;
    std::function<void(int channel, int change)> subscribed;  // +1 or -1
    std::function<std::vector<Message>(int channel)> kept;    // for who subscribes later
    std::function<std::string(const std::string& run, const std::string& kind, double value)>
        control;
    std::function<void()> lost;
    std::function<void(const std::shared_ptr<FoxgloveViewer>&)> left;
  };

  FoxgloveViewer(boost::asio::ip::tcp::socket socket, const Server& server)
      : stream_(std::move(socket)), server_(server) {}

  // Reads the request of a connection, and refuses it if it is no viewer's, or if `full`.
  void start(bool full);
  void close();

  void send(std::string text);
  void send_message(int channel, const Message& message);

  // Returns whether a message has been waiting to be taken for longer than a viewer is given.
  bool is_stuck(std::chrono::steady_clock::time_point now) const;

 private:
  struct Frame {
    bool text = false;
    std::string head;
    std::shared_ptr<const std::string> body;
    std::size_t size() const { return head.size() + (body ? body->size() : 0); }
  };

  void take_request(bool full);
  void refuse(boost::beast::http::status status, std::string_view why);
  void read();
  void take_text(std::string_view text);
  void take_call(std::string_view bytes);
  void subscribe(std::uint32_t subscription, int channel);
  void unsubscribe(std::uint32_t subscription);
  void queue_message(std::uint32_t subscription, const Message& message);
  void warn(std::string_view what);
  void queue(Frame frame);
  void write();
  void leave();

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  const Server& server_;
  boost::beast::flat_buffer read_;
  boost::beast::http::request<boost::beast::http::string_body> request_;
  std::map<std::uint32_t, int> subscriptions_;  // channels by the viewer's own numbers
  std::deque<Frame> waiting_;                   // the first is being sent
  std::size_t waiting_bytes_ = 0;
  std::optional<std::chrono::steady_clock::time_point> sending_since_;
  bool open_ = false, told_of_loss_ = false, left_ = false;
};

}  // namespace maploop::dashboard
