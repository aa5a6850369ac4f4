#include "fuzz/mesh_fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::internal::io;
  const auto with_lod = [](const MeshSource& source, const vantage::internal::core::ProgressReporter& progress,
                           const vantage::internal::core::ReadLimits& limits) {
    return read_cityjson(source, progress, limits, "1");
  };
  const auto without = [](const MeshSource& source, const vantage::internal::core::ProgressReporter& progress,
                          const vantage::internal::core::ReadLimits& limits) {
    return read_cityjson(source, progress, limits);
  };
  vantage::fuzzing::read(without, "/nowhere/fuzz.city.json", data, size);
  vantage::fuzzing::read(with_lod, "/nowhere/fuzz.city.json", data, size);
  return 0;
}
