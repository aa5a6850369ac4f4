// Moments as people write them.
#pragma once

#include <optional>
#include <string>

#include "vantage/export.h"

namespace vantage {

/// Seconds since 1970-01-01 UTC of an ISO 8601 text with a zone, "2026-06-21T16:00Z" or "2026-06-21T18:00:30+02:00";
/// fractions of seconds are left out. Throws Error(value_syntax) for any other text; `where` says where it was given.
VANTAGE_API double unix_time_of(const std::string& text, const std::string& where);

}  // namespace vantage
