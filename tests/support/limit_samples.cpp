#include "support/limit_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <type_traits>

#include "support/limit_rows.h"
#include "support/scenes.h"

namespace vantage::testing {
namespace {

template <Limit kLimit>
concept IsLimit = requires {
  typename LimitValue<kLimit>::type;
};

template <int kNext = 0>
void add_samples(std::vector<LimitSample>& samples) {
  constexpr Limit kLimit = static_cast<Limit>(kNext);
  if constexpr (IsLimit<kLimit>) {
    samples.push_back(sample_of<kLimit>());
    add_samples<kNext + 1>(samples);
  }
}

/// Of limits that may be changed.
template <typename Limits, typename Change>
void each_limit_to_change(Limits& limits, const Change& change) {
  each_limit(limits, [&](auto limit, const auto& value) {
    change(limit, const_cast<std::remove_cvref_t<decltype(value)>&>(value));
  });
}

template <typename Limits>
void expect_same_of(const Limits& found, const Limits& expected) {
  std::vector<Limit> names, expected_names;
  each_limit(expected, [&](Limit limit, const auto& /*value*/) { expected_names.push_back(limit); });
  each_limit(found, [&](auto limit, const auto& value) {
    names.push_back(limit);
    each_limit(expected, [&](auto other, const auto& expected_value) {
      if constexpr (other == limit) expect_same<limit>(value, expected_value);
    });
  });
  EXPECT_EQ(names, expected_names);
}

}  // namespace

const std::vector<LimitSample>& limit_samples() {
  static const std::vector<LimitSample> kSamples = [] {
    std::vector<LimitSample> samples;
    add_samples(samples);
    return samples;
  }();
  return kSamples;
}

LimitWorld world_of_samples() {
  LimitWorld world;
  world.scene = SceneBuilder().box("block", {30, -4, 0}, {36, 4, 9});
  world.target = target_of({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  world.sensor.max_range_m = 60;
  return world;
}

LimitWorld world_of(const LimitSample& sample) {
  LimitWorld world = world_of_samples();
  sample.add_needed(world);
  sample.add(world);
  return world;
}

namespace {

std::string mission_text_with(const std::string& sensor, const std::string& navigation) {
  return "scene: {mesh: scene.obj}\ntarget: {vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}\n"
         "sensor: {max_range: 60" +
         sensor + "}\n" + (navigation.empty() ? "" : "navigation: {" + navigation + "}\n");
}

std::string mission_text_with(Limit limit, const std::string& text) {
  return is_of_navigation(limit) ? mission_text_with("", text) : mission_text_with(", " + text, "");
}

}  // namespace

std::string mission_text_without_limit() { return mission_text_with("", ""); }

std::string mission_text_of(const LimitSample& sample, const std::filesystem::path& folder) {
  const LimitWorld world = world_of(sample);
  for (const KeepInMesh& mesh : world.navigation.meshes) {
    write_scene(SceneBuilder().add(mesh.name, mesh.mesh), folder / mesh.name);
  }
  return mission_text_with(sample.limit, sample.text);
}

std::string wrong_mission_text_of(const LimitSample& sample) {
  return mission_text_with(sample.limit, sample.wrong_text);
}

Mesh moved(Mesh mesh, const Motion& motion) {
  for (Vec3& vertex : mesh.vertices) vertex = motion.of(vertex);
  return mesh;
}

Navigation moved(const Navigation& navigation, const Motion& motion) {
  Navigation result = navigation;
  each_limit_to_change(result, [&](auto limit, auto& value) { move<limit>(value, motion); });
  return result;
}

// The limits, and what is none.
Sensor moved(const Sensor& sensor, const Motion& motion) {
  Sensor result = sensor;
  each_limit_to_change(result, [&](auto limit, auto& value) { move<limit>(value, motion); });
  result.max_range_m *= motion.scale;
  if (sensor.mount.yaw_deg) {  // clockwise from north
    const double turned = std::atan2(motion.turn(1, 0), motion.turn(0, 0)) * 180 / std::numbers::pi;
    result.mount.yaw_deg = std::remainder(*sensor.mount.yaw_deg - turned, 360.0);
  }
  if (sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::perpendicular) result.pixel->size_m *= motion.scale;
  if (sensor.link) result.link->frequency_ghz /= motion.scale;
  return result;
}

LimitWorld moved(const LimitWorld& world, const Motion& motion) {
  LimitWorld result = world;
  result.scene.mesh = moved(world.scene.mesh, motion);
  for (std::vector<Vec3>& part : result.target.parts) {
    for (Vec3& corner : part) corner = motion.of(corner);
  }
  if (world.target.front) result.target.front = motion.turn * *world.target.front;
  result.sensor = moved(world.sensor, motion);
  result.navigation = moved(world.navigation, motion);
  return result;
}

void change_soups(Navigation& navigation, const ChangeMesh& change) {
  each_limit_to_change(navigation, [&](auto limit, auto& value) { change_soups_of<limit>(value, change); });
}

void expect_same_limits(const Navigation& found, const Navigation& expected) { expect_same_of(found, expected); }
void expect_same_limits(const Sensor& found, const Sensor& expected) { expect_same_of(found, expected); }

}  // namespace vantage::testing
