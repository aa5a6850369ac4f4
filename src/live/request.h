// What the page asks over a socket, and how it is answered: web/src/engine/messages.ts has the same.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "live/map_areas.h"
#include "live/session.h"
#include "vantage/progress.h"

namespace vantage::live {

/// {"id": 7, "request": {"call": "compute", "text": "..."}}
struct Request {
  std::uint64_t id = 0;
  std::string call;  ///< about, hello, shown, compute, read, query, area, flight, volumes, prove, slice, save, stop
  std::string text;  ///< of compute and read
  std::vector<double> coordinates;  ///< of query and area
  double z_m = 0;                   ///< of slice
  std::string format;               ///< of save
};

/// Throws Error(input) for what is not a request.
Request parse_request(std::string_view text);

/// A message: the length of the JSON that follows, as 32 bits, little-endian; the JSON {id, value or error, engine_ms,
/// mesh: the numbers of positions, triangles and labels, or bytes: their number}, with blanks up to a multiple of 4;
/// then the arrays in this order, or the bytes. Never throws Error: that is an answer, too.
std::string answer(Session& session, MapAreas& areas, const Request& request, const Progress& progress = {});

/// The notice about a request whose answer comes later: whether it waits until others have computed, {id, waits}.
std::string waiting_notice(const Request& request, bool waits);

/// To a request that a newer one replaces.
std::string stale_answer(const Request& request);

/// To a request that was stopped before its turn.
std::string cancelled_answer(const Request& request);

/// To a request to stop.
std::string stopped_answer(const Request& request);

}  // namespace vantage::live
