// A small plaza as text: a scene and missions in it, for tests of tours.
#pragma once

#include <array>
#include <string>

#include "vantage/geometry.h"

namespace vantage::testing {

/// A ground of 400 m. A hall to the north, a tower to the east, a kiosk to the south: closed boxes.
inline std::string plaza_obj() {
  std::string text = "o ground\nv -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf 1 2 3 4\n";
  int first = 5;
  const auto box = [&](const char* name, const Vec3& min, const Vec3& max) {
    text += std::string("o ") + name + "\n";
    for (int i = 0; i < 8; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        text += (axis == 0 ? "v " : " ") + std::to_string(((i >> axis & 1) == 0 ? min : max)[axis]);
      }
      text += "\n";
    }
    constexpr std::array<std::array<int, 4>, 6> kQuads = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const std::array<int, 4>& quad : kQuads) {
      text += "f";
      for (const int corner : quad) text += " " + std::to_string(first + corner);
      text += "\n";
    }
    first += 8;
  };
  box("hall", {-20, 50, -1}, {20, 90, 30});
  box("tower", {60, -5, -1}, {70, 5, 45});
  box("kiosk", {-5, -45, -1}, {5, -38, 6});
  return text;
}

inline constexpr const char* kPlazaScene = "scene: {mesh: plaza.obj}\n";
/// West, east of the tower, and south.
inline constexpr const char* kPlazaTargets =
    "targets:\n"
    "  - {name: west, vertices: [[-83, -3, 0.1], [-77, -3, 0.1], [-77, 3, 0.1], [-83, 3, 0.1]]}\n"
    "  - {name: east, vertices: [[97, -3, 0.1], [103, -3, 0.1], [103, 3, 0.1], [97, 3, 0.1]]}\n"
    "  - {name: south, vertices: [[-3, -83, 0.1], [3, -83, 0.1], [3, -77, 0.1], [-3, -77, 0.1]]}\n";
inline constexpr const char* kPlazaSensor = "sensor: {max_range: 60}\nexact: {tolerance: 0.5}\n";

/// `tour`: what is between the braces of it.
inline std::string plaza_mission(const std::string& tour, const std::string& more = "") {
  return std::string(kPlazaScene) + kPlazaTargets + kPlazaSensor + more + "tour: {" + tour + "}\n";
}

}  // namespace vantage::testing
