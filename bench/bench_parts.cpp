// Volumes of targets of several parts in a real city. Names: parts/<scene>/T1/300m/<shape>/<how>. "together" is
// compute_volume; "each" is the volume of each part alone, the times of which add up.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "support/cities.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using benchmark::State;

constexpr double kRange = 300;

struct Rectangle {
  double left, bottom, right, top;  // metres, in the target's plane, about its centre
};

struct Shape {
  std::string name;
  std::vector<Rectangle> parts;
};

Shape comb(int teeth) {
  Shape shape{"comb" + std::to_string(teeth), {{-6, -3, 6, -2}}};
  const double pitch = 12.0 / teeth;
  for (int i = 0; i < teeth; ++i) shape.parts.push_back({-6 + i * pitch, -2, -6 + (i + 0.8) * pitch, 3});
  return shape;
}

Target target_of(const Shape& shape, const TargetFrame& frame) {
  Target target;
  target.front = frame.normal;
  target.parts.clear();
  for (const Rectangle& part : shape.parts) {
    target.parts.push_back({frame.to_scene({part.left, part.bottom, 0}), frame.to_scene({part.right, part.bottom, 0}),
                            frame.to_scene({part.right, part.top, 0}), frame.to_scene({part.left, part.top, 0})});
  }
  return target;
}

void several_parts(State& state, const City& city, const Shape& shape, bool together) {
  const PreparedCity* const ready = prepared_city(city);
  if (!ready) return state.SkipWithError(absence(city).c_str());
  if (ready->targets.empty()) return state.SkipWithError("no street target was found");
  const Target place = target_of(shape, make_target_frame(ready->targets.front().target));
  const PreparedTarget target(ready->prepared, place, {.max_range_m = kRange});
  std::size_t facets = 0;
  for (auto _ : state) {
    facets = 0;
    if (together) {
      facets = compute_volume(target).mesh.triangles.size();
    } else {
      for (std::size_t i = 0; i < target.part_count(); ++i) {
        facets += compute_visibility(target.part(i)).mesh.triangles.size();
      }
    }
  }
  state.counters["facets"] = static_cast<double>(facets);
}

const bool registered = [] {
  const std::vector<Shape> shapes = {{"L", {{-5, -5, 5, 0}, {-5, 0, 0, 5}}},
                                     {"cross", {{-6, -2, 6, 2}, {-2, 2, 2, 6}, {-2, -6, 2, -2}}},
                                     {"U", {{-5, -5, 5, -2}, {-5, -2, -2, 5}, {2, -2, 5, 5}}},
                                     comb(8)};
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence}) {
    for (const Shape& shape : shapes) {
      for (const bool together : {false, true}) {
        const std::string name =
            std::string("parts/") + city->name + "/T1/300m/" + shape.name + (together ? "/together" : "/each");
        benchmark::RegisterBenchmark(
            name.c_str(), [city, shape, together](State& state) { several_parts(state, *city, shape, together); })
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace vantage::bench
