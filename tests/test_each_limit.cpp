// Every limit, given alone, is visited as itself, and is not taken for none.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vantage/each_limit.h"

namespace vantage {
namespace {

template <typename Limits>
std::vector<Limit> visited(const Limits& limits) {
  std::vector<Limit> found;
  each_limit(limits, [&](Limit limit, const auto& /*value*/) { found.push_back(limit); });
  return found;
}

TEST(EachLimit, OfNavigationIsVisitedAlone) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  const std::vector<std::pair<Limit, std::function<void(Navigation&)>>> limits = {
      {Limit::altitude,
       [](Navigation& all) {
         all.altitude = Navigation::Altitude{0, 1};
       }},
      {Limit::above_ground,
       [](Navigation& all) {
         all.above_ground = AboveGround{0, 1, {}};
       }},
      {Limit::keep_in, [&](Navigation& all) { all.keep_in.emplace_back(box); }},
      {Limit::keep_out, [&](Navigation& all) { all.keep_out.emplace_back(box); }},
      {Limit::meshes,
       [](Navigation& all) {
         all.meshes.push_back({Mesh(), "hall"});
       }},
      {Limit::clearance,
       [](Navigation& all) {
         all.clearance = Clearance{1, std::make_shared<const Mesh>()};
       }},
  };
  EXPECT_TRUE(Navigation().empty());
  EXPECT_TRUE(visited(Navigation()).empty());
  Navigation all;
  std::vector<Limit> names;
  for (const auto& [limit, set] : limits) {
    SCOPED_TRACE(name_of(limit));
    Navigation alone;
    set(alone);
    EXPECT_EQ(visited(alone), std::vector<Limit>{limit});
    EXPECT_FALSE(alone.empty());
    set(all);
    names.push_back(limit);
  }
  EXPECT_EQ(visited(all), names) << "in the order of Limit";
}

TEST(EachLimit, OfTheSensorIsVisitedAlone) {
  const std::vector<std::pair<Limit, std::function<void(Sensor&)>>> limits = {
      {Limit::min_range, [](Sensor& all) { all.min_range_m = 1; }},
      {Limit::incidence, [](Sensor& all) { all.incidence_deg = 60; }},
      {Limit::pixel,
       [](Sensor& all) {
         all.pixel = PixelLimit{0.1, PixelLimit::Kind::worst};
       }},
      {Limit::frame, [](Sensor& all) { all.camera.emplace(); }},
      {Limit::sun,
       [](Sensor& all) {
         all.sun = SunLimit{Vec3::UnitZ(), 5};
       }},
  };
  // These the volume is computed with: it is not cut to them.
  Sensor none;
  none.max_range_m = 10;
  none.pixel = PixelLimit{0.1, PixelLimit::Kind::perpendicular};
  none.link = RadioLink{2.4, 0.6};
  none.visible = VisibleShare{0.5, 16};
  EXPECT_FALSE(none.limits_view());
  EXPECT_TRUE(visited(none).empty());
  Sensor all;
  std::vector<Limit> names;
  for (const auto& [limit, set] : limits) {
    SCOPED_TRACE(name_of(limit));
    Sensor alone;
    set(alone);
    EXPECT_EQ(visited(alone), std::vector<Limit>{limit});
    EXPECT_TRUE(alone.limits_view());
    set(all);
    names.push_back(limit);
  }
  EXPECT_EQ(visited(all), names) << "in the order of Limit";
}

}  // namespace
}  // namespace vantage
