#include "tools/dashboard/foxglove_server.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/dashboard/foxglove_viewer.h"
#include "tools/dashboard/json_text.h"

namespace maploop::dashboard {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::milliseconds check_every{500};

nlohmann::json described(int id, const FoxgloveServer::Channel& channel) {
  return {{"id", id},
          {"topic", channel.topic},
          {"encoding", "json"},
          {"schemaName", channel.schema_name},
          {"schemaEncoding", "jsonschema"},
          {"schema", channel.schema}};
}

std::string advertisement(nlohmann::json channels) {
  return json_text({{"op", "advertise"}, {"channels", std::move(channels)}});
}

}  // namespace

// The channels are read on every thread; all else belongs to the thread of `io`.
struct FoxgloveServer::Implementation {
  Implementation(std::vector<std::string> allowed, Control control)
      : origins(std::move(allowed)),
        server{.allows =
                   [this](const std::string& origin) {
                     return std::find(origins.begin(), origins.end(), origin) != origins.end();
                   },
               .channels = [this] { return all_channels(); },
               .has =
                   [this](int channel) {
                     const std::lock_guard lock(mutex);
                     return channel >= 0 && static_cast<std::size_t>(channel) < channels.size();
                   },
               .subscribed =
                   [this](int channel, int change) {
                     const std::lock_guard lock(mutex);
                     subscribers.at(static_cast<std::size_t>(channel)) += change;
                   },
               .kept = [this](int channel) { return kept[channel]; },
               .control = std::move(control),
               .lost = [this] { ++lost; },
               .left = [this](const auto& viewer) { std::erase(viewers, viewer); }} {}

  std::string all_channels() {
    const std::lock_guard lock(mutex);
    nlohmann::json all = nlohmann::json::array();
    for (std::size_t i = 0; i < channels.size(); ++i)
      all.push_back(described(static_cast<int>(i), channels[i]));
    return advertisement(std::move(all));
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!error) {
        const bool full = viewers.size() >= most_viewers;
        viewers.push_back(std::make_shared<FoxgloveViewer>(std::move(socket), server));
        viewers.back()->start(full);
      }
      accept();
    });
  }

  void watch() {
    timer.expires_after(check_every);
    timer.async_wait([this](error_code error) {
      if (error) return;
      const auto now = std::chrono::steady_clock::now();
      for (const auto& viewer : viewers)
        if (viewer->is_stuck(now)) viewer->close();
      watch();
    });
  }

  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
  std::vector<std::string> origins;
  FoxgloveViewer::Server server;
  std::vector<std::shared_ptr<FoxgloveViewer>> viewers;
  std::map<int, std::vector<FoxgloveViewer::Message>> kept;  // by channel
  std::mutex mutex;
  std::deque<Channel> channels;
  std::deque<int> subscribers;  // of each channel
  std::atomic<std::uint64_t> lost{0};
  int port = 0;
  std::thread thread;
};

FoxgloveServer::FoxgloveServer(const std::string& address, int port,
                               std::vector<std::string> origins, Control control)
    : implementation_(std::make_unique<Implementation>(std::move(origins), std::move(control))) {
  Implementation& i = *implementation_;
  try {
    const tcp::endpoint endpoint(asio::ip::make_address(address),
                                 static_cast<unsigned short>(port));
    i.acceptor.open(endpoint.protocol());
    i.acceptor.set_option(tcp::acceptor::reuse_address(true));
    i.acceptor.bind(endpoint);
    i.acceptor.listen();
    i.port = i.acceptor.local_endpoint().port();
  } catch (const boost::system::system_error& e) {
    throw std::runtime_error("cannot listen for Foxglove at " + address + ":" +
                             std::to_string(port) + " (" + e.code().message() +
                             "): is another dashboard there (--foxglove 0 takes a free port), and "
                             "is the address this machine's?");
  }
  i.accept();
  i.watch();
  i.thread = std::thread([&i] { i.io.run(); });
}

FoxgloveServer::~FoxgloveServer() {
  Implementation& i = *implementation_;
  asio::post(i.io, [&i] {
    i.acceptor.close();
    i.timer.cancel();
    for (const auto& viewer : std::vector(i.viewers)) viewer->close();
  });
  i.thread.join();
}

int FoxgloveServer::port() const {
  return implementation_->port;
}

int FoxgloveServer::add(Channel channel) {
  Implementation& i = *implementation_;
  int id = 0;
  nlohmann::json one = nlohmann::json::array();
  {
    const std::lock_guard lock(i.mutex);
    id = static_cast<int>(i.channels.size());
    one.push_back(described(id, channel));
    i.channels.push_back(std::move(channel));
    i.subscribers.push_back(0);
  }
  asio::post(i.io, [&i, said = advertisement(std::move(one))] {
    for (const auto& viewer : i.viewers) viewer->send(said);
  });
  return id;
}

bool FoxgloveServer::wanted(int channel) const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->subscribers.at(static_cast<std::size_t>(channel)) > 0;
}

void FoxgloveServer::publish(int channel, std::int64_t nanoseconds, std::string json, bool keep) {
  Implementation& i = *implementation_;
  FoxgloveViewer::Message message{nanoseconds,
                                  std::make_shared<const std::string>(std::move(json))};
  asio::post(i.io, [&i, channel, keep, message = std::move(message)] {
    auto& kept = i.kept[channel];
    if (!kept.empty() && kept.back().nanoseconds != message.nanoseconds) kept.clear();
    if (keep) kept.push_back(message);
    for (const auto& viewer : i.viewers) viewer->send_message(channel, message);
  });
}

void FoxgloveServer::forget(int channel) {
  Implementation& i = *implementation_;
  asio::post(i.io, [&i, channel] { i.kept.erase(channel); });
}

std::uint64_t FoxgloveServer::lost() const {
  return implementation_->lost;
}

}  // namespace maploop::dashboard
