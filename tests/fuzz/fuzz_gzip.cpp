#include "fuzz/mesh_fuzzing.h"
#include "support/internals.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage;  // NOLINT(google-build-using-namespace): this function is the whole program
  core::ReadLimits limits;
  limits.decompressed_bytes = 100'000;
  try {
    const std::string_view compressed(reinterpret_cast<const char*>(data), size);
    const std::string plain = io::decompress_gzip(compressed, "fuzz.gz", {}, limits);
    fuzzing::require(plain.size() <= limits.decompressed_bytes, "the limit is kept");
  } catch (const Error& error) {
    fuzzing::require(error.kind() == ErrorKind::input, "what cannot be read is an input error");
  }
  return 0;
}
