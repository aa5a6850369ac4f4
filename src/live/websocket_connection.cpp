#include "live/websocket_connection.h"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <string_view>
#include <utility>

#include "vantage/progress.h"

namespace vantage::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

namespace {

constexpr std::size_t kLargestMessage = std::size_t{4} << 20;  // a mission file has 1 MiB at most
constexpr std::size_t kMostWaiting = 64;
constexpr std::size_t kMostOutgoing = std::size_t{16} << 20;
// Between two of them the connection can be asked whether it still stands: a large answer may take any time.
constexpr std::size_t kFragment = std::size_t{1} << 20;

/// May take all cores, and gigabytes.
bool is_heavy(const Request& request) {
  static constexpr std::array<std::string_view, 6> kHeavy = {"compute", "read", "flight", "volumes", "prove", "area"};
  return std::find(kHeavy.begin(), kHeavy.end(), request.call) != kHeavy.end();
}

}  // namespace

void WorkerPool::resume_waiting() {
  while (computing < kMostComputing && !queue.empty()) {
    const std::shared_ptr<WebSocketConnection> next = queue.front().lock();
    queue.pop_front();
    if (next) next->resume();
  }
}

WebSocketConnection::WebSocketConnection(beast::tcp_stream stream, const Session& original, WorkerPool& pool,
                                         std::shared_ptr<const void> slot)
    : socket_(std::move(stream)), original_(original), pool_(pool), slot_(std::move(slot)) {}

void WebSocketConnection::start(const Upgrade& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the socket has its own limits of time
  auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeout.keep_alive_pings = true;  // a page that is only looked at asks nothing
  socket_.set_option(timeout);
  socket_.read_message_max(kLargestMessage);
  socket_.binary(true);
  socket_.auto_fragment(true);
  socket_.write_buffer_bytes(kFragment);
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  socket_.async_accept(request, [self = shared_from_this()](Error error) {
    if (!error) self->read();
  });
}

void WebSocketConnection::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](Error error, std::size_t) { self->take(error); });
}

void WebSocketConnection::take(Error error) {
  if (error) return leave();
  const std::string text = beast::buffers_to_string(incoming_.data());
  incoming_.consume(incoming_.size());
  try {
    enqueue(parse_request(text));
  } catch (const std::exception&) {
    // Not our page, or no room for what it asks: nothing can be answered, since nothing says to what.
    leave();
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](Error) {});
    return;
  }
  is_paused_ = is_behind();
  if (!is_paused_) read();
}

/// A single answer does not count, however large: while it is sent, what is read shows that the page is still there.
bool WebSocketConnection::is_behind() const {
  return waiting_.size() >= kMostWaiting || (outgoing_.size() > 1 && outgoing_bytes_ > kMostOutgoing);
}

void WebSocketConnection::catch_up() {
  if (!is_paused_ || is_gone_ || is_behind()) return;
  is_paused_ = false;
  read();
}

void WebSocketConnection::leave() {
  is_gone_ = true;
  waiting_.clear();
}

void WebSocketConnection::drop_waiting_volumes(std::string (*answer_to)(const Request&)) {
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    if (at->call != "compute") {
      ++at;
      continue;
    }
    send(answer_to(*at));
    at = waiting_.erase(at);
  }
}

void WebSocketConnection::enqueue(Request request) {
  if (request.call == "stop") return stop(request);
  if (request.call == "compute") drop_waiting_volumes(stale_answer);
  waiting_.push_back(std::move(request));
  work();
}

/// Does not wait for its turn. What is computed answers as soon as it notices.
void WebSocketConnection::stop(const Request& request) {
  drop_waiting_volumes(cancelled_answer);
  if (!is_working_ && !waiting_.empty()) {  // a proof whose turn it is, while others compute
    send(cancelled_answer(waiting_.front()));
    waiting_.pop_front();
  }
  is_stopped_ = is_working_;
  send(stopped_answer(request));
  work();
}

/// Else it is called again once it may.
bool WebSocketConnection::may_work(const Request& request) {
  if (!is_heavy(request) || pool_.computing < WorkerPool::kMostComputing) return true;
  if (!is_queued_) pool_.queue.push_back(weak_from_this());
  is_queued_ = true;
  if (notified_ != request.id) send(waiting_notice(request, true));
  notified_ = request.id;
  return false;
}

void WebSocketConnection::resume() {
  is_queued_ = false;
  work();
}

void WebSocketConnection::work() {
  if (is_working_ || waiting_.empty() || !may_work(waiting_.front())) return;
  if (notified_ == waiting_.front().id) send(waiting_notice(waiting_.front(), false));
  notified_.reset();
  is_working_ = true;
  is_stopped_ = false;
  const bool heavy = is_heavy(waiting_.front());
  if (heavy) ++pool_.computing;
  asio::post(pool_.workers, [self = shared_from_this(), request = std::move(waiting_.front()), heavy]() mutable {
    WorkerPool& pool = self->pool_;
    const auto is_wanted = [&] { return !self->is_gone_ && !pool.is_over; };
    const auto goes_on = [&] { return is_wanted() && !self->is_stopped_; };
    std::string message;
    if (pool.before_work) pool.before_work(request.call);
    if (is_wanted()) {
      if (!self->session_) self->session_.emplace(self->original_.fork());
      with_threads(pool.threads, [&] {
        message = answer(*self->session_, self->areas_, request, [&](std::string_view, double) { return goes_on(); });
      });
    }
    const auto executor = self->socket_.get_executor();
    // Moved, so that the last one to hold it is never this thread.
    asio::post(executor, [self = std::move(self), message = std::move(message), heavy]() mutable {
      self->end_work(std::move(message), heavy);
    });
  });
  waiting_.pop_front();
}

void WebSocketConnection::end_work(std::string message, bool was_heavy) {
  is_working_ = false;
  send(std::move(message));
  if (was_heavy) {
    --pool_.computing;
    pool_.resume_waiting();  // those that wait first
  }
  work();
  catch_up();
}

void WebSocketConnection::send(std::string message) {
  if (is_gone_) return;
  outgoing_bytes_ += message.size();
  outgoing_.push_back(std::move(message));
  if (outgoing_.size() == 1) write();
}

void WebSocketConnection::write() {
  socket_.async_write(asio::buffer(outgoing_.front()), [self = shared_from_this()](Error error, std::size_t) {
    if (error) return self->leave();
    self->outgoing_bytes_ -= self->outgoing_.front().size();
    self->outgoing_.pop_front();
    if (!self->outgoing_.empty()) self->write();
    self->catch_up();
  });
}

}  // namespace vantage::live
