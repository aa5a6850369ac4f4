#include "fuzz/mesh_fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vantage::fuzzing::read(vantage::internal::io::read_gltf, "/nowhere/fuzz.gltf", data, size);
  return 0;
}
