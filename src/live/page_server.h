// Serves the page on 127.0.0.1, and answers it over a WebSocket (RFC 6455): docs/view.md.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "live/session.h"

namespace vantage::live {

/// Takes callers from this machine alone. Who knows the token, which is new each time, may see the page and ask its
/// session; each page has a copy of the session, and they are answered one at a time.
class PageServer {
 public:
  /// `page`: text of web/dist/index.html. `port`: 0 takes one that is free. Throws Error(input) for a port that is
  /// used.
  PageServer(Session session, std::string page, std::uint16_t port);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  std::string address() const;  ///< "http://127.0.0.1:PORT/?token=..."

  /// Until `is_over`, which is asked ten times a second, says so. What is being computed then is stopped.
  void run(const std::function<bool()>& is_over);

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace vantage::live
