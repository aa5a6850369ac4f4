// A page that is connected: requests in, answers out, one at a time.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <string>

#include "live/request.h"
#include "live/session.h"

namespace vantage::live {

/// Lives as long as its connection. All but the computing runs on the thread of the connection's context; the computing
/// runs on `workers`, and is stopped when the page goes away or `is_over`.
class Conversation : public std::enable_shared_from_this<Conversation> {
 public:
  using Upgrade = boost::beast::http::request<boost::beast::http::string_body>;

  Conversation(boost::beast::tcp_stream stream, Session session, boost::asio::thread_pool& workers,
               const std::atomic<bool>& is_over);

  void start(const Upgrade& request);

 private:
  using Error = boost::beast::error_code;

  void read();
  void take(Error error);
  void enqueue(Request request);
  void work();
  void send(std::string message);
  void write();
  void leave() { is_gone_ = true; }

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer incoming_;
  Session session_;
  MapAreas areas_;
  boost::asio::thread_pool& workers_;
  const std::atomic<bool>& is_over_;
  std::atomic<bool> is_gone_ = false;
  bool is_working_ = false;
  std::deque<Request> waiting_;
  std::deque<std::string> outgoing_;
};

}  // namespace vantage::live
