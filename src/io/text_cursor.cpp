#include "io/text_cursor.h"

#include <locale.h>
#include <stdlib.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

namespace vantage::internal::io {

double number_out_of_range(std::string_view number) {
  // Plain strtod would expect a comma in some locales.
#ifdef _WIN32
  static const _locale_t kPlain = ::_create_locale(LC_ALL, "C");
  return ::_strtod_l(std::string(number).c_str(), nullptr, kPlain);
#else
  static const locale_t kPlain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return ::strtod_l(std::string(number).c_str(), nullptr, kPlain);
#endif
}

}  // namespace vantage::internal::io
