// libFuzzer target: any bytes as a zip archive. No more is unpacked than is allowed, whatever the archive says of
// itself.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "io/zip.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostBytes = 1'000'000;
  const std::string_view archive(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"doc.kml", "absent.kml"}) {
    try {
      require(vantage::internal::io::unzipped(archive, name, ".kml", kMostBytes).size() <= kMostBytes);
    } catch (const vantage::internal::io::ZipProblem& problem) {
      require(!problem.text.empty() && problem.text.find('\n') == std::string::npos);
    }
  }
  return 0;
}
