#include <memory>

#include "closed_mesh.h"
#include "limit_attack.h"

namespace attack {

using vantage::Box;
using vantage::KeepInMesh;
using vantage::Mesh;
using vantage::Vec3;
using KeepInMeshes = std::vector<KeepInMesh>;

namespace {

/// What is not convex: a block without one of its corners.
Mesh bent_block(const Vec3& low, const Vec3& high) {
  const Vec3 middle = (low + high) / 2;
  Mesh mesh;
  const double x[3] = {low.x(), middle.x(), high.x()}, y[3] = {low.y(), middle.y(), high.y()};
  constexpr int kOutline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {low.z(), high.z()}) {
    for (const auto& [i, j] : kOutline) mesh.vertices.emplace_back(x[i], y[j], z);
  }
  constexpr std::uint32_t kTop[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  for (const auto& [a, b, d] : kTop) {
    mesh.triangles.push_back({a + 6, b + 6, d + 6});
    mesh.triangles.push_back({a, d, b});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  return mesh;
}

void draw_airspace(Random& random, MeshCase& c) {
  const Box box = box_about(random, draw_place(c, random), 5, 25);
  c.navigation.meshes = {{random.chance(0.75) ? block(box.min, box.max) : bent_block(box.min, box.max), "airspace"}};
  if (random.chance(0.3)) {  // turned
    const Vec3 middle = (box.min + box.max) / 2;
    const Eigen::Matrix3d turned = random.rotation();
    for (Vec3& v : c.navigation.meshes[0].mesh.vertices) v = middle + turned * (v - middle);
  }
}

/// About the first of its corners, where numbers are small.
struct AirspaceOracle {
  explicit AirspaceOracle(const KeepInMesh& of)
      : limit("mesh " + of.name), origin(of.mesh.vertices.empty() ? Vec3(0, 0, 0) : of.mesh.vertices[0]) {
    Mesh local = of.mesh;
    for (Vec3& v : local.vertices) v -= origin;
    mesh = std::make_unique<ClosedMesh>(local);
  }
  double margin(const Vec3& p) const {
    const double distance = mesh->distance(p - origin);
    return mesh->locate(p - origin) == Place::inside ? distance : -distance;
  }

  std::string limit;
  Vec3 origin;
  std::unique_ptr<ClosedMesh> mesh;
};

}  // namespace

template <>
LimitFacts facts_of<Limit::meshes>() {
  return {"meshes", {"mesh "}, {"meshes:"}, true, {{6, "mesh", draw_airspace}}};
}

template <>
bool is_exact<Limit::meshes>(const KeepInMeshes& /*limit*/) {
  return false;
}

template <>
void draw_in_case<Limit::meshes>(CaseDraws& /*draws*/) {}

template <>
void draw_in_flight<Limit::meshes>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::meshes>(MissionDraws& draws) {
  Random& random = draws.random;
  if (!random.chance(0.08)) return;
  const auto add = [&](const Vec3& low, const Vec3& high) {
    draws.meshes.push_back({block(draws.placed(low), draws.placed(high)), "airspace"});
  };
  add(random.point(-30, -2), random.point(2, 30));
}

template <>
void draw_in_tour<Limit::meshes>(TourDraws& /*draws*/) {}

template <>
void add_anchors<Limit::meshes>(const KeepInMeshes& limit, const Vec3& /*middle*/, std::vector<Vec3>& anchors) {
  for (const KeepInMesh& mesh : limit) {
    anchors.insert(anchors.end(), mesh.mesh.vertices.begin(), mesh.mesh.vertices.end());
  }
}

template <>
void add_places<Limit::meshes>(const KeepInMeshes& /*limit*/, MeshPlaces& /*places*/) {}  // others meet it often

template <>
AddMargins margins_of<Limit::meshes>(const KeepInMeshes& limit, const SeenBy& /*by*/) {
  const auto oracles = std::make_shared<std::vector<AirspaceOracle>>(limit.begin(), limit.end());
  return [oracles](const Vec3& p, std::vector<Margin>& margins) {
    for (const AirspaceOracle& oracle : *oracles) {
      const double margin = oracle.margin(p);
      add_margin(margins, {oracle.limit, margin, margin});
    }
  };
}

template <>
void move<Limit::meshes>(KeepInMeshes& limit, const Placement& pose) {
  for (KeepInMesh& mesh : limit) pose.move(mesh.mesh);
}

template <>
void leave_out<Limit::meshes>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.meshes.clear();
}

template <>
void add_text<Limit::meshes>(const KeepInMeshes& limit, MissionLines& lines) {
  for (const KeepInMesh& mesh : limit) lines.navigation += "  # mesh to stay in: " + mesh.name + "\n";
}

template <>
void write_beside<Limit::meshes>(const KeepInMeshes& limit, WrittenClaim& claim) {
  claim.mission.navigation.meshes.clear();
  for (const KeepInMesh& mesh : limit) {
    const std::string name = mesh.name + ".ply";
    write_ply(mesh.mesh, claim.folder / name);
    claim.mission.navigation_meshes.push_back({std::filesystem::absolute(claim.folder / name), name});
  }
}

}  // namespace attack
