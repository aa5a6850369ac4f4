// Text with numbers in it, by libfmt: the same in every locale. Only source files include this header.
#pragma once

#include <fmt/format.h>

namespace vantage::internal::core {

using fmt::format;

}  // namespace vantage::internal::core
