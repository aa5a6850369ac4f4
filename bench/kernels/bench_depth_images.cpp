// Six depth images of one viewpoint on each device: depth/<scene>/<texels>/<sampling>/<device>. An image is rendered
// and read back; the scene was uploaded before.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "depth/depth.h"
#include "support/cities.h"
#include "support/internals.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kDepthRange = 600;

const std::map<std::string, DeviceChoice::Kind> kDevices = {
    {"cpu", DeviceChoice::Kind::cpu}, {"opengl", DeviceChoice::Kind::opengl}, {"gpu", DeviceChoice::Kind::gpu}};

/// Opened, and the scene uploaded, once a process. Throws Error(input) where the device is not there.
depth::DepthRenderer& renderer(const City& city, const std::string& device) {
  static std::map<std::pair<std::string, std::string>, std::unique_ptr<depth::DepthRenderer>> opened;
  auto& slot = opened[{city.name, device}];
  if (!slot) slot = depth::make_depth_renderer(prepared_city(city)->prepared, {kDevices.at(device), 0}).renderer;
  return *slot;
}

void depth(State& state, const City& city, int face_size, depth::Sampling sampling, const std::string& device) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  try {
    depth::DepthRenderer& images = renderer(city, device);
    const Vec3 viewpoint = ready->targets.front().target.parts[0].front() + Vec3(0, 0, 1e-3);
    double sum = 0;
    for (auto _ : state) {
      images.render({{&viewpoint, 1}, face_size, sampling, kDepthRange},
                    [&](std::size_t, std::span<const float> inverse_depths) { sum += inverse_depths.back(); });
    }
    benchmark::DoNotOptimize(sum);
    state.SetLabel(images.device().name);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    state.SkipWithError(error.problem().c_str());
  }
}

const bool registered = [] {
  for (const City* city : {&kCharlotte, &kMunichRepeated}) {
    for (const int size : {40, 200, 512, 2048}) {
      for (const auto& [word, sampling] :
           {std::pair{"centers", depth::Sampling::centers}, std::pair{"nearest", depth::Sampling::nearest}}) {
        for (const auto& device : kDevices) {
          benchmark::RegisterBenchmark(
              (std::string("depth/") + city->name + "/" + std::to_string(size) + "/" + word + "/" + device.first)
                  .c_str(),
              [city, size, sampling = sampling, name = device.first](State& state) {
                depth(state, *city, size, sampling, name);
              })
              ->Unit(benchmark::kMillisecond)
              ->MeasureProcessCPUTime()
              ->UseRealTime()
              ->Repetitions(5)
              ->ReportAggregatesOnly(true)
              ->MinTime(0.05);
        }
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
