// Meshes that are claimed to be volumes: right ones, and what somebody makes of them who wants a wrong one to pass.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "limit_attack.h"
#include "mesh_case.h"
#include "vantage/error.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace attack {
namespace {

using vantage::Mesh;
using vantage::Triangle;

/// A solid about the origin, of about that size.
Mesh solid(Random& random, double size) {
  Mesh mesh;
  const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh.triangles.push_back({a, b, c}); };
  switch (random.integer(0, 3)) {
    case 0:
      mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
      face(0, 1, 2);
      face(0, 3, 1);
      face(0, 2, 3);
      face(1, 3, 2);
      break;
    case 1:
      mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
      for (const auto& [x, y, z] : {std::array{0u, 2u, 4u}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}}) {
        face(x, y, z);
        face(y, x, 5);
      }
      break;
    default:
      for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      for (const auto& [p, q, r, s] :
           {std::array{0u, 2u, 3u, 1u}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        face(p, q, r);
        face(p, r, s);
      }
  }
  const Eigen::Matrix3d turned = random.chance(0.5) ? random.rotation() : Eigen::Matrix3d::Identity();
  const Vec3 stretch = random.point(0.3, 1);
  for (Vec3& v : mesh.vertices) v = size * (turned * v.cwiseProduct(stretch));
  return mesh;
}

/// From near the target to far from it, along lines of sight: as volumes are.
Mesh stump(Random& random, const Vec3& centre, const Vec3& at, double size) {
  const Vec3 way = at - centre, ahead = way.normalized(), side = ahead.unitOrthogonal(), up = ahead.cross(side);
  const double near = random.uniform(0.05, 0.95), spread = size / way.norm();
  const int count = random.integer(3, 5);
  Mesh mesh;
  for (const double share : {1.0, near}) {
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * std::numbers::pi * i / count;
      mesh.vertices.push_back(centre +
                              share * way.norm() * (ahead + spread * (std::cos(turn) * side + std::sin(turn) * up)));
    }
  }
  const auto n = static_cast<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, n + i, n + next});
    mesh.triangles.push_back({i, n + next, next});
    if (i >= 2) {
      mesh.triangles.push_back({0, i - 1, i});
      mesh.triangles.push_back({n, n + i, n + i - 1});
    }
  }
  return mesh;
}

void turn_round(Mesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& origin = mesh.vertices[0];
    volume += (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return volume;
}

/// From a base to a tip.
Mesh spike(Random& random, const Vec3& base, const Vec3& tip, double size) {
  const Vec3 side = (tip - base).unitOrthogonal(), up = side.cross(tip - base).normalized();
  Mesh mesh;
  const double begin = random.uniform(0, 2);
  for (int i = 0; i < 3; ++i) {
    const double turn = begin + 2 * std::numbers::pi * i / 3;
    mesh.vertices.push_back(base + size * (std::cos(turn) * side + std::sin(turn) * up));
  }
  mesh.vertices.push_back(tip);
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  if (signed_volume(mesh) < 0) turn_round(mesh);
  return mesh;
}

void add(Mesh& mesh, const Mesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

class MeshDrawing {
 public:
  MeshDrawing(MeshCase& c, Random& random)
      : c_(c), random_(random), oracle_(c), centre_(vantage::make_target_frame(c.target).origin) {
    std::vector<Vec3> places;
    add_special_places(places);
    for (int i = 0; i < 80; ++i) places.push_back(draw_place(c, random));
    const auto broken = oracle_.broken(places);
    for (std::size_t i = 0; i < places.size(); ++i) (broken[i].empty() ? good_ : c_.suspects).push_back(places[i]);
  }

  void draw() {
    const int count = random_.pick({1, 1, 2, 3});
    for (int i = 0; i < count; ++i) add_shell();
    if (random_.chance(0.08)) add_computed();
    for (int changes = random_.pick({0, 0, 0, 1, 1, 2}); changes > 0; --changes) change();
    constexpr std::size_t kMost = 24;  // some of all
    for (std::size_t i = 0; i < kMost && c_.suspects.size() > kMost; ++i) {
      c_.suspects[i] = c_.suspects[i * c_.suspects.size() / kMost];
    }
    if (c_.suspects.size() > kMost) c_.suspects.resize(kMost);
  }

 private:
  /// Where limits are, which other places rarely meet.
  void add_special_places(std::vector<Vec3>& places) {
    MeshPlaces around{random_, c_, centre_, places};
    every_limit<Limit::sun, Limit::keep_in, Limit::keep_out, Limit::min_range, Limit::frame>([&](auto limit) {
      const auto* value = given<limit>(c_.navigation, c_.sensor);
      if (value != nullptr) attack::add_places<limit>(*value, around);
    });
  }

  const Vec3& pick(const std::vector<Vec3>& places) {
    return places[static_cast<std::size_t>(random_.integer(0, static_cast<int>(places.size()) - 1))];
  }

  Vec3 any_place() {
    if (!c_.suspects.empty() && random_.chance(0.6)) return pick(c_.suspects);
    return good_.empty() ? draw_place(c_, random_) : pick(good_);
  }

  Mesh shell_at(const Vec3& at, double size) {
    if (random_.chance(0.4)) return stump(random_, centre_, at, size);
    Mesh mesh = solid(random_, size);
    for (Vec3& v : mesh.vertices) v += at;
    return mesh;
  }

  bool is_good(const Mesh& mesh) {
    const auto broken = oracle_.broken(mesh.vertices);
    return std::all_of(broken.begin(), broken.end(), [](const auto& claims) { return claims.empty(); });
  }

  /// One whose corners are all right, if there is one.
  Mesh good_shell() {
    const Vec3 at = good_.empty() ? draw_place(c_, random_) : pick(good_);
    double size = (at - centre_).norm() * random_.magnitude(0.01, 0.8);
    for (int tries = 0; tries < 5; ++tries, size *= 0.4) {
      Mesh mesh = shell_at(at, size);
      if (is_good(mesh)) return mesh;
    }
    return shell_at(at, size);
  }

  void add_shell() {
    if (random_.chance(0.85)) return add(c_.volume, good_shell());
    c_.kind += ", shell";
    const Vec3 at = any_place();
    add(c_.volume, shell_at(at, (at - centre_).norm() * random_.magnitude(1e-3, 0.5)));
  }

  /// As the engine makes it, coarse.
  void add_computed() {
    if (c_.both_sides || c_.target.parts.size() > 1) return;
    try {
      const vantage::PreparedTarget target(vantage::PreparedScene(c_.scene), c_.target, c_.sensor);
      vantage::Volume volume = vantage::compute_visibility(target, {0.05 * vantage::range_limit_m(c_.sensor), 1});
      if (c_.sensor.limits_view() || !c_.navigation.empty()) {
        volume = vantage::cut_to_limits(volume, target, c_.navigation);
      }
      constexpr std::size_t kMostFacets = 1500;
      if (volume.mesh.empty() || volume.mesh.triangles.size() > kMostFacets || target.lift_m() > 0) return;
      if (random_.chance(0.7)) c_.volume = {};
      add(c_.volume, volume.mesh);
      c_.kind += ", computed";
    } catch (const vantage::Error&) {  // it needs no volume
    }
  }

  std::uint32_t any_vertex() {
    return static_cast<std::uint32_t>(random_.integer(0, static_cast<int>(c_.volume.vertices.size()) - 1));
  }

  void change() {
    using Change = void (MeshDrawing::*)();
    static constexpr Change kChanges[] = {
        &MeshDrawing::move_vertex,  &MeshDrawing::move_to_limit, &MeshDrawing::hang_on,    &MeshDrawing::hang_on,
        &MeshDrawing::poke_out,     &MeshDrawing::poke_out,      &MeshDrawing::add_flap,   &MeshDrawing::add_cube,
        &MeshDrawing::make_hollow,  &MeshDrawing::double_it,     &MeshDrawing::turn_shell, &MeshDrawing::grow,
        &MeshDrawing::cancel_shell, &MeshDrawing::take_apart,    &MeshDrawing::split,      &MeshDrawing::wring};
    // What is allowed by a camera that turns has the most facets that nobody looks at.
    if (c_.sensor.camera && random_.chance(0.4)) return hang_on();
    (this->*kChanges[random_.integer(0, static_cast<int>(std::size(kChanges)) - 1)])();
  }

  void move_vertex() {
    c_.kind += ", vertex";
    c_.volume.vertices[any_vertex()] = any_place();
  }

  /// To where the claims end on the way to a suspect, a little before or behind it.
  void move_to_limit() {
    if (c_.suspects.empty()) return;
    c_.kind += ", near a limit";
    Vec3& vertex = c_.volume.vertices[any_vertex()];
    Vec3 kept = vertex, broken = pick(c_.suspects);
    if (!oracle_.broken({kept})[0].empty()) return;
    for (int step = 0; step < 40; ++step) {
      const Vec3 between = (kept + broken) / 2;
      (oracle_.broken({between})[0].empty() ? kept : broken) = between;
    }
    vertex = kept + random_.uniform(-3, 3) * random_.pick({1e-9, 1e-6, 1e-4}) * (kept - centre_).norm() *
                        (broken - vertex).stableNormalized();
  }

  /// A shell inside out that shares a vertex: it counts as one piece with the other.
  void hang_on() {
    c_.kind += ", hung on";
    const std::uint32_t shared = any_vertex();
    const Vec3& from = c_.volume.vertices[shared];
    const double size = (from - centre_).norm() * random_.magnitude(0.01, 0.3);
    Mesh mesh;
    switch (random_.integer(0, 2)) {
      case 0:
        mesh = stump(random_, centre_, from, size);
        break;
      case 1:
        mesh = spike(random_, from, centre_ + random_.magnitude(0.01, 0.5) * (from - centre_), size);
        break;
      default:
        mesh = shell_at(any_place(), size);
    }
    if (random_.chance(0.8)) turn_round(mesh);
    const auto first = static_cast<std::uint32_t>(c_.volume.vertices.size());
    add(c_.volume, mesh);
    for (auto t = c_.volume.triangles.end() - static_cast<std::ptrdiff_t>(mesh.triangles.size());
         t != c_.volume.triangles.end(); ++t) {
      for (std::uint32_t& v : *t) {
        if (v == first) v = shared;
      }
    }
  }

  /// A shell inside out that begins in another one.
  void poke_out() {
    c_.kind += ", poking out";
    const Mesh around = c_.volume;
    Vec3 inside = Vec3::Zero();
    const int corners = std::min<int>(4, static_cast<int>(around.vertices.size()));
    for (int i = 0; i < corners; ++i) inside += around.vertices[static_cast<std::size_t>(i)] / corners;
    const Vec3 to = any_place(), way = to - inside;
    const double width = way.norm() * random_.magnitude(1e-3, 0.2);
    Mesh mesh = solid(random_, width);
    // Most of it there, and the first corner, by which it is known where it lies, here.
    for (Vec3& v : mesh.vertices) v += to;
    mesh.vertices[0] = inside + 1e-3 * width * random_.direction();
    if ((signed_volume(mesh) > 0) == random_.chance(0.9)) turn_round(mesh);
    add(c_.volume, mesh);
  }

  void add_flap() {
    c_.kind += ", flap";
    const Vec3 at = any_place();
    const double size = (at - centre_).norm() * random_.magnitude(1e-3, 0.5);
    add(c_.volume, {{at, at + size * random_.direction(), at + size * random_.direction()}, {{0, 1, 2}, {0, 2, 1}}});
  }

  void add_cube() {
    c_.kind += ", cube";
    const Vec3 at = any_place();
    Mesh mesh = solid(random_, (at - centre_).norm() * random_.magnitude(1e-4, 0.1));
    for (Vec3& v : mesh.vertices) v += at;
    add(c_.volume, mesh);
  }

  void make_hollow() {
    c_.kind += ", hollow";
    Mesh mesh = c_.volume;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : mesh.vertices) middle += v / static_cast<double>(mesh.vertices.size());
    const double share = random_.uniform(0.05, 1.2);
    for (Vec3& v : mesh.vertices) v = middle + share * (v - middle);
    turn_round(mesh);
    add(c_.volume, mesh);
  }

  void double_it() {
    c_.kind += ", twice";
    Mesh mesh = c_.volume;
    const Vec3 by = random_.magnitude(1e-6, 0.3) * (c_.volume.vertices[0] - centre_).norm() * random_.direction();
    for (Vec3& v : mesh.vertices) v += by;
    add(c_.volume, mesh);
  }

  void turn_shell() {
    c_.kind += ", turned round";
    Mesh mesh = good_shell();
    turn_round(mesh);
    add(c_.volume, mesh);
  }

  void grow() {
    c_.kind += ", grown";
    const double by = 1 + random_.sign() * random_.magnitude(1e-8, 1e-2);
    for (Vec3& v : c_.volume.vertices) v = centre_ + by * (v - centre_);
  }

  /// A shell somewhere and the same inside out: nothing.
  void cancel_shell() {
    c_.kind += ", cancelled";
    const Vec3 at = any_place();
    Mesh mesh = solid(random_, (at - centre_).norm() * random_.magnitude(1e-3, 0.3));
    for (Vec3& v : mesh.vertices) v += at;
    add(c_.volume, mesh);
    turn_round(mesh);
    add(c_.volume, mesh);
  }

  /// Each facet with vertices of its own, as files without shared ones have them.
  void take_apart() {
    c_.kind += ", taken apart";
    Mesh apart;
    for (const Triangle& t : c_.volume.triangles) {
      const auto first = static_cast<std::uint32_t>(apart.vertices.size());
      for (const std::uint32_t v : t) apart.vertices.push_back(c_.volume.vertices[v]);
      apart.triangles.push_back({first, first + 1, first + 2});
    }
    c_.volume = apart;
    if (random_.chance(0.5)) change();
  }

  /// Of some facets an edge is cut in two, and a needle without area lies on it.
  void split() {
    c_.kind += ", needles";
    for (int count = random_.integer(1, 4); count > 0; --count) {
      const auto which = static_cast<std::size_t>(random_.integer(0, static_cast<int>(c_.volume.triangles.size()) - 1));
      const auto [a, b, c] = c_.volume.triangles[which];
      const auto between = static_cast<std::uint32_t>(c_.volume.vertices.size());
      c_.volume.vertices.emplace_back((c_.volume.vertices[a] + c_.volume.vertices[b]) / 2);
      c_.volume.triangles[which] = {a, between, c};
      c_.volume.triangles.push_back({between, b, c});
      c_.volume.triangles.push_back({a, b, between});
    }
  }

  /// The far side of it turned about its middle, through itself: lobes of both orientations.
  void wring() {
    c_.kind += ", wrung";
    const Vec3 to = any_place();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : c_.volume.vertices) middle += v / static_cast<double>(c_.volume.vertices.size());
    const Vec3 along = (to - middle).stableNormalized();
    const double stretch = random_.uniform(-3, 1.5);
    for (Vec3& v : c_.volume.vertices) {
      const double over = along.dot(v - middle);
      if (over > 0) v += (stretch - 1) * over * along;
    }
  }

  MeshCase& c_;
  Random& random_;
  QueryOracle oracle_;
  Vec3 centre_;
  std::vector<Vec3> good_;
};

}  // namespace

std::optional<MeshCase> draw_mesh_case(std::uint64_t seed, std::size_t index) {
  Random random(seed * 0x9e3779b97f4a7c15ull + index);
  for (int k = 0; k < 3; ++k) random.next();
  MeshCase c = draw_claim(random);
  c.seed = random.next();
  try {
    MeshDrawing(c, random).draw();
  } catch (const vantage::Error&) {  // it stands in a house, or a limit excludes another one
    return std::nullopt;
  }
  if (random.chance(0.005)) {  // for neither is there a proof
    c.kind += ", share or link";
    if (c.target.is_point()) {
      c.sensor.link = vantage::RadioLink{2.4, 0.6};
    } else {
      c.sensor.visible = vantage::VisibleShare{0.5, 4};
    }
  }
  return c;
}

}  // namespace attack
