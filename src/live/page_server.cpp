#include "live/page_server.h"

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "live/conversation.h"
#include "live/gate.h"
#include "live/page_text.h"
#include "vantage/error.h"

namespace vantage::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Tcp = asio::ip::tcp;

namespace {

constexpr std::uint32_t kLargestHeader = 8192;
constexpr std::uint64_t kLargestBody = 1024;  // nobody sends one
constexpr auto kMostTime = std::chrono::seconds(20);

/// What callers have in common.
struct House {
  Gate gate;
  Session session;
  std::string page;
  std::string policy;
  asio::thread_pool workers{1};
  std::atomic<bool> is_over = false;
};

/// The page asks nothing of other hosts, and no other page may show it in a frame.
std::string policy_of(std::uint16_t port) {
  const std::string own = "127.0.0.1:" + std::to_string(port);
  return "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
         "connect-src ws://" +
         own + " ws://localhost:" + std::to_string(port) + "; frame-ancestors 'none'; base-uri 'none'";
}

/// One request of a browser: for the page, or to become a conversation.
class Caller : public std::enable_shared_from_this<Caller> {
 public:
  Caller(Tcp::socket socket, House& house) : stream_(std::move(socket)), house_(house) {}

  void start() {
    parser_.header_limit(kLargestHeader);
    parser_.body_limit(kLargestBody);
    stream_.expires_after(kMostTime);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->take();
    });
  }

 private:
  using Request = http::request<http::string_body>;

  static std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

  void take() {
    const Request& request = parser_.get();
    const Gate& gate = house_.gate;
    const std::string_view target = view(request.target());
    if (!gate.is_own_host(view(request[http::field::host]))) {
      return reply(http::status::misdirected_request, "This is not the address of this machine.\n");
    }
    if (beast::websocket::is_upgrade(request)) {
      const bool is_ours = gate.opens(target, "/socket") && gate.is_own_origin(view(request[http::field::origin]));
      if (!is_ours) return reply(http::status::forbidden, "Open the address that the program printed.\n");
      std::make_shared<Conversation>(std::move(stream_), house_.session, house_.workers, house_.is_over)
          ->start(request);
      return;
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return reply(http::status::method_not_allowed, "This page is only read.\n");
    }
    if (!gate.opens(target, "/")) {
      return reply(http::status::forbidden, "Open the whole address that the program printed, with its token.\n");
    }
    reply(http::status::ok, house_.page, "text/html; charset=utf-8");
  }

  void reply(http::status status, const std::string& body, const char* type = "text/plain; charset=utf-8") {
    response_.emplace(status, parser_.get().version());
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    response_->set("Content-Security-Policy", house_.policy);
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");
    response_->keep_alive(false);
    response_->content_length(body.size());
    if (parser_.get().method() != http::verb::head) response_->body() = body;
    http::async_write(stream_, *response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->stream_.socket().shutdown(Tcp::socket::shutdown_send, error);
    });
  }

  beast::tcp_stream stream_;
  House& house_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  std::optional<http::response<http::string_body>> response_;
};

}  // namespace

class PageServer::Listener {
 public:
  Listener(Session session, std::string page, std::uint16_t port)
      : acceptor_(opened(context_, port)),
        house_{.gate = Gate(random_token(), acceptor_.local_endpoint().port()),
               .session = std::move(session),
               .page = {},
               .policy = policy_of(acceptor_.local_endpoint().port())} {
    house_.page =
        with_start(std::move(page), "window.vantageLive={socket:\"/socket?token=" + house_.gate.token() + "\"}");
  }

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  const std::string& token() const { return house_.gate.token(); }

  void run(const std::function<bool()>& is_over) {
    accept();
    watch(is_over);
    context_.run();
    house_.workers.join();
  }

 private:
  static Tcp::acceptor opened(asio::io_context& context, std::uint16_t port) {
    Tcp::acceptor acceptor(context, Tcp::v4());
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
      if (!error) std::make_shared<Caller>(std::move(socket), house_)->start();
      accept();
    });
  }

  void watch(const std::function<bool()>& is_over) {
    timer_.expires_after(std::chrono::milliseconds(100));
    timer_.async_wait([this, &is_over](beast::error_code) {
      if (!is_over()) return watch(is_over);
      house_.is_over = true;
      context_.stop();
    });
  }

  asio::io_context context_{1};
  Tcp::acceptor acceptor_;
  asio::steady_timer timer_{context_};
  House house_;
};

PageServer::PageServer(Session session, std::string page, std::uint16_t port)
    : listener_(std::make_unique<Listener>(std::move(session), std::move(page), port)) {}
PageServer::~PageServer() = default;

std::uint16_t PageServer::port() const { return listener_->port(); }
const std::string& PageServer::token() const { return listener_->token(); }
std::string PageServer::address() const { return "http://127.0.0.1:" + std::to_string(port()) + "/?token=" + token(); }
void PageServer::run(const std::function<bool()>& is_over) { listener_->run(is_over); }

}  // namespace vantage::live
