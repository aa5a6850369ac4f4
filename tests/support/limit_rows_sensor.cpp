#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/limit_rows.h"
#include "vantage/camera.h"

namespace vantage::testing {
namespace {

constexpr double kDegreeOfRows = std::numbers::pi / 180;

Pinhole camera_of(double half_width, double half_height) {
  return {half_width, half_height, 4000, 3000, 2000 / half_width};
}

}  // namespace

// ---- min_range ----

template <>
LimitSample sample_of<Limit::min_range>() {
  LimitSample sample;
  sample.limit = Limit::min_range;
  sample.add = [](LimitWorld& w) { w.sensor.min_range_m = 15; };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 0, 10};
  sample.outside_of = {"min_range"};
  sample.text = "min_range: 15";
  sample.is_flat = false;
  sample.is_refuted = true;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) { w.sensor.min_range_m = -1; };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "min_range: -1";
  sample.draws = {
      {"min_range", Turns::all, 2e-3, true, [](LimitWorld& w, Random& r) { w.sensor.min_range_m = r.uniform(6, 20); }},
  };
  return sample;
}

template <>
void move<Limit::min_range>(double& limit, const Motion& motion) {
  limit *= motion.scale;
}

template <>
void change_soups_of<Limit::min_range>(double& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::min_range>(const double& found, const double& expected) {
  EXPECT_EQ(found, expected);
}

// ---- incidence ----

template <>
LimitSample sample_of<Limit::incidence>() {
  LimitSample sample;
  sample.limit = Limit::incidence;
  sample.add = [](LimitWorld& w) { w.sensor.incidence_deg = 60; };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 40, 10};
  sample.outside_of = {"incidence"};
  sample.text = "incidence: 60";
  sample.is_flat = false;
  sample.is_refuted = true;
  sample.bounds_outer = true;
  sample.add_wrong = [](LimitWorld& w) { w.sensor.incidence_deg = 95; };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "incidence: 95";
  sample.draws = {
      {"incidence", Turns::all, 2e-3, true,
       [](LimitWorld& w, Random& r) { w.sensor.incidence_deg = r.uniform(30, 80); }},
  };
  return sample;
}

template <>
void move<Limit::incidence>(double& /*limit*/, const Motion& /*motion*/) {}

template <>
void change_soups_of<Limit::incidence>(double& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::incidence>(const double& found, const double& expected) {
  EXPECT_EQ(found, expected);
}

// ---- frame ----

template <>
LimitSample sample_of<Limit::frame>() {
  LimitSample sample;
  sample.limit = Limit::frame;
  sample.add = [](LimitWorld& w) {
    w.sensor.camera = pinhole_of_fov(60, 40);
    w.sensor.mount.max_pitch_deg = 10;
  };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 0, 6};
  sample.outside_of = {"frame"};
  sample.text = "fov: [60, 40], gimbal: {pitch: [-90, 10]}";
  sample.is_flat = false;
  sample.is_refuted = false;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) {
    w.sensor.camera = pinhole_of_fov(60, 40);
    w.sensor.mount.max_pitch_deg = 120;
  };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "fov: [60, 40], gimbal: {pitch: [-90, 120]}";
  sample.draws = {
      // Of a camera that turns, the proof of the frame often leaves a few facets open.
      {"frame", Turns::about_z, 2e-2, false,
       [](LimitWorld& w, Random& r) {
         w.sensor.camera = camera_of(r.uniform(0.15, 0.4), r.uniform(0.12, 0.3));
         if (r.chance(0.7)) w.sensor.mount = {{}, -90, r.uniform(-60, 0), r.uniform(-60, 60)};
       }},
      {"fixed frame", Turns::about_z, 2e-3, true,
       [](LimitWorld& w, Random& r) {
         w.sensor.camera = camera_of(0.7, 0.6);
         w.sensor.mount = {r.uniform(0, 360), -60, -60, r.uniform(-20, 20)};
       }},
  };
  return sample;
}

template <>
void move<Limit::frame>(Pinhole& /*limit*/, const Motion& /*motion*/) {}

template <>
void change_soups_of<Limit::frame>(Pinhole& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::frame>(const Pinhole& found, const Pinhole& expected) {
  EXPECT_EQ(found.half_width, expected.half_width);
  EXPECT_EQ(found.half_height, expected.half_height);
  EXPECT_EQ(found.focal_px, expected.focal_px);
}

// ---- pixel ----

template <>
LimitSample sample_of<Limit::pixel>() {
  LimitSample sample;
  sample.limit = Limit::pixel;
  sample.add = [](LimitWorld& w) { w.sensor.pixel = {0.01, PixelLimit::Kind::worst}; };
  sample.add_needed = [](LimitWorld& w) { w.sensor.camera = pinhole_of_fov(60, 40, 4000, 3000); };
  sample.kept = {0, 0, 20};
  sample.broken = {0, 25, 12};
  sample.outside_of = {"pixel"};
  sample.text = "fov: [60, 40], camera: {width: 4000, height: 3000}, pixel: {size: 0.01}";
  sample.is_flat = false;
  sample.is_refuted = true;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) {
    w.sensor.camera = pinhole_of_fov(60, 40, 4000, 3000);
    w.sensor.pixel = {-1, PixelLimit::Kind::worst};
  };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "fov: [60, 40], camera: {width: 4000, height: 3000}, pixel: {size: -1}";
  sample.draws = {
      {"pixel, worst", Turns::all, 2e-2, false,
       [](LimitWorld& w, Random& r) {
         w.sensor.camera = camera_of(0.5, 0.4);
         w.sensor.pixel = {r.uniform(20, 45) / 4000, PixelLimit::Kind::worst};
       }},
      {"pixel, perpendicular", Turns::all, 2e-2, false,
       [](LimitWorld& w, Random& r) {
         w.sensor.camera = camera_of(0.5, 0.4);
         w.sensor.pixel = {r.uniform(20, 35) / 4000, PixelLimit::Kind::perpendicular};
       }},
  };
  return sample;
}

template <>
void move<Limit::pixel>(PixelLimit& limit, const Motion& motion) {
  limit.size_m *= motion.scale;
}

template <>
void change_soups_of<Limit::pixel>(PixelLimit& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::pixel>(const PixelLimit& found, const PixelLimit& expected) {
  EXPECT_EQ(found.size_m, expected.size_m);
  EXPECT_EQ(found.kind, expected.kind);
}

// ---- sun ----

template <>
LimitSample sample_of<Limit::sun>() {
  LimitSample sample;
  sample.limit = Limit::sun;
  sample.add = [](LimitWorld& w) {
    w.sensor.sun = SunLimit{{0, -std::cos(10 * kDegreeOfRows), std::sin(10 * kDegreeOfRows)}, 30};
  };
  sample.kept = {0, 0, 30};
  sample.broken = {0, 40, 8};
  sample.outside_of = {"sun"};
  sample.text = "sun: {azimuth: 180, elevation: 10, exclude: 30}";
  sample.is_flat = false;
  sample.is_refuted = true;
  sample.bounds_outer = false;
  sample.add_wrong = [](LimitWorld& w) { w.sensor.sun = SunLimit{Vec3::UnitZ(), 95}; };
  sample.wrong_code = ErrorCode::value_out_of_range;
  sample.wrong_text = "sun: {azimuth: 180, elevation: 10, exclude: 95}";
  sample.draws = {
      {"sun", Turns::all, 2e-3, true,
       [](LimitWorld& w, Random& r) {
         w.sensor.sun = SunLimit{r.direction() + Vec3(0, 0, 1), r.uniform(10, 50)};
       }},
  };
  return sample;
}

template <>
void move<Limit::sun>(SunLimit& limit, const Motion& motion) {
  limit.direction = motion.turn * limit.direction;
}

template <>
void change_soups_of<Limit::sun>(SunLimit& /*limit*/, const ChangeMesh& /*change*/) {}

template <>
void expect_same<Limit::sun>(const SunLimit& found, const SunLimit& expected) {
  EXPECT_LT((found.direction.normalized() - expected.direction.normalized()).norm(), 1e-12);
  EXPECT_EQ(found.exclude_deg, expected.exclude_deg);
}

}  // namespace vantage::testing
