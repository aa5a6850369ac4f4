#include "flight_margins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "sensor_oracle.h"

namespace attack {
namespace {

using Plan = Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

double distance_to_side(const Plan& p, const Plan& a, const Plan& b) {
  const Plan side = b - a;
  const double square = side.squaredNorm();
  const double share = square > 0 ? std::clamp((p - a).dot(side) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * side).norm();
}

/// Above 0 inside of the polygon with its holes: the distance from the nearest side.
double room_in_plan(const vantage::Zone& zone, const Plan& p) {
  double nearest = kInfinity;
  bool is_inside = false;
  const auto add = [&](const vantage::Zone::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Plan a = ring[i] - p, b = ring[(i + 1) % ring.size()] - p;
      nearest = std::min(nearest, distance_to_side(Plan::Zero(), a, b));
      if ((a.y() > 0) == (b.y() > 0)) continue;
      const double cross = a.x() * b.y() - a.y() * b.x();
      if ((cross > 0) == (b.y() > a.y())) is_inside = !is_inside;
    }
  };
  add(zone.outer);
  for (const vantage::Zone::Ring& hole : zone.holes) add(hole);
  return is_inside ? nearest : -nearest;
}

/// z of the pieces of ground at a place.
struct Pieces {
  double lowest = kInfinity, highest = -kInfinity;
  double beside = kInfinity;  ///< how far the nearest triangle is, in plan; 0 on one

  bool is_there() const { return lowest <= highest; }
};

Pieces pieces_at(const vantage::Ground& ground, const Plan& p) {
  if (!ground.surface) return {ground.plane_z_m, ground.plane_z_m, 0};
  Pieces pieces;
  for (const vantage::Triangle& t : ground.surface->triangles) {
    Vec3 c[3];
    for (int k = 0; k < 3; ++k) c[k] = ground.surface->vertices[t[k]] - Vec3(p.x(), p.y(), 0);
    double weight[3], sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
      weight[k] = a.x() * b.y() - a.y() * b.x();
      sum += weight[k];
    }
    if (sum == 0) continue;
    const bool holds = std::all_of(weight, weight + 3, [&](double w) { return w * sum >= 0; });
    if (holds) {
      const double z = (weight[0] * c[0].z() + weight[1] * c[1].z() + weight[2] * c[2].z()) / sum;
      pieces.lowest = std::min(pieces.lowest, z);
      pieces.highest = std::max(pieces.highest, z);
      pieces.beside = 0;
    } else {
      for (int k = 0; k < 3; ++k) {
        pieces.beside =
            std::min(pieces.beside, distance_to_side(Plan::Zero(), c[k].head<2>(), Plan(c[(k + 1) % 3].head<2>())));
      }
    }
  }
  return pieces;
}

/// The place and four beside it, so near that only rounding tells them apart.
std::vector<Plan> near_places(const vantage::Ground& ground, const Vec3& p) {
  std::vector<Plan> places{p.head<2>()};
  if (!ground.surface) return places;
  double size = p.head<2>().cwiseAbs().maxCoeff();
  for (const Vec3& v : ground.surface->vertices) size = std::max(size, (v - p).head<2>().norm());
  const double step = 1e-9 * size;
  for (const Plan& aside :
       {Plan(step, 0.3 * step), Plan(-step, -0.3 * step), Plan(-0.3 * step, step), Plan(0.3 * step, -step)}) {
    places.push_back(places[0] + aside);
  }
  return places;
}

/// The least and the greatest value over places.
template <typename Value>
Margin between(const std::string& limit, const std::vector<Plan>& places, const Value& value) {
  Margin margin{limit, kInfinity, -kInfinity};
  for (const Plan& place : places) {
    const double at = value(place);
    margin.low = std::min(margin.low, at);
    margin.high = std::max(margin.high, at);
  }
  return margin;
}

/// Above 0 inside of what the zone holds. `to_leave`: over ground in pieces a zone to leave reaches from above the
/// lowest to above the highest one, and a place without ground is in it.
Margin margin_in_zone(const vantage::Zone& zone, const Vec3& p, bool to_leave) {
  const double in_heights = std::min(p.z() - zone.min_z_m, zone.max_z_m - p.z());
  const auto joined = [](double plan, double heights) {
    if (plan >= 0 || heights >= 0) return std::min(plan, heights);
    return -std::hypot(plan, heights);
  };
  const double plain = joined(room_in_plan(zone, p.head<2>()), in_heights);
  if (!zone.above_ground) return {"", plain, plain};
  const auto& [low, high, ground] = *zone.above_ground;
  return between("", near_places(ground, p), [&, low = low, high = high](const Plan& place) {
    const Pieces pieces = pieces_at(ground, place);
    if (!pieces.is_there()) return to_leave ? plain : std::min(plain, -pieces.beside);
    const double from = to_leave ? pieces.lowest : pieces.highest, to = to_leave ? pieces.highest : pieces.lowest;
    return std::min({plain, p.z() - from - low, to + high - p.z()});
  });
}

void add(std::vector<Margin>& margins, const std::string& limit, double low, double high) {
  for (Margin& margin : margins) {
    if (margin.limit != limit) continue;
    margin.low = std::min(margin.low, low);
    margin.high = std::min(margin.high, high);
    return;
  }
  margins.push_back({limit, low, high});
}

double distance_to_part(const SeenTarget& part, const Vec3& p) {
  if (part.is_point()) return (p - part.corners[0]).norm();
  double least = kInfinity;
  for (std::size_t i = 0; i < part.fan(); ++i) least = std::min(least, distance_to_triangle(p, part.fan_triangle(i)));
  return least;
}

}  // namespace

double margin_in_box(const vantage::Box& box, const Vec3& p) {
  const Vec3 inside = (p - box.min).cwiseMin(box.max - p);
  const double least = inside.minCoeff();
  return least >= 0 ? least : -inside.cwiseMin(0).norm();
}

NavigationMargins::NavigationMargins(const vantage::Navigation& navigation) : navigation_(navigation) {
  for (const vantage::KeepInMesh& limit : navigation.meshes) {
    vantage::Mesh local = limit.mesh;
    const Vec3 origin = local.vertices.empty() ? Vec3(0, 0, 0) : local.vertices[0];
    for (Vec3& v : local.vertices) v -= origin;
    meshes_.push_back({"mesh " + limit.name, origin, ClosedMesh(local)});
  }
}

std::vector<Margin> NavigationMargins::at(const Vec3& p) const {
  std::vector<Margin> margins;
  if (navigation_.altitude) {
    const double above = p.z() - navigation_.altitude->min_m, below = navigation_.altitude->max_m - p.z();
    add(margins, "altitude min", above, above);
    add(margins, "altitude max", below, below);
  }
  if (navigation_.above_ground) {
    const auto& [low, high, ground] = *navigation_.above_ground;
    const std::vector<Plan> places = near_places(ground, p);
    const auto add_between = [&](const char* limit, const auto& value) {
      const Margin margin = between(limit, places, [&](const Plan& place) { return value(pieces_at(ground, place)); });
      add(margins, limit, margin.low, margin.high);
    };
    add_between("ground edge", [](const Pieces& g) { return g.is_there() ? kInfinity : -g.beside; });
    add_between("agl min",
                [&, low = low](const Pieces& g) { return g.is_there() ? p.z() - g.highest - low : kInfinity; });
    add_between("agl max",
                [&, high = high](const Pieces& g) { return g.is_there() ? g.lowest + high - p.z() : kInfinity; });
  }
  const auto margin_in = [&](const vantage::Zone& zone, bool is_kept_out) {
    if (!zone.is_box) return margin_in_zone(zone, p, is_kept_out);
    const double margin = margin_in_box(zone.box(), p);
    return Margin{"", margin, margin};
  };
  if (!navigation_.keep_in.empty()) {
    double low = -kInfinity, high = -kInfinity;
    for (const vantage::Zone& zone : navigation_.keep_in) {
      const Margin margin = margin_in(zone, false);
      low = std::max(low, margin.low);
      high = std::max(high, margin.high);
    }
    add(margins, "keep_in", low, high);
  }
  for (std::size_t i = 0; i < navigation_.keep_out.size(); ++i) {
    const Margin margin = margin_in(navigation_.keep_out[i], true);
    add(margins, "keep_out " + vantage::zone_name(navigation_.keep_out, i), -margin.high, -margin.low);
  }
  for (const ClosedLimit& limit : meshes_) {
    const Vec3 local = p - limit.origin;
    const double distance = limit.mesh.distance(local);
    const double margin = limit.mesh.locate(local) == Place::inside ? distance : -distance;
    add(margins, limit.limit, margin, margin);
  }
  if (navigation_.clearance) {
    double nearest = kInfinity;
    const vantage::Mesh& obstacles = *navigation_.clearance->obstacles;
    for (const vantage::Triangle& t : obstacles.triangles) {
      nearest = std::min(nearest,
                         distance_to_triangle(Vec3::Zero(), {obstacles.vertices[t[0]] - p, obstacles.vertices[t[1]] - p,
                                                             obstacles.vertices[t[2]] - p}));
    }
    const double margin = nearest - navigation_.clearance->distance_m;
    add(margins, "clearance", margin, margin);
  }
  return margins;
}

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

}  // namespace

double SensorMargins::in_picture(const Vec3& p) const {
  const vantage::Mount& mount = sensor_.mount;
  const auto value = [&](double yaw, double pitch) {
    double least = kInfinity;
    for (const Vec3& side : picture_sides(*sensor_.camera, yaw, pitch, mount.roll_deg * kRadiansPerDegree)) {
      for (const SeenTarget& part : parts_) {
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

namespace {

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

}  // namespace

// A change of the pitch turns the sides of the picture by as much, so that no depth changes by more than that times the
// distance: where the middle of a part lacks more, no pitch of that part does.
bool SensorMargins::may_be_in_picture(const Vec3& p, double depth, double farthest) const {
  constexpr int kMostParts = 4000;
  const vantage::Mount& mount = sensor_.mount;
  const std::optional<double> yaw =
      mount.yaw_deg ? std::optional(*mount.yaw_deg * kRadiansPerDegree) : std::optional<double>();
  const auto has_orientation = [&](double pitch, double deep) {
    std::vector<YawWave> waves;
    for (const Vec3& side : picture_sides(*sensor_.camera, 0, pitch, mount.roll_deg * kRadiansPerDegree)) {
      for (const SeenTarget& part : parts_) {
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

Margin SensorMargins::picture_margin(const Vec3& p) const {
  const double found = in_picture(p);
  if (found >= 0 || sensor_.mount.is_fixed()) return {"frame", found, found};
  double farthest = 0;
  for (const SeenTarget& part : parts_) {
    for (const Vec3& corner : part.corners) farthest = std::max(farthest, (corner - p).norm());
  }
  double most = 0;
  for (double depth = -1e-10 * farthest; depth > -farthest; depth *= 4) {
    if (may_be_in_picture(p, depth, farthest)) break;
    most = depth;
  }
  return {"frame", found, std::max(found, most)};
}

std::vector<Margin> SensorMargins::at(const Vec3& p) const {
  std::vector<Margin> margins;
  const double range = range_limit_m(sensor_);
  for (const SeenTarget& part : parts_) {
    double farthest = 0;
    for (const Vec3& corner : part.corners) farthest = std::max(farthest, (corner - p).norm());
    add(margins, "max_range", range - farthest, range - farthest);
    if (!part.all_sides) add(margins, "behind", part.height(p), part.height(p));
    if (sensor_.min_range_m > 0) {
      const double margin = distance_to_part(part, p) - sensor_.min_range_m;
      add(margins, "min_range", margin, margin);
    }
    for (const Vec3& corner : part.corners) {
      const double height = part.normal.dot(p - corner);
      if (sensor_.incidence_deg) {
        const double angle = *sensor_.incidence_deg * kRadiansPerDegree;
        const double margin = height * std::sin(angle) - (p - corner - height * part.normal).norm() * std::cos(angle);
        add(margins, "incidence", margin, margin);
      }
      if (sensor_.pixel && sensor_.pixel->kind == vantage::PixelLimit::Kind::worst && !part.all_sides) {
        const double radius = 0.5 * sensor_.pixel->size_m * *sensor_.camera->focal_px;
        const double margin = radius - (p - corner - radius * part.normal).norm();
        add(margins, "pixel", margin, margin);
      }
    }
    if (sensor_.sun) {
      const double margin = -0.5 * depth_in_sun(*sensor_.sun, part, p);
      add(margins, "sun", margin, margin);
    }
  }
  if (sensor_.camera) {
    const Margin margin = picture_margin(p);
    add(margins, margin.limit, margin.low, margin.high);
  }
  return margins;
}

}  // namespace attack
