// The functions of libcurl that are used, found at run time: nothing is linked, and who reads no tileset over the
// network need not have it.
#pragma once

#include <string>

#include "core/progress_reporter.h"

namespace vantage::internal::tiles {

/// How long a server is waited for.
struct HttpPatience {
  long connect_s = 15;
  long slow_bytes_per_s = 1000, slow_s = 30;  ///< slower for so long: no answer
  long file_s = 600;
  double all_files_s = 7200;
  int tries = 3;              ///< of a file, while the one before was sent
  int failures_in_a_row = 5;  ///< files: then the server is not asked any more
};

/// What a server answered.
struct HttpAnswer {
  long status = 0;  ///< 200, 403, ...; 0 where there was no answer
  std::string body;
  std::string moved_to;  ///< of an answer of 300 to 399
  std::string fault;     ///< where there was no answer, or none that could be read to its end
  bool is_too_large = false;
};

/// A connection that is kept from one file to the next. Not for two threads at once.
class HttpClient {
 public:
  /// Throws Error(library_missing) where libcurl is not installed; `where`: what was to be read.
  explicit HttpClient(const std::string& where);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// GET, by HTTP or HTTPS alone, without following redirections. A server that sends too slowly has no answer, nor one
  /// of more than `most_bytes`. The body is as it was sent: with gzip, where the server took the offer. Throws
  /// Error(cancelled).
  HttpAnswer get(const std::string& url, std::size_t most_bytes, const HttpPatience& patience,
                 const core::ProgressReporter& progress);

 private:
  void* handle_ = nullptr;
};

}  // namespace vantage::internal::tiles
