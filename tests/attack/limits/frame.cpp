// Limit::frame: of a camera, and of its mount.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "limit_attack.h"
#include "vantage/camera.h"

namespace attack {

using vantage::Pinhole;
using vantage::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace

// ---- draws ----

void claim_camera(Random& random, MeshCase& c) {
  c.fov_deg = {random.uniform(15, 90), random.uniform(12, 70)};
  c.sensor.camera = vantage::pinhole_of_fov(c.fov_deg[0], c.fov_deg[1], 400, 300);
  vantage::Mount& mount = c.sensor.mount;
  const Vec3 way = middle_of(c) - draw_place(c, random);  // somebody can look from there
  const double yaw = std::atan2(way.x(), way.y()) / kRadiansPerDegree,
               pitch = std::atan2(way.z(), way.head<2>().norm()) / kRadiansPerDegree;
  if (random.chance(0.35)) {
    mount.yaw_deg = yaw + random.uniform(-5, 5);
    mount.min_pitch_deg = mount.max_pitch_deg = std::clamp(pitch + random.uniform(-5, 5), -90.0, 90.0);
  } else if (random.chance(0.5)) {
    if (random.chance(0.3)) mount.yaw_deg = yaw;
    mount.min_pitch_deg = std::clamp(pitch - random.uniform(0, 50), -90.0, 89.0);
    mount.max_pitch_deg = std::clamp(pitch + random.uniform(0, 50), mount.min_pitch_deg, 90.0);
  }
  if (random.chance(0.3)) mount.roll_deg = random.uniform(-180, 180);
}

template <>
LimitFacts facts_of<Limit::frame>() {
  return {"frame",
          {"frame", "gimbal"},
          {"fov:", "mount:", "gimbal:"},
          false,
          {{11, "frame", claim_camera}, {12, "frame", claim_camera}}};
}

template <>
bool is_exact<Limit::frame>(const Pinhole& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::frame>(CaseDraws& /*draws*/) {}

/// And the size of a pixel.
template <>
void draw_in_flight<Limit::frame>(FlightDraws& draws) {
  auto& [random_, c] = draws;
  if (c.sensor.link || !random_.chance(0.25)) return;
  c.sensor.camera = vantage::pinhole_of_fov(random_.uniform(15, 120), random_.uniform(15, 90), 4000, 3000);
  if (random_.chance(0.6)) {
    const double low = random_.uniform(-90, 60);
    c.sensor.mount.min_pitch_deg = low;
    c.sensor.mount.max_pitch_deg = random_.chance(0.4) ? low : random_.uniform(low, 90);
    c.sensor.mount.roll_deg = random_.chance(0.5) ? 0 : random_.uniform(-180, 180);
    if (random_.chance(0.4)) c.sensor.mount.yaw_deg = random_.uniform(0, 360);
  }
  if (random_.chance(0.4) && (!c.parts[0].is_point() || c.parts[0].front)) {
    c.sensor.pixel = vantage::PixelLimit{c.range * random_.magnitude(2e-5, 1e-3), vantage::PixelLimit::Kind::worst};
    if (random_.chance(0.3)) c.sensor.pixel->kind = vantage::PixelLimit::Kind::perpendicular;
  }
  c.kind += ", camera";
}

namespace {

std::string camera_in_mission(Random& random_, bool& has_pixels) {
  std::string text = ", fov: " + exact_pair(random_.uniform(20, 90), random_.uniform(20, 70));
  has_pixels = random_.chance(0.7);
  if (has_pixels) text += ", camera: {width: 4000, height: 3000}";
  const std::string roll = ", roll: " + exact_text(random_.chance(0.5) ? 0 : random_.uniform(-90, 90));
  const double low = random_.uniform(-90, 60);
  if (random_.chance(0.3)) {
    const std::string yaw = random_.chance(0.5) ? "any" : exact_text(random_.uniform(0, 360));
    return text + ", mount: {yaw: " + yaw + ", pitch: " + exact_text(low) + roll + "}";
  }
  if (random_.chance(0.5)) text += ", gimbal: {pitch: " + exact_pair(low, random_.uniform(low, 90)) + roll + "}";
  return text;
}

}  // namespace

/// Likewise.
template <>
void draw_in_mission<Limit::frame>(MissionDraws& draws) {
  Random& random_ = draws.random;
  if (!random_.chance(0.25)) return;
  bool has_pixels = false;
  draws.sensor += camera_in_mission(random_, has_pixels);
  if (has_pixels && random_.chance(0.5)) {
    draws.sensor += ", pixel: {size: " + draws.length(draws.range * random_.magnitude(1e-4, 1e-3)) +
                    ", kind: " + random_.pick({"worst", "perpendicular"}) + "}";
  }
}

template <>
void draw_in_tour<Limit::frame>(TourDraws& /*draws*/) {}

template <>
void add_anchors<Limit::frame>(const Pinhole& /*limit*/, const Vec3& /*middle*/, std::vector<Vec3>& /*anchors*/) {}

template <>
void add_places<Limit::frame>(const Pinhole& /*limit*/, MeshPlaces& places) {
  places.about(places.centre, 8 * places.c.unit);
}

// ---- the oracle ----

namespace {

/// The picture's four sides, of unit length and inwards, for a yaw and a pitch: docs/camera.md, "Conventions".
std::array<Vec3, 4> picture_sides(const vantage::Pinhole& camera, double yaw, double pitch, double roll) {
  const Vec3 ahead(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch));
  const Vec3 level(std::cos(yaw), -std::sin(yaw), 0), under = ahead.cross(level);
  const Vec3 right = std::cos(roll) * level + std::sin(roll) * under;
  const Vec3 down = std::cos(roll) * under - std::sin(roll) * level;
  return {(camera.half_width * ahead - right).normalized(), (camera.half_width * ahead + right).normalized(),
          (camera.half_height * ahead - down).normalized(), (camera.half_height * ahead + down).normalized()};
}

/// Of the best orientation of the camera that a search finds.
double in_picture(const SeenBy& by, const Vec3& p) {
  const vantage::Mount& mount = by.sensor.mount;
  const auto value = [&](double yaw, double pitch) {
    double least = kInfinity;
    for (const Vec3& side : picture_sides(*by.sensor.camera, yaw, pitch, mount.roll_deg * kRadiansPerDegree)) {
      for (const SeenTarget& part : by.parts) {
        for (const Vec3& corner : part.corners) least = std::min(least, side.dot(corner - p));
      }
    }
    return least;
  };
  const double low = mount.min_pitch_deg * kRadiansPerDegree, high = mount.max_pitch_deg * kRadiansPerDegree;
  if (mount.is_fixed()) return value(*mount.yaw_deg * kRadiansPerDegree, low);
  struct Start {
    double value, yaw, pitch;
  };
  std::vector<Start> starts;
  const int yaws = mount.yaw_deg ? 1 : 72, pitches = low == high ? 1 : 37;
  for (int i = 0; i < yaws; ++i) {
    for (int k = 0; k < pitches; ++k) {
      const double yaw = mount.yaw_deg ? *mount.yaw_deg * kRadiansPerDegree : 2 * std::numbers::pi * i / yaws;
      const double pitch = pitches == 1 ? low : low + (high - low) * k / (pitches - 1);
      starts.push_back({value(yaw, pitch), yaw, pitch});
    }
  }
  std::sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.value > b.value; });
  double best = starts[0].value;
  for (std::size_t s = 0; s < std::min<std::size_t>(6, starts.size()); ++s) {
    Start at = starts[s];
    double turn = 0;                          // of the directions, so that a sharp ridge is met along it some time
    for (double step = 0.1; step > 1e-12;) {  // a pattern search: the first of 16 directions that is better
      bool is_better = false;
      turn += 0.7548776662466927;
      for (int d = 0; d < 16 && !is_better; ++d) {
        const double angle = turn + 2 * std::numbers::pi * d / 16;
        const double yaw = mount.yaw_deg ? at.yaw : at.yaw + step * std::cos(angle);
        const double pitch = std::clamp(at.pitch + step * std::sin(angle), low, high);
        const double there = value(yaw, pitch);
        is_better = there > at.value;
        if (is_better) at = {there, yaw, pitch};
      }
      step *= is_better ? 1.3 : 0.8;
    }
    best = std::max(best, at.value);
  }
  return best;
}

/// One corner and one side of the picture, for a pitch: how deep the corner is in it is
/// size cos(yaw - best) + height.
struct YawWave {
  double size, best, height;
};

/// Whether a yaw has all of them at least so deep. Where there is one, there is one at the beginning of an arc.
bool has_yaw(const std::vector<YawWave>& waves, double depth, const std::optional<double>& fixed_yaw) {
  constexpr double kTurn = 2 * std::numbers::pi, kSlack = 1e-12;
  struct Arc {
    double middle, half;
  };
  std::vector<Arc> arcs;
  for (const YawWave& wave : waves) {
    const double needed = depth - wave.height;
    if (needed <= -wave.size) continue;
    if (needed > wave.size) return false;
    arcs.push_back({wave.best, std::acos(needed / wave.size) + kSlack});
  }
  const auto is_in_all = [&](double yaw) {
    return std::all_of(arcs.begin(), arcs.end(), [&](const Arc& arc) {
      return std::abs(std::remainder(yaw - arc.middle, kTurn)) <= arc.half + kSlack;
    });
  };
  if (fixed_yaw) return is_in_all(*fixed_yaw);
  return arcs.empty() ||
         std::any_of(arcs.begin(), arcs.end(), [&](const Arc& arc) { return is_in_all(arc.middle - arc.half); });
}

/// False only where no orientation has all corners at least `depth` inside of the picture's sides. A change of the
/// pitch turns these by as much, so that no depth changes by more than that times the distance: where the middle of a
/// part lacks more, no pitch of that part does.
bool may_be_in_picture(const SeenBy& by, const Vec3& p, double depth, double farthest) {
  constexpr int kMostParts = 4000;
  const vantage::Mount& mount = by.sensor.mount;
  const std::optional<double> yaw =
      mount.yaw_deg ? std::optional(*mount.yaw_deg * kRadiansPerDegree) : std::optional<double>();
  const auto has_orientation = [&](double pitch, double deep) {
    std::vector<YawWave> waves;
    for (const Vec3& side : picture_sides(*by.sensor.camera, 0, pitch, mount.roll_deg * kRadiansPerDegree)) {
      for (const SeenTarget& part : by.parts) {
        for (const Vec3& corner : part.corners) {
          const Vec3 d = corner - p;
          const double cosine = side.x() * d.x() + side.y() * d.y(), sine = side.y() * d.x() - side.x() * d.y();
          waves.push_back({std::hypot(cosine, sine), std::atan2(sine, cosine), side.z() * d.z()});
        }
      }
    }
    return has_yaw(waves, deep - 1e-13 * farthest, yaw);
  };
  std::vector<std::pair<double, double>> open{
      {mount.min_pitch_deg * kRadiansPerDegree, mount.max_pitch_deg * kRadiansPerDegree}};
  for (int parts = 0; !open.empty(); ++parts) {
    if (parts >= kMostParts) return true;  // it is not sure
    const auto [low, high] = open.back();
    open.pop_back();
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    if (!has_orientation(middle, depth - half * farthest)) continue;
    if (has_orientation(middle, depth) || !(half > 0)) return true;
    open.emplace_back(low, middle);
    open.emplace_back(middle, high);
  }
  return false;
}

/// `low`: of the best orientation that is found. `high`: no orientation has more.
Margin picture_margin(const SeenBy& by, const Vec3& p) {
  const double found = in_picture(by, p);
  const bool turns = !by.sensor.mount.is_fixed();
  if (found >= 0 || !turns) return {"frame", found, found, false, turns};
  double farthest = 0;
  for (const SeenTarget& part : by.parts) {
    for (const Vec3& corner : part.corners) farthest = std::max(farthest, (corner - p).norm());
  }
  double most = 0;
  for (double depth = -1e-10 * farthest; depth > -farthest; depth *= 4) {
    if (may_be_in_picture(by, p, depth, farthest)) break;
    most = depth;
  }
  return {"frame", found, std::max(found, most), false, turns};
}

}  // namespace

template <>
AddMargins margins_of<Limit::frame>(const Pinhole& /*limit*/, const SeenBy& by) {
  return [&by](const Vec3& p, std::vector<Margin>& margins) { add_margin(margins, picture_margin(by, p)); };
}

// ---- changes and texts ----

template <>
void move<Limit::frame>(Pinhole& /*limit*/, const Placement& /*pose*/) {}

template <>
void leave_out<Limit::frame>(vantage::Navigation& /*navigation*/, vantage::Sensor& sensor) {
  sensor.camera.reset();
  sensor.mount = {};
  sensor.pixel.reset();
}

template <>
void add_text<Limit::frame>(const Pinhole& limit, MissionLines& lines) {
  const vantage::Mount& mount = lines.mount;
  lines.sensor += "  # camera: " + exact_pair(limit.half_width, limit.half_height) + ", pitch " +
                  exact_pair(mount.min_pitch_deg, mount.max_pitch_deg) + ", roll " + exact_text(mount.roll_deg) +
                  ", yaw " + (mount.yaw_deg ? exact_text(*mount.yaw_deg) : "any") + "\n";
}

template <>
void write_beside<Limit::frame>(const Pinhole& limit, WrittenClaim& claim) {
  const bool has_pixels = limit.width_px > 0;
  claim.mission.camera =
      vantage::CameraFov{claim.c.fov_deg, has_pixels ? limit.width_px : 0, has_pixels ? limit.height_px : 0};
}

}  // namespace attack
