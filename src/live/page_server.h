// Serves the page on 127.0.0.1, and answers it over a WebSocket (RFC 6455): docs/view.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "live/session.h"

namespace vantage::live {

/// Accepts connections from this machine alone. Who knows the token, which is new each time, may see the page and ask
/// its session; each page has a copy of the session, and what is quick waits for no other page. However many
/// connections there are without the token, one with it is accepted.
class PageServer {
 public:
  /// `port`: 0 takes one that is free. Who connects before it runs waits. Throws Error(input) for a port that is used.
  explicit PageServer(std::uint16_t port);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  std::string address() const;  ///< "http://127.0.0.1:PORT/?token=..."

  /// For tests, before run(): `before` is called with the name of each call, by the thread that then works on it.
  void set_before_work(std::function<void(const std::string& call)> before);

  /// Until `is_over`, which is asked ten times a second, says so. What is being computed then is stopped. `page`: text
  /// of web/dist/index.html. `threads`: that a computation may use; 0: all. Throws Error(page_missing) for another
  /// page.
  void run(Session session, std::string page, int threads, const std::function<bool()>& is_over);

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace vantage::live
