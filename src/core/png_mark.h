// The chunk of text by which a PNG says that vantage made it.
#pragma once

#include <string>
#include <string_view>

#include "vantage/export.h"

namespace vantage::internal::core {

/// With the chunk after the header: so it can be told from the pictures of others. `png`: a whole one.
VANTAGE_INTERNAL_API std::string with_png_mark(std::string png);

/// Whether the chunk is there, of this version or another, whatever else `bytes` hold, and however few they are.
bool has_png_mark(std::string_view bytes);

}  // namespace vantage::internal::core
