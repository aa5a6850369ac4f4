#include "support/aimed_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/mesh_probe.h"
#include "support/ray_caster.h"

namespace vantage::testing {
namespace {

constexpr double kOnTarget = 1e-7;  // hits this near are what the target lies on
constexpr int kLooksAtAnEdge = 4;

class AimedCheck {
 public:
  AimedCheck(const Scene& scene, const Volume& volume, double range, Random& random)
      : scene_(scene), volume_(volume), probe_(volume), range_(range), random_(random) {}

  AimedReport run(std::size_t tries) {
    const TargetFrame& frame = volume_.frame;
    std::vector<Vec3> eyes;
    for (const auto& v : frame.polygon) eyes.push_back(frame.to_scene({v.x(), v.y(), 0}));
    for (const Vec3& eye : eyes) look_from(eye, tries);
    return report_;
  }

 private:
  void look_from(const Vec3& eye, std::size_t tries) {
    const RayCaster scene(scene_.mesh, eye), volume(volume_.mesh, eye);
    const auto& v = scene_.mesh.vertices;
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < scene_.mesh.triangles.size(); ++i)
      if ((v[scene_.mesh.triangles[i][0]] - eye).norm() < 1.2 * range_) near.push_back(i);
    for (std::size_t i = 0; i < tries && !near.empty(); i += kLooksAtAnEdge) {
      const Triangle& t =
          scene_.mesh.triangles[near[static_cast<std::size_t>(random_.integer(0, static_cast<int>(near.size()) - 1))]];
      const std::size_t side = static_cast<std::size_t>(random_.integer(0, 2));
      // As often near an end of the edge as along it: that is where creases meet.
      const double share = random_.chance(0.5) ? random_.uniform(0, 1) : std::pow(10, random_.uniform(-6, 0));
      const Vec3 way = v[t[side]] + share * (v[t[(side + 1) % 3]] - v[t[side]]) - eye;
      const double distance = way.norm();
      if (!(distance > 1e-6)) continue;
      if (scene.first_hit(way / distance, distance, kOnTarget) < distance * (1 - 2e-6)) continue;
      for (int k = 0; k < kLooksAtAnEdge; ++k) {
        const double off = std::pow(10, random_.uniform(-6, -3));
        look(scene, volume, eye, (way / distance + off * random_.direction()).normalized());
      }
    }
  }

  void look(const RayCaster& scene, const RayCaster& volume, const Vec3& eye, const Vec3& direction) {
    const TargetFrame& frame = volume_.frame;
    if (!frame.all_sides && direction.dot(frame.normal) <= 0) return;
    const double seen = scene.first_hit(direction, range_, kOnTarget);
    if (seen >= range_ * (1 - 1e-9)) return;
    ++report_.looks;
    const double claimed = volume.first_hit(direction, 1.1 * range_, 1e-5);
    if (claimed >= 1.1 * range_ || claimed <= seen * (1 + 1e-8)) return;
    for (const double share : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Vec3 place = eye + (seen + share * (claimed - seen)) * direction;
      const double depth = probe_.depth(place), relative = depth / (place - frame.origin).norm();
      if (relative <= report_.worst_share) continue;
      report_.worst_depth = depth;
      report_.worst_share = relative;
      report_.worst_place = place;
    }
  }

  const Scene& scene_;
  const Volume& volume_;
  MeshProbe probe_;
  double range_;
  Random& random_;
  AimedReport report_;
};

}  // namespace

AimedReport look_beside_edges(const Scene& scene, const Volume& volume, double range, std::size_t tries,
                              Random& random) {
  return AimedCheck(scene, volume, range, random).run(tries);
}

}  // namespace vantage::testing
