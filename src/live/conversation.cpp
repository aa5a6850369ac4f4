#include "live/conversation.h"

#include <boost/asio/post.hpp>
#include <utility>

#include "vantage/error.h"

namespace vantage::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

namespace {

constexpr std::size_t kLargestMessage = std::size_t{4} << 20;  // a mission file has 1 MiB at most
constexpr std::size_t kMostWaiting = 64;

}  // namespace

Conversation::Conversation(beast::tcp_stream stream, Session session, asio::thread_pool& workers,
                           const std::atomic<bool>& is_over)
    : socket_(std::move(stream)), session_(std::move(session)), workers_(workers), is_over_(is_over) {}

void Conversation::start(const Upgrade& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the socket has its own limits of time
  socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  socket_.read_message_max(kLargestMessage);
  socket_.binary(true);
  socket_.auto_fragment(false);
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  socket_.async_accept(request, [self = shared_from_this()](Error error) {
    if (!error) self->read();
  });
}

void Conversation::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](Error error, std::size_t) { self->take(error); });
}

void Conversation::take(Error error) {
  if (error) return leave();
  const std::string text = beast::buffers_to_string(incoming_.data());
  incoming_.consume(incoming_.size());
  try {
    enqueue(parse_request(text));
  } catch (const vantage::Error&) {
    // Not our page: nothing can be answered, since nothing says to what.
    leave();
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](Error) {});
    return;
  }
  read();
}

void Conversation::enqueue(Request request) {
  if (request.call == "compute") {
    for (auto at = waiting_.begin(); at != waiting_.end();) {
      if (at->call != "compute") {
        ++at;
        continue;
      }
      send(stale_answer(*at));
      at = waiting_.erase(at);
    }
  }
  if (waiting_.size() < kMostWaiting) {
    waiting_.push_back(std::move(request));
  } else {
    send(stale_answer(request));
  }
  work();
}

void Conversation::work() {
  if (is_working_ || waiting_.empty()) return;
  is_working_ = true;
  asio::post(workers_, [self = shared_from_this(), request = std::move(waiting_.front())] {
    const Progress progress = [&](std::string_view, double) { return !self->is_gone_ && !self->is_over_; };
    std::string message = answer(self->session_, self->areas_, request, progress);
    asio::post(self->socket_.get_executor(), [self, message = std::move(message)]() mutable {
      self->is_working_ = false;
      self->send(std::move(message));
      self->work();
    });
  });
  waiting_.pop_front();
}

void Conversation::send(std::string message) {
  if (is_gone_) return;
  outgoing_.push_back(std::move(message));
  if (outgoing_.size() == 1) write();
}

void Conversation::write() {
  socket_.async_write(asio::buffer(outgoing_.front()), [self = shared_from_this()](Error error, std::size_t) {
    if (error) return self->leave();
    self->outgoing_.pop_front();
    if (!self->outgoing_.empty()) self->write();
  });
}

}  // namespace vantage::live
