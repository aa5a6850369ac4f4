// A page that is connected: requests in, answers out, one at a time.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "live/request.h"
#include "live/session.h"

namespace vantage::live {

class WebSocketConnection;

/// What WebSockets have in common. Each has a thread of its own while it works, so that what is quick in one waits for
/// none of the others. What may take all cores and gigabytes does wait: a few are computed at a time, in the order of
/// their requests, and a page that waits is told so.
struct WorkerPool {
  static constexpr int kMostConnections = 16;
  static constexpr int kMostComputing = 4;  ///< volumes, proofs and searches of a map

  boost::asio::thread_pool workers{kMostConnections};
  int threads = 0;  ///< that a computation may use; 0: all
  std::atomic<bool> is_over = false;
  std::function<void(const std::string& call)> before_work = {};  ///< for tests: on the thread that does the work

  // On the thread of the connections' context alone.
  int computing = 0;
  std::deque<std::weak_ptr<WebSocketConnection>> queue;  ///< those that wait to compute

  /// To be called when something was computed: those that wait go on.
  void resume_waiting();
};

/// Lives as long as its connection. All but the computing runs on the thread of the connection's context; the computing
/// runs on the pool's, and is stopped when the page says so, when it goes away or all `is_over`. Of a page that asks
/// faster than it is answered, or that does not take its answers, no more is read until it has caught up.
class WebSocketConnection : public std::enable_shared_from_this<WebSocketConnection> {
 public:
  using Upgrade = boost::beast::http::request<boost::beast::http::string_body>;

  /// `original`: what its session is forked from, by the worker, once something is asked; outlives it. `slot`: kept for
  /// as long as it lives; the server counts them.
  WebSocketConnection(boost::beast::tcp_stream stream, const Session& original, WorkerPool& pool,
                      std::shared_ptr<const void> slot);

  void start(const Upgrade& request);

  /// To be called when it waited to compute, and may now.
  void resume();

 private:
  using Error = boost::beast::error_code;

  void read();
  void take(Error error);
  void enqueue(Request request);
  void stop(const Request& request);
  void drop_waiting_volumes(std::string (*answer_to)(const Request&));
  void work();
  bool may_work(const Request& request);
  void end_work(std::string message, bool was_heavy);
  void send(std::string message);
  void write();
  bool is_behind() const;
  void catch_up();
  void leave();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer incoming_;
  const Session& original_;
  std::optional<Session> session_;  ///< of the worker, as are the areas
  MapAreas areas_;
  WorkerPool& pool_;
  std::shared_ptr<const void> slot_;
  std::atomic<bool> is_gone_ = false;
  std::atomic<bool> is_stopped_ = false;  ///< what is computed now
  bool is_working_ = false;
  bool is_queued_ = false;                 ///< in the pool's queue
  std::optional<std::uint64_t> notified_;  ///< the request that was told that it waits
  bool is_paused_ = false;
  std::deque<Request> waiting_;
  std::deque<std::string> outgoing_;
  std::size_t outgoing_bytes_ = 0;
};

}  // namespace vantage::live
