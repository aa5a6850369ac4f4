#include "live/page_server.h"

#include <fcntl.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "live/access_control.h"
#include "live/page_text.h"
#include "live/websocket_connection.h"
#include "vantage/error.h"

namespace vantage::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Tcp = asio::ip::tcp;

namespace {

constexpr std::uint32_t kLargestHeader = 8192;
constexpr std::uint64_t kLargestBody = 1024;           // nobody sends one
constexpr auto kMostTime = std::chrono::seconds(10);   // for a request
constexpr auto kMostStill = std::chrono::seconds(30);  // an answer may take any time, if only some of it moves on
constexpr std::size_t kMostUnauthenticated = 100;

class HttpConnection;

/// Connections that have not sent the token. Where there are too many, the oldest one is closed: a new one is always
/// accepted, and a browser sends its request at once.
class UnauthenticatedConnections {
 public:
  void add(const std::shared_ptr<HttpConnection>& connection);
  void remove(const HttpConnection* connection);

 private:
  std::deque<std::pair<const HttpConnection*, std::weak_ptr<HttpConnection>>> connections_;  // closed ones are removed
};

/// What connections have in common.
struct ServerState {
  AccessControl access{random_token()};
  Session session;
  std::string page;
  WorkerPool pool;
  UnauthenticatedConnections unauthenticated;
  std::shared_ptr<const int> slots = std::make_shared<int>();  // a copy for each WebSocket
};

/// The page asks nothing of other hosts, and no other page may show it in a frame. `host`: one of this machine's names.
std::string policy_of(std::string_view host) {
  return "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
         "connect-src ws://" +
         std::string(host) + "; frame-ancestors 'none'; base-uri 'none'";
}

/// One request of a browser: for the page, or for a WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Tcp::socket socket, ServerState& state) : stream_(std::move(socket)), state_(state) {}
  ~HttpConnection() { state_.unauthenticated.remove(this); }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  /// Whatever it waits for fails.
  void close() { stream_.close(); }

  void start() {
    parser_.header_limit(kLargestHeader);
    parser_.body_limit(kLargestBody);
    stream_.expires_after(kMostTime);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) return self->take();
      const bool is_malformed = error.category() == http::make_error_code(http::error::bad_method).category();
      if (is_malformed && error != http::error::end_of_stream) {
        self->reply(http::status::bad_request, "This is not a request that a browser makes.\n");
      }
    });
  }

 private:
  using Request = http::request<http::string_body>;
  using Response = http::response<http::span_body<const char>>;

  static std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

  void take() {
    const Request& request = parser_.get();
    const AccessControl& access = state_.access;
    const std::string_view target = view(request.target());
    const std::string_view host = view(request[http::field::host]);
    if (!AccessControl::is_own_host(host)) {
      return reply(http::status::misdirected_request, "Open http://127.0.0.1 with the port, or http://localhost.\n");
    }
    if (beast::websocket::is_upgrade(request)) {
      const bool is_ours =
          access.allows(target, "/socket") && AccessControl::is_own_origin(view(request[http::field::origin]), host);
      if (!is_ours) return reply(http::status::forbidden, "Open the address that the program printed.\n");
      if (buffer_.size() > 0) {  // RFC 6455, 4.1: nothing may be sent before the answer
        return reply(http::status::bad_request, "Wait for the answer before the first message.\n");
      }
      state_.unauthenticated.remove(this);
      if (state_.slots.use_count() > WorkerPool::kMostConnections) {
        return reply(http::status::service_unavailable, "The program talks to " +
                                                            std::to_string(WorkerPool::kMostConnections) +
                                                            " windows already: close one of them.\n");
      }
      std::make_shared<WebSocketConnection>(std::move(stream_), state_.session, state_.pool, state_.slots)
          ->start(request);
      return;
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return reply(http::status::method_not_allowed, "This page is only read.\n");
    }
    if (!access.allows(target, "/")) {
      return reply(http::status::forbidden, "Open the whole address that the program printed, with its token.\n");
    }
    state_.unauthenticated.remove(this);
    send(http::status::ok, state_.page, "text/html; charset=utf-8");
  }

  void reply(http::status status, std::string words) {
    words_ = std::move(words);
    send(status, words_, "text/plain; charset=utf-8");
  }

  /// `body` outlives it.
  void send(http::status status, std::string_view body, const char* type) {
    response_.emplace(status, parser_.get().version());
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    const std::string_view host = view(parser_.get()[http::field::host]);
    response_->set("Content-Security-Policy", policy_of(AccessControl::is_own_host(host) ? host : "127.0.0.1"));
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");
    response_->keep_alive(false);
    response_->content_length(body.size());
    if (parser_.get().method() != http::verb::head) response_->body() = {body.data(), body.size()};
    serializer_.emplace(*response_);
    write();
  }

  void write() {
    stream_.expires_after(kMostStill);
    const auto go_on = [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return;
      if (!self->serializer_->is_done()) return self->write();
      self->stream_.socket().shutdown(Tcp::socket::shutdown_send, error);
    };
    http::async_write_some(stream_, *serializer_, go_on);
  }

  beast::tcp_stream stream_;
  ServerState& state_;
  beast::flat_buffer buffer_;
  std::string words_;
  http::request_parser<http::string_body> parser_;
  std::optional<Response> response_;
  std::optional<http::response_serializer<http::span_body<const char>>> serializer_;
};

void UnauthenticatedConnections::add(const std::shared_ptr<HttpConnection>& connection) {
  if (connections_.size() >= kMostUnauthenticated) {
    const std::shared_ptr<HttpConnection> longest = connections_.front().second.lock();
    connections_.pop_front();  // first: one that ends here removes itself
    if (longest) longest->close();
  }
  connections_.emplace_back(connection.get(), connection);
}

void UnauthenticatedConnections::remove(const HttpConnection* connection) {
  std::erase_if(connections_, [&](const auto& known) { return known.first == connection; });
}

}  // namespace

class PageServer::Listener {
 public:
  explicit Listener(std::uint16_t port) : acceptor_(opened(context_, port)) {}

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  const std::string& token() const { return state_.access.token(); }

  void set_before_work(std::function<void(const std::string&)> before) { state_.pool.before_work = std::move(before); }

  void run(Session session, std::string page, int threads, const std::function<bool()>& is_over) {
    state_.session = std::move(session);
    state_.page =
        with_start(std::move(page), "window.vantageLive={socket:\"/socket?token=" + state_.access.token() + "\"}");
    state_.pool.threads = threads;
    accept();
    watch(is_over);
    context_.run();
    state_.pool.workers.stop();
    state_.pool.workers.join();
  }

 private:
  static Tcp::acceptor opened(asio::io_context& context, std::uint16_t port) {
    Tcp::acceptor acceptor(context, Tcp::v4());
    ::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);  // a browser that is started may live longer
    beast::error_code error;
    acceptor.set_option(asio::socket_base::reuse_address(true), error);
    acceptor.bind({asio::ip::address_v4::loopback(), port}, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      throw Error(ErrorCode::port_unavailable,
                  "port " + std::to_string(port) + " cannot be listened on: " + error.message(), "",
                  "choose another one with --port, or leave it out to get one that is free");
    }
    return acceptor;
  }

  void accept() {
    acceptor_.async_accept([this](beast::error_code error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later();  // no descriptor is left
      const auto connection = std::make_shared<HttpConnection>(std::move(socket), state_);
      state_.unauthenticated.add(connection);
      connection->start();
      accept();
    });
  }

  void accept_later() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }

  void watch(const std::function<bool()>& is_over) {
    timer_.expires_after(std::chrono::milliseconds(100));
    timer_.async_wait([this, &is_over](beast::error_code) {
      if (!is_over()) return watch(is_over);
      state_.pool.is_over = true;
      context_.stop();
    });
  }

  ServerState state_;  // first: connections that wait belong to the context, and are destroyed with it
  asio::io_context context_{1};
  Tcp::acceptor acceptor_;
  asio::steady_timer timer_{context_}, pause_{context_};
};

PageServer::PageServer(std::uint16_t port) : listener_(std::make_unique<Listener>(port)) {}
PageServer::~PageServer() = default;

std::uint16_t PageServer::port() const { return listener_->port(); }
const std::string& PageServer::token() const { return listener_->token(); }
std::string PageServer::address() const { return "http://127.0.0.1:" + std::to_string(port()) + "/?token=" + token(); }
void PageServer::set_before_work(std::function<void(const std::string&)> before) {
  listener_->set_before_work(std::move(before));
}
void PageServer::run(Session session, std::string page, int threads, const std::function<bool()>& is_over) {
  listener_->run(std::move(session), std::move(page), threads, is_over);
}

}  // namespace vantage::live
