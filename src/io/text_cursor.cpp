#include "io/text_cursor.h"

#include <locale.h>
#include <stdlib.h>

namespace vantage::internal::io {

double number_out_of_range(std::string_view number) {
  // Plain strtod would expect a comma in some locales.
  static const locale_t kPlain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return ::strtod_l(std::string(number).c_str(), nullptr, kPlain);
}

}  // namespace vantage::internal::io
