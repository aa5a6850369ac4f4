// Towns of boxes, targets on their roofs, walls and streets, and regions in their air.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "limit_attack.h"
#include "random.h"
#include "tours.h"
#include "vantage/error.h"

namespace attack {
namespace {

using vantage::Scene;
using vantage::TourVehicle;
using vantage::Vec3;

std::string tour_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

void add_mesh_box(vantage::Mesh& mesh, const Vec3& middle, const Vec3& half, const Eigen::Matrix3d& turn) {
  constexpr std::uint32_t kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
    mesh.vertices.push_back(middle + turn * corner);
  }
  for (const auto& face : kFaces) mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
}

struct Building {
  Vec3 middle = Vec3::Zero(), half = Vec3::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();

  Vec3 at(double x, double y, double z) const { return middle + turn * Vec3(x * half.x(), y * half.y(), z * half.z()); }
  /// Smallest distance in plan, below 0 inside.
  double away(const Vec3& p) const {
    const Vec3 local = turn.transpose() * (p - middle);
    return std::max(std::abs(local.x()) - half.x(), std::abs(local.y()) - half.y());
  }
};

class TourDrawing {
 public:
  TourDrawing(std::uint64_t seed, std::size_t index) : random_(seed * 0x9e3779b97f4a7c15ull + 131 * index + 11) {
    for (int k = 0; k < 3; ++k) random_.next();
    drawn_.seed = random_.next();
    is_mission_ = index % 4 != 3;
  }

  DrawnTour run() {
    size_ = random_.uniform(40, 120);
    draw_town();
    limits_.size = size_;
    limits_.has_ground = has_ground_;
    draw_settings();
    draw_navigation();
    if (is_mission_) {
      draw_mission();
    } else {
      draw_regions();
    }
    return drawn_;
  }

 private:
  void end_object(const std::string& name, vantage::ObjectKind kind) {
    const auto object = static_cast<std::uint32_t>(drawn_.scene.objects.size());
    drawn_.scene.objects.push_back({name, "", kind});
    drawn_.scene.object_of.resize(drawn_.scene.mesh.triangles.size(), object);
  }

  Building draw_building() {
    Building building;
    building.half = {random_.uniform(3, 15), random_.uniform(3, 15), random_.magnitude(1.5, 25)};
    building.middle = {random_.uniform(-size_, size_), random_.uniform(-size_, size_), building.half.z()};
    const double turn = random_.chance(0.5) ? 0 : random_.uniform(0, 2 * std::numbers::pi);
    building.turn = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    if (random_.chance(0.1)) building.middle.z() += random_.uniform(3, 20);  // a bridge
    return building;
  }

  void draw_town() {
    if (random_.chance(0.7)) {
      vantage::Mesh& mesh = drawn_.scene.mesh;
      const double far = 5 * size_;
      mesh.vertices = {{-far, -far, 0}, {far, -far, 0}, {far, far, 0}, {-far, far, 0}};
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
      end_object("ground", vantage::ObjectKind::ground);
      has_ground_ = true;
    }
    const int count = random_.integer(2, 12);
    for (int i = 0; i < count; ++i) {
      Building building;
      bool is_free = false;
      for (int tries = 0; tries < 30 && !is_free; ++tries) {
        building = draw_building();
        is_free = std::none_of(buildings_.begin(), buildings_.end(), [&](const Building& other) {
          return (other.middle - building.middle).head<2>().norm() <
                 other.half.head<2>().norm() + building.half.head<2>().norm() + 0.5;
        });
      }
      if (!is_free) continue;
      add_mesh_box(drawn_.scene.mesh, building.middle, building.half, building.turn);
      end_object("house " + std::to_string(i), vantage::ObjectKind::building);
      buildings_.push_back(building);
    }
    drawn_.kind = std::to_string(count) + " houses" + (has_ground_ ? " on ground" : "");
  }

  void draw_settings() {
    vantage::TourSettings& settings = drawn_.settings;
    if (random_.chance(0.35)) {
      settings.vehicle.kind = TourVehicle::Kind::fixed_wing;
      settings.vehicle.turn_radius_m = random_.uniform(8, 30);
      settings.vehicle.min_climb_deg = -random_.uniform(8, 30);
      settings.vehicle.max_climb_deg = random_.uniform(8, 30);
    }
    settings.vehicle.speed_m_s = random_.uniform(2, 15);
    settings.closed = random_.chance(0.7);
    settings.dwell_s = random_.chance(0.15) ? 0 : random_.magnitude(0.1, 6);
    settings.margin_m = random_.chance(0.15) ? 0 : random_.magnitude(0.05, 1.5);
    if (settings.vehicle.kind == TourVehicle::Kind::fixed_wing) settings.dwell_s = std::min(settings.dwell_s, 1.0);
    settings.simultaneous = random_.chance(0.3);
    settings.clearance_m = random_.chance(0.15) ? 0 : random_.magnitude(0.3, 8);
    settings.tube_m = random_.chance(0.3) ? 0 : random_.magnitude(0.1, 2);
    settings.gap = random_.pick({0.01, 0.1, 0.3});
    settings.time_limit_s = 1.5;
    drawn_.kind += settings.vehicle.kind == TourVehicle::Kind::fixed_wing ? ", fixed wing" : ", multirotor";
  }

  void draw_navigation() {
    every_navigation_limit<Limit::altitude, Limit::above_ground, Limit::keep_out>(
        [&](auto limit) { draw_in_tour<limit>(limits_); });
  }

  /// Away from buildings, and from zones to stay out of, at height 0.
  std::optional<Vec3> free_place(double away_m) {
    for (int i = 0; i < 60; ++i) {
      const Vec3 p(random_.uniform(-size_, size_), random_.uniform(-size_, size_), 0);
      const auto is_near = [&](const Building& building) { return building.away(p) < away_m; };
      if (std::none_of(buildings_.begin(), buildings_.end(), is_near)) return p;
    }
    return std::nullopt;
  }

  std::vector<Vec3> outline(const Vec3& middle, const Vec3& u, const Vec3& v) {
    const int corners = random_.integer(3, 6);
    const double first = random_.uniform(0, 2 * std::numbers::pi);
    std::vector<Vec3> result;
    for (int k = 0; k < corners; ++k) {
      const double angle = first + 2 * std::numbers::pi * k / corners;
      result.push_back(middle + std::cos(angle) * u + std::sin(angle) * v);
    }
    return result;
  }

  std::vector<Vec3> target() {
    const Building& building =
        buildings_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(buildings_.size()) - 1))];
    const double size = random_.uniform(0.1, 0.8);
    switch (random_.integer(0, 3)) {
      case 0:
        return outline(building.at(0, 0, 1), size * building.half.x() * building.turn.col(0),
                       size * building.half.y() * building.turn.col(1));
      case 1:
        return outline(building.at(1, 0, 0), size * building.half.y() * building.turn.col(1),
                       size * building.half.z() * building.turn.col(2));
      case 2: {  // in the air, upright
        const Vec3 along = random_.rotation() * Vec3::UnitX() * random_.uniform(0.5, 4);
        Vec3 middle = free_place(5).value_or(Vec3(0, 0, 200));
        middle.z() += random_.uniform(5, 40);
        return outline(middle, along, random_.uniform(0.3, 1) * along.unitOrthogonal() * along.norm());
      }
      default: {
        const Vec3 middle = free_place(7).value_or(Vec3(0, 0, 200));
        const double across = random_.uniform(0.5, 6);
        return outline(middle, across * Vec3::UnitX(), across * Vec3::UnitY());
      }
    }
  }

  void draw_mission() {
    std::string text = "combine: each\ntargets:\n";
    const int count = random_.integer(2, 8);
    for (int i = 0; i < count; ++i) {
      text += "  - {name: t" + std::to_string(i) + ", vertices: [";
      for (const Vec3& p : target()) {
        text += "[" + tour_number(p.x()) + ", " + tour_number(p.y()) + ", " + tour_number(p.z()) + "], ";
      }
      text.resize(text.size() - 2);
      text += "]}\n";
    }
    text += "sensor: {max_range: " + tour_number(random_.uniform(25, 90));
    every_sensor_limit<Limit::incidence, Limit::min_range>([&](auto limit) { draw_in_tour<limit>(limits_); });
    text += limits_.mission_sensor + "}\nexact: {tolerance: 0.05}\n";
    if (!limits_.mission_navigation.empty()) text += "navigation: {" + limits_.mission_navigation + "}\n";
    auto loaded = std::make_shared<vantage::LoadedScene>();
    loaded->scene = drawn_.scene;
    vantage::Mission mission =
        resolve_mission(vantage::read_mission_text(text, "drawn.yaml", vantage::SceneSource{}), loaded);
    drawn_.navigation.above_ground = mission.navigation.above_ground;
    mission.navigation = drawn_.navigation;
    if (random_.chance(0.7)) mission.home = free_place(drawn_.settings.clearance_m + 1);
    mission.as_written.tour = drawn_.settings;
    if (mission.home) mission.as_written.tour->home = vantage::TourHome{std::nullopt, mission.home};
    drawn_.mission = mission;
    drawn_.kind += ", " + std::to_string(count) + " targets" + (mission.home ? ", home" : "");
  }

  void draw_regions() {
    const int count = random_.integer(2, 12);
    for (int i = 0; i < count; ++i) {
      vantage::TourTarget& region = drawn_.regions.emplace_back();
      region.name = "region " + std::to_string(i);
      const int pieces = random_.chance(0.2) ? 2 : 1;
      for (int k = 0; k < pieces; ++k) {
        const Vec3 half(random_.magnitude(2, 14), random_.magnitude(2, 14), random_.magnitude(2, 14));
        // Two pieces are apart: one on each side of the town's middle.
        const double x =
            pieces == 2 ? (k == 0 ? -1 : 1) * random_.uniform(15, 15 + size_) : random_.uniform(-size_, size_);
        const Vec3 middle(x, random_.uniform(-size_, size_), random_.uniform(5, 50));
        const Eigen::Matrix3d turn = pieces == 2 ? Eigen::Matrix3d::Identity() : random_.rotation();
        add_mesh_box(region.volume, middle, half, turn);
      }
      if (random_.chance(0.5)) region.look_at = random_.point(-size_, size_);
    }
    if (random_.chance(0.6)) {
      drawn_.region_home = free_place(drawn_.settings.clearance_m + 1);
      if (drawn_.region_home) drawn_.region_home->z() = random_.uniform(5, 50);
    }
    drawn_.kind += ", " + std::to_string(count) + " regions" + (drawn_.region_home ? ", home" : "");
  }

  Random random_;
  DrawnTour drawn_;
  std::vector<Building> buildings_;
  double size_ = 1;
  bool is_mission_ = true, has_ground_ = false;
  TourDraws limits_{random_, 0, false, drawn_.navigation, {}, {}};
};

}  // namespace

DrawnTour draw_tour(std::uint64_t seed, std::size_t index) { return TourDrawing(seed, index).run(); }

}  // namespace attack
