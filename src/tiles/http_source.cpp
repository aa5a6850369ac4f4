#include "tiles/http_source.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include "common/input.h"
#include "io/mesh_source.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

// One file. Tiles have some megabytes.
constexpr std::size_t kMostBytes = std::size_t{1} << 30U;
constexpr int kTries = 3;  ///< of a file that a server does not send at once

/// The parts of "https://host:port/path?query".
struct Url {
  std::string origin;  ///< "https://host:port"
  std::string path;    ///< from its slash on
  std::string query;   ///< without its mark
};

Url split_url(std::string_view text) {
  text = text.substr(0, text.find('#'));
  const std::size_t host = text.find("://") + 3;
  const std::size_t end = std::min(text.find_first_of("/?", host), text.size());
  const std::size_t mark = std::min(text.find('?', end), text.size());
  Url url{std::string(text.substr(0, end)), std::string(text.substr(end, mark - end)), ""};
  if (url.path.empty()) url.path = "/";
  if (mark < text.size()) url.query = text.substr(mark + 1);
  return url;
}

/// "key=..." of a query; empty where it has none.
std::string parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view one = query.substr(0, query.find('&'));
    if (one.starts_with(name) && one.size() > name.size() && one[name.size()] == '=') return std::string(one);
    query.remove_prefix(std::min(one.size() + 1, query.size()));
  }
  return {};
}

/// "/a/b/../c" is "/a/c" (RFC 3986, section 5.2.4).
std::string without_dots(const std::string& path) {
  std::string result = std::filesystem::path(path).lexically_normal().generic_string();
  while (result.starts_with("/../")) result.erase(0, 3);
  return result;
}

}  // namespace

bool is_http(std::string_view text) { return text.starts_with("http://") || text.starts_with("https://"); }

std::string without_query(std::string_view url) { return std::string(url.substr(0, url.find_first_of("?#"))); }

HttpSource::HttpSource(std::string url) : root_(std::move(url)), client_(without_query(root_)) {}

std::string HttpSource::name(const std::string& address) const {
  const std::string path = split_url(address).path, root = split_url(root_).path;
  const std::string folder = root.substr(0, root.rfind('/') + 1);
  return path.starts_with(folder) ? path.substr(folder.size()) : path;
}

std::string HttpSource::resolve(const std::string& base, const std::string& uri) const {
  const Url from = split_url(base);
  Url to;
  if (is_http(uri)) {
    to = split_url(uri);
  } else if (uri.starts_with("//")) {
    to = split_url(from.origin.substr(0, from.origin.find(':') + 1) + uri);
  } else if (uri.empty() || uri.find("://") < uri.find_first_of("/?") || uri.starts_with("data:")) {
    throw Error(ErrorCode::mesh_unsupported,
                "the tileset refers to " + in_quotes(uri) + ", which is no file of its server", shown(base),
                "give a tileset whose files are on one server");
  } else {
    const std::string folder = uri.starts_with("/") ? "" : from.path.substr(0, from.path.rfind('/') + 1);
    to = split_url(from.origin + folder + uri);
  }
  // Others may have made the tileset: it shall neither learn the key nor ask the machines of a network.
  if (to.origin != from.origin) {
    throw Error(ErrorCode::mesh_unsupported, "the tileset refers to another server: " + in_quotes(to.origin),
                shown(base), "give a tileset whose files are on one server");
  }
  for (const std::string_view name : {"key", "session"}) {
    const std::string known = parameter(from.query, name);
    if (known.empty() || !parameter(to.query, name).empty()) continue;
    to.query.append(to.query.empty() ? "" : "&").append(known);
  }
  return to.origin + without_dots(to.path) + (to.query.empty() ? "" : "?" + to.query);
}

std::string HttpSource::read(const std::string& address, const core::ProgressReporter& progress) {
  HttpAnswer answer;
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(200 << i));
    progress.check();
    answer = client_.get(address, kMostBytes, progress);
    const bool is_busy = answer.status == 429 || answer.status >= 500 || (!answer.fault.empty() && answer.status == 0);
    if (!is_busy) break;
  }
  const auto fail = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, problem, shown(address), fix);
  };
  const std::string status = std::to_string(answer.status);
  if (answer.status == 401 || answer.status == 403) {
    throw SourceClosed(
        Error(ErrorCode::file_unreadable,
              "the server does not give the file (" + status + "): the key is wrong, or its session is over",
              shown(address), "check the key in the address, and start again"));
  }
  if (answer.status == 404 || answer.status == 410) {
    fail(ErrorCode::file_not_found, "the server has no such file (" + status + ")", "correct the address");
  }
  if (!answer.moved_to.empty()) {
    fail(ErrorCode::file_unreadable, "the file has moved to " + without_query(answer.moved_to), "give that address");
  }
  if (!answer.fault.empty()) {
    fail(ErrorCode::file_unreadable, "the file cannot be loaded: " + answer.fault, "check the address and the network");
  }
  if (answer.status != 200) fail(ErrorCode::file_unreadable, "the server answers " + status, "try again later");
  if (answer.body.empty()) fail(ErrorCode::file_empty, "the server sends an empty file", "export the tileset again");
  if (!answer.body.starts_with("\x1f\x8b")) return std::move(answer.body);
  return io::decompress_gzip(answer.body, shown(address), progress);
}

}  // namespace vantage::internal::tiles
