#include "live/report_page.h"

#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <string>

#include "live/page_text.h"
#include "live/request.h"
#include "vantage/error.h"

namespace vantage::live {
namespace {

std::string gzip(const std::string& bytes) {
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  // zlib counts with 32 bits.
  std::size_t left = bytes.size(), room = packed.size();
  int status = Z_OK;
  while (status == Z_OK) {
    constexpr std::size_t kMost = std::size_t{1} << 30;
    stream.avail_in = static_cast<uInt>(std::min(left, kMost));
    stream.avail_out = static_cast<uInt>(std::min(room, kMost));
    const std::size_t in = stream.avail_in, out = stream.avail_out;
    status = deflate(&stream, left <= kMost ? Z_FINISH : Z_NO_FLUSH);
    left -= in - stream.avail_in;
    room -= out - stream.avail_out;
  }
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error(ErrorCode::internal_defect, "the page could not be compressed", "", "");
  packed.resize(packed.size() - room);
  return packed;
}

/// RFC 4648.
std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[bits >> shift & 63];
  }
  for (std::size_t i = bytes.size() % 3; i > 0 && i < 3; ++i) text[text.size() - (3 - i)] = '=';
  return text;
}

/// Today, UTC: "2026-07-01".
std::string today() {
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  const auto two_digits = [](unsigned number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  return std::to_string(static_cast<int>(day.year())) + "-" + two_digits(static_cast<unsigned>(day.month())) + "-" +
         two_digits(static_cast<unsigned>(day.day()));
}

}  // namespace

std::string report_page(Session& session, const std::string& page, bool proves, const Progress& progress) {
  session.hide_keys();  // others read the page
  std::string answers;
  MapAreas areas;
  for (const char* const call : {"hello", "shown", "prove"}) {
    if (call == std::string("prove") && !proves) continue;
    Request request;
    request.call = call;
    answers += std::string(answers.empty() ? "" : ",") + call + ":\"" +
               base64(gzip(answer(session, areas, request, progress))) + "\"";
  }
  if (progress && !progress("proof", 1)) throw Error(ErrorCode::cancelled, "stopped while the report was made", "", "");
  return with_start(page, "window.vantageReport={" + answers + ",made:\"" + today() + "\"}");
}

}  // namespace vantage::live
