// What others may read of where a scene comes from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vantage/export.h"

namespace vantage {

/// `text` without what may be keys of servers: of addresses, as "https://...", no user, no password, and nothing from
/// the query on. Where it is not clear what of an address is a password, its scheme is left. Words that may be meant as
/// an address have no "user:password@", and nothing from a "?" or ";" with a "=" behind it. All else stays as it is. An
/// address in a sentence ends at a quote, or at a comma, colon or semicolon and a blank. `is_address`: one that begins
/// goes on to the end.
VANTAGE_API std::string without_secrets(std::string_view text, bool is_address = false);

/// The same of a file.
VANTAGE_API std::filesystem::path shown_address(const std::filesystem::path& file);

}  // namespace vantage
