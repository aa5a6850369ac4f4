// Tilesets over the network.
#pragma once

#include <string>
#include <string_view>

#include "tiles/curl_library.h"
#include "tiles/tile_source.h"

namespace vantage::internal::tiles {

/// Whether a text is the address of a tileset on the network.
bool is_http(std::string_view text);

/// An address without what follows its path: keys and sessions are nobody's business.
std::string without_query(std::string_view url);

/// Files of one server, by HTTP or HTTPS. What the address of a file has as `key` and `session` is passed on to all
/// files that it names and that have none. Nothing is kept on disk.
class HttpSource final : public TileSource {
 public:
  explicit HttpSource(std::string url);

  std::string root() const override { return root_; }
  std::string resolve(const std::string& base, const std::string& uri) const override;
  std::string read(const std::string& address, const core::ProgressReporter& progress) override;
  std::string shown(const std::string& address) const override { return without_query(address); }
  std::string name(const std::string& address) const override;  ///< from the folder of the root on

 private:
  std::string root_;
  HttpClient client_;
};

}  // namespace vantage::internal::tiles
