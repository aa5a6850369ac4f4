// Tilesets over the network.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

#include "tiles/curl_library.h"
#include "tiles/tile_source.h"

namespace vantage::internal::tiles {

/// Whether a text is the address of a tileset on the network.
bool is_http(std::string_view text);

/// A URI without what follows its path, and without a password: keys and sessions are nobody's business.
std::string without_query(std::string_view uri);

/// Files of one server, by HTTP or HTTPS. What the address of a file has as `key` and `session` is passed on to all
/// files that it names and that have none. Nothing is kept on disk. A session that has ended is replaced by the one
/// that the root then gives. After some files in a row without an answer the server is not asked any more.
class HttpSource final : public TileSource {
 public:
  explicit HttpSource(std::string url, const HttpPatience& patience = {});

  std::string root() const override { return root_; }
  std::string resolve(const std::string& base, const std::string& uri) const override;
  std::string read(const std::string& address, const core::ProgressReporter& progress) override;
  std::string shown(const std::string& address) const override { return without_query(address); }
  std::string name(const std::string& address) const override;  ///< from the folder of the root on

 private:
  HttpAnswer ask(const std::string& address, const core::ProgressReporter& progress);
  std::string body_of(HttpAnswer&& answer, const std::string& address, const core::ProgressReporter& progress);
  bool renew_session(const std::string& refused, const core::ProgressReporter& progress);
  std::string with_new_session(const std::string& address) const;
  void check_time(const std::string& address) const;
  [[noreturn]] void close(const std::string& problem, const std::string& address, const std::string& fix) const;

  std::string root_;
  HttpPatience patience_;
  HttpClient client_;
  std::map<std::string, std::string> renewed_;  // sessions that have ended: the ones that followed
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t read_ = 0, read_in_session_ = 0;  // files
  int failures_ = 0;                            // files in a row
};

}  // namespace vantage::internal::tiles
