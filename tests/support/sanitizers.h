// Whether the tests, and with them the program, are built with a sanitizer that needs room of its own.
#pragma once

namespace vantage::testing {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kHasAddressSanitizer = true;  // gcc
#elif defined(__has_feature)
inline constexpr bool kHasAddressSanitizer = __has_feature(address_sanitizer);  // clang
#else
inline constexpr bool kHasAddressSanitizer = false;
#endif

}  // namespace vantage::testing
