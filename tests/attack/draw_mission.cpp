#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <set>

#include "limit_attack.h"
#include "missions.h"
#include "random.h"

namespace attack {
namespace {

using vantage::ObjectKind;
using vantage::Vec3;

std::string exactly(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string pair(double low, double high) { return "[" + exactly(low) + ", " + exactly(high) + "]"; }

std::string triple(const Vec3& p) { return "[" + exactly(p.x()) + ", " + exactly(p.y()) + ", " + exactly(p.z()) + "]"; }

/// Lengths are drawn as if the range were some tens of metres, and scaled.
class MissionDrawing {
 public:
  MissionDrawing(std::uint64_t seed, std::size_t index) : random_(seed * 0x9e3779b97f4a7c15ull + index) {
    for (int k = 0; k < 3; ++k) random_.next();
    drawn_.seed = random_.next();
    if (random_.chance(0.3)) scale_ = random_.pick({1e-3, 1e-1, 1e2, 1e4});
    if (random_.chance(0.3)) shift_ = random_.pick({Vec3(-3e6, 4.7e6, 0), Vec3(5.8e5, 4.785e6, 120)});
    range_ = random_.uniform(15, 50);
  }

  DrawnMission run() {
    draw_scene();
    draw_targets();
    draw_sensor();
    draw_navigation();
    text_ += "exact: {tolerance: " + exactly(scale_ * range_ * random_.magnitude(1e-3, 2e-2)) + "}\n";
    drawn_.text = text_;
    return drawn_;
  }

 private:
  Vec3 placed(const Vec3& p) const { return scale_ * p + shift_; }
  std::string length(double metres) const { return exactly(scale_ * metres); }
  MissionDraws limit_draws() { return {random_, scale_, range_, shift_, has_ground_, {}, {}, {}}; }

  void begin_object(const std::string& name, ObjectKind kind) { drawn_.scene.objects.push_back({name, "", kind}); }
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    auto& [vertices, triangles] = drawn_.scene.mesh;
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Vec3& p : {a, b, c}) vertices.push_back(placed(p));
    triangles.push_back({first, first + 1, first + 2});
    drawn_.scene.object_of.push_back(static_cast<std::uint32_t>(drawn_.scene.objects.size() - 1));
  }
  void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
  }
  void add_box(const Vec3& low, const Vec3& high);
  void draw_ground();
  void draw_scene();

  std::vector<Vec3> polygon();
  std::string polygon_text(const std::vector<Vec3>& corners) const;
  std::string front_text();
  std::string target();
  void draw_targets();
  void draw_sensor();
  void draw_navigation();

  Random random_;
  DrawnMission drawn_;
  std::string text_;
  double scale_ = 1, range_ = 0;
  Vec3 shift_ = Vec3::Zero();
  bool has_ground_ = false, are_points_ = true;
  std::vector<std::string> boxes_;
};

void MissionDrawing::add_box(const Vec3& low, const Vec3& high) {
  Vec3 p[8];
  for (int i = 0; i < 8; ++i) {
    p[i] = Vec3(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  add_quad(p[0], p[2], p[3], p[1]);
  add_quad(p[4], p[5], p[7], p[6]);
  add_quad(p[0], p[1], p[5], p[4]);
  add_quad(p[2], p[6], p[7], p[3]);
  add_quad(p[0], p[4], p[6], p[2]);
  add_quad(p[1], p[3], p[7], p[5]);
}

void MissionDrawing::draw_ground() {
  begin_object("ground", ObjectKind::ground);
  has_ground_ = true;
  if (random_.chance(0.6)) {
    add_quad({-70, -70, 0}, {70, -70, 0}, {70, 70, 0}, {-70, 70, 0});
    return;
  }
  constexpr int kPosts = 6;
  double z[kPosts][kPosts];
  for (auto& row : z) {
    for (double& post : row) post = random_.chance(0.3) ? 0 : random_.uniform(-1, 1);
  }
  const auto post = [&](int i, int k) { return Vec3(28 * i - 70, 28 * k - 70, z[i][k]); };
  for (int i = 0; i + 1 < kPosts; ++i) {
    for (int k = 0; k + 1 < kPosts; ++k) {
      add_triangle(post(i, k), post(i + 1, k), post(i + 1, k + 1));
      add_triangle(post(i, k), post(i + 1, k + 1), post(i, k + 1));
    }
  }
}

void MissionDrawing::draw_scene() {
  if (random_.chance(0.7)) draw_ground();
  for (int i = random_.integer(0, 4); i > 0; --i) {
    boxes_.push_back("b" + std::to_string(boxes_.size()));
    begin_object(boxes_.back(), ObjectKind::building);
    const double away = random_.uniform(9, 30), angle = random_.uniform(0, 2 * std::numbers::pi);
    const Vec3 low(away * std::cos(angle), away * std::sin(angle), random_.pick({0.0, 0.0, -1.0, 3.0}));
    add_box(low, low + Vec3(random_.uniform(1, 8), random_.uniform(1, 8), random_.uniform(1, 20)));
  }
  begin_object("soup", ObjectKind::other);
  const int count = drawn_.scene.mesh.empty() ? random_.integer(1, 6) : random_.integer(0, 8);
  for (int i = 0; i < count; ++i) {
    const Vec3 at = random_.point(-18, 18).cwiseProduct(Vec3(1, 1, 0.4)) + Vec3(0, 0, 8);
    add_triangle(at, at + random_.point(-6, 6), at + random_.point(-6, 6));
  }
}

/// Convex: on an ellipse.
std::vector<Vec3> MissionDrawing::polygon() {
  const int count = random_.integer(3, 7);
  std::set<double> angles;
  while (static_cast<int>(angles.size()) < count) {
    const double angle = random_.uniform(0, 2 * std::numbers::pi);
    const bool is_apart =
        std::none_of(angles.begin(), angles.end(), [&](double other) { return std::abs(other - angle) < 0.1; });
    if (is_apart) angles.insert(angle);
  }
  const double a = random_.uniform(0.5, 4), b = random_.uniform(0.5, 4);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 centre = random_.point(-5, 5);
  centre.z() = 0.02;
  if (random_.chance(0.3)) turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // upright, along the axes
  if (random_.chance(0.4)) turn = random_.rotation();
  if (!turn.isIdentity() || random_.chance(0.2)) centre.z() = random_.uniform(5, 15);
  std::vector<Vec3> corners;
  for (const double angle : angles) {
    corners.push_back(centre + turn * Vec3(a * std::cos(angle), b * std::sin(angle), 0));
  }
  return corners;
}

std::string MissionDrawing::polygon_text(const std::vector<Vec3>& corners) const {
  std::string text;
  for (const Vec3& corner : corners) text += (text.empty() ? "[" : ", ") + triple(placed(corner));
  return text + "]";
}

std::string MissionDrawing::front_text() { return ", front: " + triple(random_.direction()); }

std::string MissionDrawing::target() {
  const int kind = random_.integer(0, 19);
  const std::string sides = random_.chance(0.45) ? ", sides: both" : "";
  if (kind < 3) {
    const std::string point = "point: " + triple(placed(random_.point(-5, 5) + Vec3(0, 0, 9)));
    return point + (random_.chance(0.4) ? front_text() : "");
  }
  are_points_ = false;
  if (kind < 5 && has_ground_) {  // a T, or a comb
    const double x = random_.uniform(2, 5), y = random_.uniform(1, 3), bar = random_.uniform(0.3, 1);
    const std::vector<std::pair<double, double>> tee = {{-x, 0},      {x, 0},        {x, y},    {bar, y},
                                                        {bar, 3 * y}, {-bar, 3 * y}, {-bar, y}, {-x, y}};
    const std::vector<std::pair<double, double>> ell = {{-x, 0},      {x, 0},           {x, y},
                                                        {bar - x, y}, {bar - x, 3 * y}, {-x, 3 * y}};
    std::string text;
    for (const auto& [u, v] : random_.chance(0.5) ? tee : ell) {
      const Vec3 at = placed({u, v, 0});
      text += (text.empty() ? "outline: [" : ", ") + pair(at.x(), at.y());
    }
    return text + "], offset: " + length(0.05) + sides;
  }
  if (kind < 7 && !boxes_.empty()) {
    std::string text = "object: " + boxes_[static_cast<std::size_t>(random_.integer(0, 100)) % boxes_.size()];
    text += random_.chance(0.5) ? ", part: roof" : ", part: facade";
    if (random_.chance(0.6)) text += ", facing: " + std::to_string(90 * random_.integer(0, 3));
    return text + sides;
  }
  if (kind < 9) {
    const std::vector<Vec3> whole = polygon();
    std::string text = "parts: [" + polygon_text(whole);
    std::vector<Vec3> other = whole;  // in the same plane, or turned a little
    for (Vec3& corner : other) corner += 1.5 * (whole[1] - whole[0]);
    if (random_.chance(0.5)) other = polygon();
    return text + ", " + polygon_text(other) + "]" + sides;
  }
  return "vertices: " + polygon_text(polygon()) + sides + (random_.chance(0.5) ? front_text() : "");
}

void MissionDrawing::draw_targets() {
  if (random_.chance(0.4)) {
    text_ += "target: {" + target() + "}\n";
  } else {
    text_ += "targets:\n";
    const int count = random_.integer(2, 4);
    for (int i = 0; i < count; ++i) text_ += "  - {name: t" + std::to_string(i) + ", " + target() + "}\n";
  }
  text_ += std::string("combine: ") + random_.pick({"all", "any", "each"}) + "\n";
}

void MissionDrawing::draw_sensor() {
  text_ += "sensor: {max_range: " + length(range_);
  if (are_points_ && random_.chance(0.5)) {
    const double clear = random_.uniform(0.2, 1), excess = scale_ * range_ * random_.magnitude(1e-6, 1e-3);
    const double frequency = 0.299792458 * clear * clear / (2 * excess);
    if (frequency < 3000) text_ += ", link: {frequency: " + exactly(frequency) + ", clear: " + exactly(clear) + "}";
  }
  MissionDraws draws = limit_draws();
  every_sensor_limit<Limit::min_range, Limit::incidence, Limit::sun>(
      [&](auto limit) { draw_in_mission<limit>(draws); });
  text_ += draws.sensor;
  if (!are_points_ && random_.chance(0.08)) {
    text_ += ", visible: " + exactly(random_.uniform(0.4, 0.95)) + ", cells: " + std::to_string(random_.integer(1, 5));
  }
  text_ += "}\n";
}

void MissionDrawing::draw_navigation() {
  MissionDraws draws = limit_draws();
  every_navigation_limit<Limit::altitude, Limit::above_ground, Limit::clearance>(
      [&](auto limit) { draw_in_mission<limit>(draws); });
  if (!draws.navigation.empty()) text_ += "navigation: {" + draws.navigation + "}\n";
  drawn_.meshes = draws.meshes;
}

}  // namespace

DrawnMission draw_mission(std::uint64_t seed, std::size_t index) { return MissionDrawing(seed, index).run(); }

namespace {

void write_mesh(const vantage::Mesh& mesh, std::ostream& out, const std::function<void(std::size_t)>& before_triangle) {
  for (const Vec3& v : mesh.vertices) {
    out << "v " << exactly(v.x()) << " " << exactly(v.y()) << " " << exactly(v.z()) << "\n";
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    before_triangle(t);
    const auto& [a, b, c] = mesh.triangles[t];
    out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  }
}

/// The text with the meshes among the limits.
std::string with_meshes(std::string text, const std::vector<std::string>& files) {
  if (files.empty()) return text;
  std::string keys = "meshes: [";
  for (const std::string& file : files) keys += (file == files.front() ? "" : ", ") + file;
  keys += "]";
  const std::string head = "navigation: {";
  const std::size_t at = text.find(head);
  if (at == std::string::npos) return text + head + keys + "}\n";
  return text.insert(at + head.size(), keys + ", ");
}

}  // namespace

void write_drawn_mission(const DrawnMission& drawn, const std::string& folder) {
  const std::filesystem::path place = folder;
  std::filesystem::create_directories(place);
  std::vector<std::string> files;
  for (const vantage::KeepInMesh& mesh : drawn.meshes) {
    files.push_back(mesh.name + ".obj");
    std::ofstream out(place / files.back());
    write_mesh(mesh.mesh, out, [](std::size_t) {});
  }
  std::ofstream(place / "mission.yaml") << "scene: {mesh: scene.obj}\n" << with_meshes(drawn.text, files);
  std::ofstream out(place / "scene.obj");
  std::uint32_t last = ~0u;
  write_mesh(drawn.scene.mesh, out, [&](std::size_t t) {
    const std::uint32_t number = drawn.scene.object_of[t];
    if (number == last) return;
    last = number;
    const vantage::SceneObject& object = drawn.scene.objects[number];
    out << "o " << object.name << "\n# vantage object: {\"name\":\"" << object.name << "\",\"kind\":\""
        << name_of(object.kind) << "\"}\n";
  });
}

}  // namespace attack
