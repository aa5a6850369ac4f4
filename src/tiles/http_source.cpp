#include "tiles/http_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/shown_address.h"
#include "io/json_text.h"
#include "io/mesh_source.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

// One file. Tiles have some megabytes.
constexpr std::size_t kMostFileBytes = std::size_t{512} << 20U;

/// "https://", also of "HTTPS://..."; empty where there is none.
std::string scheme_of(std::string_view text) {
  const std::size_t end = text.find("://");
  if (end == std::string_view::npos) return {};
  std::string scheme(text.substr(0, end + 3));
  for (char& c : scheme) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return scheme;
}

/// The parts of "https://host:port/path?query".
struct Url {
  std::string origin;  ///< "https://host:port"
  std::string path;    ///< from its slash on
  std::string query;   ///< without its mark
};

Url split_url(std::string_view text) {
  text = text.substr(0, text.find('#'));
  const std::string scheme = scheme_of(text);
  const std::size_t host = scheme.size();
  const std::size_t end = std::min(text.find_first_of("/?", host), text.size());
  const std::size_t mark = std::min(text.find('?', end), text.size());
  Url url{scheme + std::string(text.substr(host, end - host)), std::string(text.substr(end, mark - end)), ""};
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

/// "session=..." of the first URI of a tileset that has one; empty where none has.
std::string first_session(const nlohmann::json& root) {
  std::vector<const nlohmann::json*> waiting = {&root};  // a stack
  while (!waiting.empty()) {
    const nlohmann::json& value = *waiting.back();
    waiting.pop_back();
    for (const char* const key : {"uri", "url"}) {
      const auto uri = value.is_object() ? value.find(key) : value.end();
      if (uri == value.end() || !uri->is_string()) continue;
      const std::string text = uri->get<std::string>();
      const std::size_t mark = text.find('?');
      if (mark == std::string::npos) continue;
      const std::string_view query = std::string_view{text}.substr(mark + 1);
      if (std::string found = parameter(query, "session"); !found.empty()) return found;
    }
    if (value.is_structured()) {
      for (const nlohmann::json& member : value) waiting.push_back(&member);
    }
  }
  return {};
}

}  // namespace

bool is_http(std::string_view text) {
  const std::string scheme = scheme_of(text);
  return scheme == "http://" || scheme == "https://";
}

std::string without_query(std::string_view uri) {
  if (uri.starts_with("data:")) return "data:";
  if (uri.starts_with("//")) return without_query("https:" + std::string(uri)).substr(6);
  if (uri.find("://") < uri.find_first_of("?#")) return without_secrets(uri, true);
  const std::string shown = without_secrets("https://a/" + std::string(uri.substr(0, uri.find_first_of("?#"))), true);
  return shown.substr(std::min<std::size_t>(shown.size(), 10));
}

HttpSource::HttpSource(std::string url, const HttpPatience& patience)
    : root_(std::move(url)), patience_(patience), client_(without_query(root_)) {}

std::string HttpSource::name(const std::string& address) const {
  const std::string path = split_url(address).path, root = split_url(root_).path;
  const std::string folder = root.substr(0, root.rfind('/') + 1);
  return without_query(path.starts_with(folder) ? path.substr(folder.size()) : path);
}

std::string HttpSource::resolve(const std::string& base, const std::string& uri) const {
  const Url from = split_url(base);
  Url to;
  if (is_http(uri)) {
    to = split_url(uri);
  } else if (uri.starts_with("//")) {
    to = split_url(from.origin.substr(0, from.origin.find(':') + 1) + uri);
  } else if (uri.empty() || uri.find("://") < uri.find_first_of("/?#") || uri.starts_with("data:")) {
    throw Error(ErrorCode::mesh_unsupported,
                "the tileset refers to " + in_quotes(without_query(uri)) + ", which is no file of its server",
                shown(base), "give a tileset whose files are on one server");
  } else {
    const std::string folder = uri.starts_with("/") ? "" : from.path.substr(0, from.path.rfind('/') + 1);
    to = split_url(from.origin + folder + uri);
  }
  // Others may have made the tileset: it shall neither learn the key nor ask the machines of a network.
  if (to.origin != from.origin) {
    throw Error(ErrorCode::mesh_unsupported,
                "the tileset refers to another server: " + in_quotes(without_query(to.origin)), shown(base),
                "give a tileset whose files are on one server");
  }
  for (const std::string_view name : {"key", "session"}) {
    const std::string known = parameter(from.query, name);
    if (known.empty() || !parameter(to.query, name).empty()) continue;
    to.query.append(to.query.empty() ? "" : "&").append(known);
  }
  return to.origin + without_dots(to.path) + (to.query.empty() ? "" : "?" + to.query);
}

/// Ends the walk.
void HttpSource::close(const std::string& problem, const std::string& address, const std::string& fix) const {
  const std::string so_far = read_ == 0 ? "" : "; " + std::to_string(read_) + " files were read before";
  throw SourceClosed(Error(ErrorCode::file_unreadable, problem + so_far, shown(address), fix));
}

void HttpSource::check_time(const std::string& address) const {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
  if (spent.count() <= patience_.all_files_s) return;
  close("reading the tileset over the network takes longer than " +
            std::to_string(std::lround(patience_.all_files_s / 60)) + " minutes",
        address, "give a smaller radius or a larger detail, or download the tileset");
}

/// Tries some times where it may help, and gives up a server that gives no answers.
HttpAnswer HttpSource::ask(const std::string& address, const core::ProgressReporter& progress) {
  HttpAnswer answer;
  for (int i = 0; i < patience_.tries; ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(200 << i));
    progress.check();
    check_time(address);
    answer = client_.get(address, kMostFileBytes, patience_, progress);
    const bool is_silent = !answer.fault.empty() && !answer.is_too_large;
    if (!is_silent && answer.status != 429 && answer.status < 500) {
      failures_ = 0;
      return answer;
    }
    if (is_silent && failures_ > 0) break;  // what is not there at all is not asked again for each file
  }
  const std::string fault = answer.fault.empty() ? "it answers " + std::to_string(answer.status) : answer.fault;
  if (++failures_ >= patience_.failures_in_a_row) {
    close("the server has not sent " + std::to_string(failures_) + " files in a row: " + fault, address,
          "check the network and the server, and start again");
  }
  return answer;
}

/// The address with the session that followed its own.
std::string HttpSource::with_new_session(const std::string& address) const {
  if (renewed_.empty()) return address;
  const Url url = split_url(address);
  const std::string old = parameter(url.query, "session");
  std::string session = old;
  for (auto next = renewed_.find(old); next != renewed_.end(); next = renewed_.find(session)) session = next->second;
  if (session == old) return address;
  std::string query = "&" + url.query;
  query.replace(query.find("&" + old), old.size() + 1, "&" + session);
  return url.origin + url.path + "?" + query.substr(1);
}

/// Asks for the root again. Returns whether it gives another session than the one of `refused`.
bool HttpSource::renew_session(const std::string& refused, const core::ProgressReporter& progress) {
  const std::string old = parameter(split_url(refused).query, "session");
  if (old.empty() || read_in_session_ == 0 || !parameter(split_url(root_).query, "session").empty()) return false;
  HttpAnswer answer = ask(root_, progress);
  if (answer.status != 200) return false;
  std::string session;
  try {
    const std::string text = body_of(std::move(answer), root_, progress);
    session = first_session(io::parse_json(text, progress, core::ReadLimits::of_tiles()));
  } catch (const io::JsonProblem&) {
    return false;
  }
  if (session.empty() || session == old || renewed_.contains(session)) return false;
  renewed_[old] = session;
  read_in_session_ = 0;
  return true;
}

std::string HttpSource::read(const std::string& address, const core::ProgressReporter& progress) {
  const auto is_refused = [](const HttpAnswer& answer) { return answer.status == 401 || answer.status == 403; };
  std::string asked = with_new_session(address);
  HttpAnswer answer = ask(asked, progress);
  const bool is_new = is_refused(answer) && renew_session(asked, progress);
  if (is_new) {
    asked = with_new_session(address);
    answer = ask(asked, progress);
  }
  if (is_refused(answer)) {
    close("the server does not give the file (" + std::to_string(answer.status) + "): the key is wrong, or " +
              (is_new ? "neither its old session nor a new one counts" : "its session is over"),
          address, "check the key in the address, and start again");
  }
  std::string bytes = body_of(std::move(answer), address, progress);
  ++read_;
  ++read_in_session_;
  return bytes;
}

std::string HttpSource::body_of(HttpAnswer&& answer, const std::string& address,
                                const core::ProgressReporter& progress) {
  const auto fail = [&](ErrorCode code, const std::string& problem, const std::string& fix) {
    throw Error(code, problem, shown(address), fix);
  };
  const std::string status = std::to_string(answer.status);
  if (answer.status == 404 || answer.status == 410) {
    fail(ErrorCode::file_not_found, "the server has no such file (" + status + ")", "correct the address");
  }
  if (!answer.moved_to.empty()) {
    fail(ErrorCode::file_unreadable, "the file has moved to " + without_query(answer.moved_to), "give that address");
  }
  if (answer.is_too_large) {
    fail(ErrorCode::mesh_too_large, "the file has more than " + std::to_string(kMostFileBytes >> 20U) + " MiB",
         "export the tileset in smaller tiles");
  }
  if (!answer.fault.empty()) {
    fail(ErrorCode::file_unreadable, "the file cannot be loaded: " + answer.fault, "check the address and the network");
  }
  if (answer.status != 200) fail(ErrorCode::file_unreadable, "the server answers " + status, "try again later");
  if (answer.body.empty()) fail(ErrorCode::file_empty, "the server sends an empty file", "export the tileset again");
  // Compressed for the way, as a file, or both: together they may not grow beyond what a file of these bytes may.
  core::ReadLimits limits = core::ReadLimits::of_tiles();
  const std::uint64_t most = limits.most_decompressed(answer.body.size());
  std::string body = std::move(answer.body);
  for (int layer = 0; layer < 2 && body.starts_with("\x1f\x8b"); ++layer) {
    body = io::decompress_gzip(body, shown(address), progress, limits);
    limits.decompressed_bytes = most;
  }
  return body;
}

}  // namespace vantage::internal::tiles
