// Flights that are degenerate on purpose.
#include <cmath>
#include <memory>

#include "draw.h"
#include "flights.h"
#include "limit_attack.h"
#include "missions.h"
#include "random.h"
#include "vantage/mission.h"

namespace attack {
namespace {

using vantage::Mission;
using vantage::Vec3;

Mission mission_of_case(const Case& c) {
  Mission mission;
  auto loaded = std::make_shared<vantage::LoadedScene>();
  loaded->scene = c.scene;
  mission.loaded = loaded;
  mission.target = c.parts[0];
  for (std::size_t i = 1; i < c.parts.size(); ++i) mission.target.parts.push_back(c.parts[i].parts[0]);
  mission.sensor = c.sensor;
  mission.sensor.max_range_m = c.range;
  mission.navigation = c.navigation;
  return mission;
}

class FlightDrawing {
 public:
  FlightDrawing(std::uint64_t seed, std::size_t index) : random_(seed * 0x9e3779b97f4a7c15ull + 77 * index + 5) {
    for (int k = 0; k < 3; ++k) random_.next();
    drawn_.seed = random_.next();
    if (random_.chance(0.6)) {
      draw_from_case(seed + 1000, index);
    } else {
      draw_from_mission(seed + 1000, index);
    }
    size_ = range_limit_m(drawn_.mission.sensor);
    drawn_.scale = size_;
    find_anchors();
  }

  DrawnFlight run() {
    vantage::Flight& flight = drawn_.flight;
    const int legs = random_.integer(1, 6);
    for (int i = 0; i < legs; ++i) add_leg();
    if (random_.chance(0.05)) flight.points.resize(1);
    for (vantage::FlightPoint& point : flight.points) {
      if (random_.chance(0.3)) point.hold_s = random_.pick({1.0, 30.0, 1e-3});
      if (random_.chance(0.3)) point.speed_m_s = random_.uniform(1, 20);
    }
    draw_options();
    if (random_.chance(0.3)) draw_link();
    return drawn_;
  }

 private:
  void draw_from_case(std::uint64_t seed, std::size_t index) {
    Case c = draw_case(seed, index);
    drawn_.kind = c.kind;
    if (c.scale == 1e-3 && !c.sensor.link && random_.chance(0.3)) make_smaller(c);
    FlightDraws draws{random_, c};
    const auto draw = [&](auto limit) { draw_in_flight<limit>(draws); };
    every_sensor_limit(draw);
    every_navigation_limit<Limit::clearance>(draw);
    drawn_.mission = mission_of_case(c);
  }

  /// A world of micrometres.
  static void make_smaller(Case& c) {
    constexpr double kSmaller = 1e-3;
    for (Vec3& v : c.scene.mesh.vertices) v *= kSmaller;
    for (vantage::Target& part : c.parts) {
      for (Vec3& v : part.parts[0]) v *= kSmaller;
      part.offset_m *= kSmaller;
    }
    c.range *= kSmaller;
    c.sensor.min_range_m *= kSmaller;
    c.navigation = {};
    c.kind += ", micrometres";
  }

  void draw_from_mission(std::uint64_t seed, std::size_t index) {
    const DrawnMission drawn = draw_mission(seed, index);
    drawn_.kind = "mission";
    auto loaded = std::make_shared<vantage::LoadedScene>();
    loaded->scene = drawn.scene;
    std::string text = drawn.text;
    if (const std::size_t at = text.find(", visible: "); at != std::string::npos)
      text.erase(at, text.find('}', at) - at);
    drawn_.mission = resolve_mission(vantage::read_mission_text(text, "drawn.yaml", {}), loaded);
    drawn_.mission.navigation.meshes = drawn.meshes;
  }

  /// Places at which something changes.
  void find_anchors() {
    const Mission& mission = drawn_.mission;
    const auto add_target = [&](const vantage::Target& target) {
      for (const std::vector<Vec3>& part : target.parts) targets_.insert(targets_.end(), part.begin(), part.end());
    };
    add_target(mission.target);
    for (const auto& list : mission.views) {
      for (const vantage::Target& target : list) add_target(target);
    }
    middle_ = targets_[0];
    every_limit<Limit::keep_in, Limit::keep_out, Limit::meshes>([&](auto limit) {
      const auto* value = given<limit>(mission.navigation, mission.sensor);
      if (value != nullptr) add_anchors<limit>(*value, middle_, limits_);
    });
  }

  /// Not in worlds so small that a point on a surface is raised out of them.
  void draw_link() {
    constexpr double kSmall = 1;
    if (size_ < kSmall) return;
    vantage::FlightLink link{"link", random_.chance(0.3) ? place() : near_target()};
    if (random_.chance(0.3)) link.point = one_of(drawn_.flight.points).position;
    if (random_.chance(0.5)) link.max_range_m = size_ * random_.uniform(0.1, 2);
    if (random_.chance(0.4))
      link.radio = vantage::RadioLink{random_.pick({0.4, 2.4, 5.8, 60.0}), random_.uniform(0.3, 1)};
    drawn_.mission.links.push_back(link);
  }

  const vantage::Mesh& mesh() const { return drawn_.mission.scene().mesh; }
  template <typename T>
  const T& one_of(const std::vector<T>& of) {
    return of[static_cast<std::size_t>(random_.next() % of.size())];
  }
  Vec3 near_target() {
    const double away = random_.chance(0.3) ? random_.magnitude(1e-3, 1) : random_.uniform(0.02, 1.1);
    Vec3 direction = random_.direction();
    if (random_.chance(0.6)) direction.z() = std::abs(direction.z());
    return middle_ + away * size_ * direction;
  }
  Vec3 corner_of_scene() {
    if (mesh().empty()) return near_target();
    return mesh().vertices[one_of(mesh().triangles)[static_cast<std::size_t>(random_.integer(0, 2))]];
  }
  std::array<Vec3, 3> triangle() {
    if (mesh().empty()) return {near_target(), near_target(), near_target()};
    const vantage::Triangle& t = one_of(mesh().triangles);
    return {mesh().vertices[t[0]], mesh().vertices[t[1]], mesh().vertices[t[2]]};
  }
  double across() { return random_.uniform(-0.5, 1.5) * (random_.chance(0.3) ? 4 : 1); }

  Vec3 place() {
    switch (random_.integer(0, 9)) {
      case 0:
        return corner_of_scene();
      case 1: {  // beyond an obstacle's corner, seen from one of the target
        const Vec3 from = one_of(targets_);
        return from + random_.uniform(0.5, 4) * (corner_of_scene() - from);
      }
      case 2:
        return one_of(targets_) + random_.uniform(0, 0.3) * size_ * Vec3::UnitZ();
      case 3:
        return limits_.empty() ? near_target() : one_of(limits_);
      case 4:
        return middle_ + random_.uniform(1, 30) * size_ * random_.direction();
      default:
        return near_target();
    }
  }

  /// Two places of a leg, and what is special about it.
  std::pair<Vec3, Vec3> leg(std::string& kind) {
    const auto [a, b, c] = triangle();
    const Vec3 &target = one_of(targets_), &other = one_of(targets_);
    switch (random_.integer(0, 13)) {
      case 0:
        kind = "in a facet's plane";
        return {a + across() * (b - a) + across() * (c - a), a + across() * (b - a) + across() * (c - a)};
      case 1:
        kind = "along an edge";
        return {a + across() * (b - a), a + across() * (b - a)};
      case 2: {
        kind = "through a wall";
        const Vec3 middle = (a + b + c) / 3, along = random_.direction() * size_ * random_.uniform(0.05, 1);
        return {middle - along, middle + random_.uniform(0, 1) * along};
      }
      case 3: {
        kind = "touches an edge";
        const Vec3 on = a + random_.uniform(0, 1) * (b - a),
                   along = random_.direction() * size_ * random_.uniform(0.05, 1);
        return {on - along, on + along};
      }
      case 4:
        kind = "in the border of a shadow";  // the plane through an edge and a corner of the target
        return {target + across() * 2 * (a - target) + across() * (b - a),
                target + across() * 2 * (a - target) + across() * (b - a)};
      case 5:
        kind = "in the border of a shadow";  // likewise of a side and a corner
        return {a + across() * 2 * (a - target) + across() * (other - target),
                a + across() * 2 * (a - target) + across() * (other - target)};
      case 6:
        kind = "in the target's plane";
        return {target + across() * 5 * (other - target) + across() * 5 * (one_of(targets_) - target),
                target + across() * 5 * (other - target) + across() * 5 * (one_of(targets_) - target)};
      case 7: {
        kind = "vertical";
        const Vec3 at = place();
        return {at, {at.x(), at.y(), at.z() + random_.uniform(-1, 1) * size_}};
      }
      case 8: {
        kind = "no length";
        const Vec3 at = place();
        return {at, at};
      }
      case 9:
        kind = "to the target";
        return {place(), random_.chance(0.5) ? target : Vec3(target + random_.uniform(0, 1) * (other - target))};
      case 10: {
        kind = "along a line of sight";
        const Vec3 through = place();
        return {target + random_.uniform(0, 1) * (through - target),
                target + random_.uniform(0.5, 3) * (through - target)};
      }
      case 11: {
        kind = "on a limit";
        if (limits_.size() < 2) return {place(), place()};
        const Vec3& at = one_of(limits_);
        Vec3 to = one_of(limits_);
        if (random_.chance(0.5)) to = at + random_.uniform(-1, 1) * size_ * Vec3::Unit(random_.integer(0, 2));
        return {at, to};
      }
      case 12: {
        kind = "short";
        const Vec3 at = place();
        return {at, at + size_ * random_.magnitude(1e-9, 1e-2) * random_.direction()};
      }
      default:
        kind = "at random";
        return {place(), place()};
    }
  }

  void add_leg() {
    std::string kind;
    const auto [from, to] = leg(kind);
    auto& points = drawn_.flight.points;
    if (points.empty() || random_.chance(0.7)) points.push_back({from});
    points.push_back({to});
    drawn_.kind += "; " + kind;
  }

  void draw_options() {
    vantage::FlightCheckOptions& options = drawn_.options;
    if (random_.chance(0.3)) options.tube_radius_m = size_ * random_.magnitude(1e-5, 0.05);
    if (random_.chance(0.15)) drawn_.flight.chord_error_m = size_ * random_.magnitude(1e-6, 1e-3);
    if (random_.chance(0.8)) options.speed_m_s = random_.uniform(1, 15);
    if (options.speed_m_s && random_.chance(0.4)) options.dwell_s = random_.magnitude(1e-3, 30);
    if (random_.chance(0.4)) options.clearance_m = random_.chance(0.2) ? 0 : size_ * random_.magnitude(1e-4, 0.3);
    if (random_.chance(0.3)) options.gimbal_rate_deg_s = random_.magnitude(0.1, 100);
  }

  Random random_;
  DrawnFlight drawn_;
  double size_ = 1;
  Vec3 middle_ = Vec3::Zero();
  std::vector<Vec3> targets_, limits_;
};

}  // namespace

DrawnFlight draw_flight(std::uint64_t seed, std::size_t index) { return FlightDrawing(seed, index).run(); }

}  // namespace attack
