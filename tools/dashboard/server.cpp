#include "tools/dashboard/server.h"

#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/dashboard/json_text.h"
#include "tools/web/bundle.h"

namespace maploop::dashboard {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t threads = Server::most_browsers + 8;  // each browser occupies one
constexpr milliseconds look_every{100};
constexpr milliseconds sign_of_life{1000};

std::string page() {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>maploop</title>\n<style>" +
         std::string(web::dashboard_style()) + "</style></head><body>\n<script>" +
         std::string(web::dashboard_script()) + "</script>\n</body></html>\n";
}

// Removes the port: "[::1]" for "[::1]:8080".
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':'), bracket = host.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return has_port ? host.substr(0, colon) : host;
}

bool is_numeric(std::string_view host) {
  return host.starts_with('[') || host.find_first_not_of("0123456789.") == std::string_view::npos;
}

// A page of another site may send requests here from a browser on this machine. Its Origin differs;
// or, if its own name was made to resolve to this machine, its Host is not one that we listen at.
// The port is not compared, so that a tunnel to the dashboard works.
bool from_elsewhere(const httplib::Request& request, const std::string& listens_at) {
  const std::string with_port = request.get_header_value("Host");
  const std::string_view host = without_port(with_port);
  const bool at_any = listens_at == "0.0.0.0" || listens_at == "::";
  const bool ours = host == "localhost" || host == "127.0.0.1" || host == "[::1]" ||
                    host == listens_at || host == "[" + listens_at + "]" ||
                    (at_any && !host.empty() && is_numeric(host));
  const std::string origin = request.get_header_value("Origin");
  return !ours || (!origin.empty() && origin != "http://" + with_port);
}

// Sets the options without httplib's SO_REUSEPORT, by which two dashboards would share a port and
// its requests.
void own_port(int socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(json_text({{"refused", why}}), "application/json");
}

}  // namespace

struct Server::Http {
  Http(std::string address, LiveChannels& all, Handlers to)
      : listens_at(std::move(address)), channels(all), handlers(std::move(to)) {}

  void add_routes();
  void stream(const std::string& run, httplib::Response& response);
  void control(const httplib::Request& request, httplib::Response& response) const;
  void roads(const httplib::Request& request, httplib::Response& response) const;

  std::string listens_at;
  LiveChannels& channels;
  Handlers handlers;
  httplib::Server server;
  std::atomic<int> browsers{0};
  std::atomic<bool> ended{false};
  std::thread thread;
};

void Server::Http::stream(const std::string& run, httplib::Response& response) {
  if (++browsers > most_browsers) {
    --browsers;
    refuse(response, 503,
           "there are " + std::to_string(most_browsers) +
               " browsers already: close one, or start another maploop dashboard with --port 0");
    return;
  }
  response.set_header("Cache-Control", "no-store");
  auto seen = std::make_shared<std::uint64_t>(0);
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, run, seen](std::size_t, httplib::DataSink& sink) {
        std::string text;
        for (const LiveChannels::Message& m : channels.newer(run, *seen, sign_of_life)) {
          text += "data: {\"channel\":\"" + m.channel + "\",\"message\":" + m.json + "}\n\n";
        }
        if (channels.closed()) return false;
        if (text.empty()) text = ": still here\n\n";  // detects a closed connection
        if (!sink.write(text.data(), text.size())) return false;
        std::this_thread::sleep_for(look_every);
        return true;
      },
      [this](bool) { --browsers; });
}

void Server::Http::control(const httplib::Request& request, httplib::Response& response) const {
  const auto command = nlohmann::json::parse(request.body, nullptr, false);
  const auto has_text = [&](const char* key) {
    return command.contains(key) && command[key].is_string();
  };
  if (!command.is_object() || !has_text("run") || !has_text("kind")) {
    return refuse(response, 400, "not {\"run\": ..., \"kind\": ..., \"value\": ...}");
  }
  const auto value = command.find("value");
  const bool number = value != command.end() && value->is_number();
  const std::string why =
      handlers.control(command["run"].get<std::string>(), command["kind"].get<std::string>(),
                       number ? value->get<double>() : 0.0);
  if (!why.empty()) return refuse(response, 400, why);
  response.set_content("{}", "application/json");
}

void Server::Http::roads(const httplib::Request& request, httplib::Response& response) const {
  Geodetic origin;
  try {
    origin.latitude = std::stod(request.get_param_value("latitude"));
    origin.longitude = std::stod(request.get_param_value("longitude"));
    origin.height = std::stod(request.get_param_value("height"));
  } catch (const std::logic_error&) {
    return refuse(response, 400, "not latitude=RAD&longitude=RAD&height=M");
  }
  const bool on_earth = std::abs(origin.latitude) <= 1.6 && std::abs(origin.longitude) <= 6.3 &&
                        std::abs(origin.height) <= 1e5;
  if (!on_earth) return refuse(response, 400, "no place on the earth");
  response.set_content(handlers.roads(origin), "application/json");
}

void Server::Http::add_routes() {
  server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
  server.set_payload_max_length(4096);
  server.set_socket_options(own_port);
  server.set_write_timeout(patience);
  server.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        if (!from_elsewhere(request, listens_at))
          return httplib::Server::HandlerResponse::Unhandled;
        refuse(response, 403,
               "this dashboard is at localhost and " + listens_at +
                   " (--address), and answers neither other names nor pages from elsewhere");
        return httplib::Server::HandlerResponse::Handled;
      });
  server.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(page(), "text/html; charset=utf-8");
  });
  server.Get("/trail", [this](const httplib::Request& request, httplib::Response& response) {
    response.set_content(handlers.trail(request.get_param_value("run")), "application/json");
  });
  server.Get("/roads", [this](const httplib::Request& request, httplib::Response& response) {
    roads(request, response);
  });
  server.Get("/events", [this](const httplib::Request& request, httplib::Response& response) {
    stream(request.get_param_value("run"), response);
  });
  server.Post("/control", [this](const httplib::Request& request, httplib::Response& response) {
    control(request, response);
  });
}

Server::Server(const std::string& address, int port, LiveChannels& channels, Handlers handlers)
    : http_(std::make_unique<Http>(address, channels, std::move(handlers))) {
  http_->add_routes();
  port_ = port == 0 ? http_->server.bind_to_any_port(address)
                    : (http_->server.bind_to_port(address, port) ? port : -1);
  if (port_ < 0) {
    throw std::runtime_error("cannot listen at " + address + ":" + std::to_string(port) +
                             ": is another dashboard there (--port 0 takes a free one), and is the "
                             "address this machine's?");
  }
  http_->thread = std::thread([http = http_.get()] {
    http->server.listen_after_bind();
    http->ended = true;
  });
  // Before the server runs, it would ignore stop().
  while (!http_->server.is_running() && !http_->ended) std::this_thread::sleep_for(milliseconds(1));
}

Server::~Server() {
  http_->channels.close();
  http_->server.stop();
  http_->thread.join();
}

}  // namespace maploop::dashboard
