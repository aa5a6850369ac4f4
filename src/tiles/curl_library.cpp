#include "tiles/curl_library.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/system_limits.h"
#include "vantage/error.h"
#include "vantage/version.h"

#if defined(__EMSCRIPTEN__) || defined(_WIN32)
#define VANTAGE_CURL_ABSENT
#else
#include <dlfcn.h>
#endif

namespace vantage::internal::tiles {

#ifdef VANTAGE_CURL_ABSENT

HttpClient::HttpClient(const std::string& where) {
  throw Error(ErrorCode::library_missing, "this build cannot read tilesets over the network", where,
              "download the tileset, or use the program");
}
HttpClient::~HttpClient() = default;
HttpAnswer HttpClient::get(const std::string& /*url*/, std::size_t /*most_bytes*/, const HttpPatience& /*patience*/,
                           const core::ProgressReporter& /*progress*/) {
  return {};
}

#else

namespace {

// Names, values and types are those of curl/curl.h, the same since 7.32 and fixed by its promise of a stable binary
// interface: an option is its number, and 10,000 for pointers, 20,000 for functions.
enum CurlOption : int {
  kWriteData = 10001,
  kUrl = 10002,
  kErrorBuffer = 10010,
  kWriteFunction = 20011,
  kUserAgent = 10018,
  kTimeout = 13,
  kLowSpeedLimit = 19,
  kLowSpeedTime = 20,
  kNoProgress = 43,
  kFollowLocation = 52,
  kProgressData = 10057,
  kConnectTimeout = 78,
  kNoSignal = 99,
  kAcceptEncoding = 10102,
  kHttpContentDecoding = 158,
  kProtocols = 181,
  kProgressFunction = 20219,
};
constexpr int kResponseCode = 0x200000 + 2, kRedirectUrl = 0x100000 + 31;
constexpr long kHttpAndHttps = 1 | 2, kGlobalAll = 3;

struct CurlLibrary {
  int (*global_init)(long) = nullptr;
  void* (*easy_init)() = nullptr;
  int (*easy_setopt)(void*, int, ...) = nullptr;
  int (*easy_perform)(void*) = nullptr;
  int (*easy_getinfo)(void*, int, ...) = nullptr;
  void (*easy_cleanup)(void*) = nullptr;
  void (*easy_reset)(void*) = nullptr;
  const char* (*easy_strerror)(int) = nullptr;
};

template <class Function>
bool find_function(void* handle, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(handle, name));
  return function != nullptr;
}

/// Null where there is none that has all functions.
const CurlLibrary* load_curl() {
  void* const handle = core::load_library({"libcurl.so.4", "libcurl-gnutls.so.4", "libcurl.4.dylib"}, "libcurl");
  static CurlLibrary library;
  if (!handle) return nullptr;
  const bool is_whole = find_function(handle, "curl_global_init", library.global_init) &&
                        find_function(handle, "curl_easy_init", library.easy_init) &&
                        find_function(handle, "curl_easy_setopt", library.easy_setopt) &&
                        find_function(handle, "curl_easy_perform", library.easy_perform) &&
                        find_function(handle, "curl_easy_getinfo", library.easy_getinfo) &&
                        find_function(handle, "curl_easy_cleanup", library.easy_cleanup) &&
                        find_function(handle, "curl_easy_reset", library.easy_reset) &&
                        find_function(handle, "curl_easy_strerror", library.easy_strerror);
  return is_whole && library.global_init(kGlobalAll) == 0 ? &library : nullptr;
}

const CurlLibrary* curl() {
  static const CurlLibrary* const library = load_curl();
  return library;
}

/// What one answer is gathered in.
struct Gathering {
  std::string* body;
  std::size_t most;
  bool is_too_large;
  core::ProgressBridge* bridge;
};

std::size_t take_bytes(char* data, std::size_t size, std::size_t count, void* gathering) noexcept {
  auto& into = *static_cast<Gathering*>(gathering);
  const std::size_t bytes = size * count;
  into.is_too_large = bytes > into.most - into.body->size();
  if (into.is_too_large) return 0;  // curl gives up
  try {
    // Powers of two: where the string moves to more room, both together have no more than the limit.
    const std::size_t wanted = into.body->size() + bytes;
    if (wanted > into.body->capacity()) into.body->reserve(std::min(into.most, std::bit_ceil(wanted)));
    into.body->append(data, bytes);
  } catch (const std::bad_alloc&) {
    return 0;
  }
  return bytes;
}

int ask_to_go_on(void* gathering, std::int64_t /*total*/, std::int64_t /*now*/, std::int64_t /*up_total*/,
                 std::int64_t /*up_now*/) noexcept {
  return core::ProgressBridge::ask(static_cast<Gathering*>(gathering)->bridge, 0) ? 0 : 1;
}

}  // namespace

HttpClient::HttpClient(const std::string& where) {
  if (!core::can_load_libraries()) {
    throw Error(ErrorCode::library_missing,
                std::string("tilesets are read over the network with libcurl, but ").append(core::kLoadsNone), where,
                std::string("download the tileset, or ").append(core::kLoadsNoneFix));
  }
  if (!curl()) {
    throw Error(ErrorCode::library_missing, "tilesets are read over the network with libcurl, which is not installed",
                where, "install libcurl4 (Debian), or download the tileset");
  }
  handle_ = curl()->easy_init();
  if (!handle_) throw std::bad_alloc();
}

HttpClient::~HttpClient() { curl()->easy_cleanup(handle_); }

HttpAnswer HttpClient::get(const std::string& url, std::size_t most_bytes, const HttpPatience& patience,
                           const core::ProgressReporter& progress) {
  constexpr std::size_t kErrorSize = 256;  // CURL_ERROR_SIZE
  const CurlLibrary& library = *curl();
  HttpAnswer answer;
  core::ProgressBridge bridge(progress);
  Gathering gathering{&answer.body, most_bytes, false, &bridge};
  std::array<char, kErrorSize> words{};
  const std::string agent = std::string("vantage/") + VANTAGE_VERSION;
  library.easy_reset(handle_);  // the connection stays
  library.easy_setopt(handle_, kUrl, url.c_str());
  library.easy_setopt(handle_, kProtocols, kHttpAndHttps);
  library.easy_setopt(handle_, kFollowLocation, 0L);
  library.easy_setopt(handle_, kNoSignal, 1L);
  library.easy_setopt(handle_, kConnectTimeout, patience.connect_s);
  library.easy_setopt(handle_, kLowSpeedLimit, patience.slow_bytes_per_s);
  library.easy_setopt(handle_, kLowSpeedTime, patience.slow_s);
  library.easy_setopt(handle_, kTimeout, patience.file_s);
  library.easy_setopt(handle_, kAcceptEncoding, "gzip");
  library.easy_setopt(handle_, kHttpContentDecoding, 0L);  // curl unpacks without a bound
  library.easy_setopt(handle_, kUserAgent, agent.c_str());
  library.easy_setopt(handle_, kErrorBuffer, words.data());
  library.easy_setopt(handle_, kWriteFunction, take_bytes);
  library.easy_setopt(handle_, kWriteData, static_cast<void*>(&gathering));
  library.easy_setopt(handle_, kNoProgress, 0L);
  library.easy_setopt(handle_, kProgressFunction, ask_to_go_on);
  library.easy_setopt(handle_, kProgressData, static_cast<void*>(&gathering));
  const int fault = library.easy_perform(handle_);
  bridge.rethrow();
  library.easy_getinfo(handle_, kResponseCode, &answer.status);
  const char* moved = nullptr;
  library.easy_getinfo(handle_, kRedirectUrl, &moved);
  if (moved) answer.moved_to = moved;
  if (fault != 0) answer.fault = words[0] != '\0' ? words.data() : library.easy_strerror(fault);
  answer.is_too_large = gathering.is_too_large;
  library.easy_setopt(handle_, kErrorBuffer, static_cast<char*>(nullptr));
  return answer;
}

#endif

}  // namespace vantage::internal::tiles
