// What a volume claims wrongly: by viewpoints, and facet by facet.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "flight_margins.h"
#include "sensor_oracle.h"
#include "trial.h"

namespace attack {
namespace {

class Claims {
 public:
  explicit Claims(Trial& trial)
      : trial_(trial),
        mesh_(local_mesh(trial, trial.answer.volume)),
        navigation_(trial.c.navigation),
        sensor_(trial.c.sensor, {trial.parts[0].exact.target()}) {}

  /// False for a mesh that has no inside.
  bool check_mesh() {
    const vantage::Volume& volume = trial_.answer.volume;
    const MeshFaults found = faults(volume.mesh);
    if (found.bad_index) trial_.result.add({FindingKind::bad_mesh, 0, Vec3::Zero(), "an index is out of range"});
    if (found.open_edges > 0) {
      trial_.result.add(
          {FindingKind::bad_mesh, 0, Vec3::Zero(), std::to_string(found.open_edges) + " edges do not cancel"});
    }
    if (found.flat_facets > 0) {
      trial_.result.add(
          {FindingKind::flat_facets, 0, Vec3::Zero(), std::to_string(found.flat_facets) + " without area"});
    }
    if (volume.cause_of.size() != volume.mesh.triangles.size())
      trial_.result.add({FindingKind::bad_causes, 0, Vec3::Zero(), "not one cause a facet"});
    for (const std::uint32_t cause : volume.cause_of) {
      if (cause >= volume.causes.size())
        trial_.result.add({FindingKind::bad_causes, 0, Vec3::Zero(), "cause " + std::to_string(cause)});
    }
    trial_.result.facets = mesh_.size();
    return !found.bad_index && found.open_edges == 0;
  }

  void look() {
    std::vector<double> area(mesh_.size());
    for (std::size_t i = 0; i < mesh_.size(); ++i) area[i] = area_of(mesh_.corners(i));
    std::partial_sum(area.begin(), area.end(), area.begin());
    Random& random = trial_.random;
    const auto draw = [&](bool by_area) {
      if (!by_area) return static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh_.size()) - 1));
      const auto at = std::lower_bound(area.begin(), area.end(), random.uniform(0, area.back()));
      return std::min(static_cast<std::size_t>(at - area.begin()), mesh_.size() - 1);
    };
    for (std::size_t k = 0; k < trial_.options.facets; ++k) look_behind(draw(k % 2 == 0), 3);
    const bool is_star_shaped = trial_.c.navigation.empty() && !trial_.c.sensor.limits_view();
    for (std::size_t k = 0; k < trial_.options.viewpoints; ++k) {
      const Vec3 q = place_on(mesh_.corners(draw(true)));
      const Vec3 from = is_star_shaped ? trial_.parts[0].centre : place_on(mesh_.corners(draw(true)));
      check(from + std::cbrt(random.uniform(0, 1)) * (q - from));
    }
  }

  void prove() {
    for (std::size_t part = 0; part < trial_.parts.size(); ++part) prove(part);
  }

 private:
  static double area_of(const Corners& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

  /// A point of the triangle: in the middle, near a corner, near a side, or anywhere.
  Vec3 place_on(const Corners& t) {
    Random& random = trial_.random;
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    double w = 1 - u - v;
    const double near = random.magnitude(1e-9, 0.1);
    switch (random.integer(0, 3)) {
      case 0:
        u = v = w = 1.0 / 3;
        break;
      case 1:
        u *= near;
        v *= near;
        w = 1 - u - v;
        break;
      case 2:
        w *= near;
        u = (1 - w) * u / (u + v);
        v = 1 - w - u;
        break;
      default:
        break;
    }
    const int k = random.integer(0, 2);
    return u * t[k] + v * t[(k + 1) % 3] + w * t[(k + 2) % 3];
  }

  /// Viewpoints right behind a facet.
  void look_behind(std::size_t facet, int places) {
    const Corners t = mesh_.corners(facet);
    const Vec3 across = (t[1] - t[0]).cross(t[2] - t[0]);
    const Vec3 inward = across.norm() > 0 ? Vec3(-across.normalized()) : Vec3::Zero();
    const Vec3 centre = trial_.parts[0].centre;
    for (int k = 0; k < places; ++k) {
      const Vec3 q = place_on(t);
      const double step = trial_.random.pick({1.1e-6, 2e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1});
      check(q + step * (centre - q));
      check(q + step * (centre - q).norm() * inward);
    }
  }

  /// What is wrong with a claimed viewpoint.
  void check(const Vec3& p) {
    if (mesh_.locate(p) != Place::inside) return;
    ++trial_.result.viewpoints;
    for (const PartView& part : trial_.parts) check(p, part);
    const std::string broken = broken_among(navigation_.at(trial_.to_scene(p)));
    if (!broken.empty()) report(FindingKind::outside_limits, p, broken);
    const std::string of_sensor = broken_among(sensor_.of_limits(p));
    if (!of_sensor.empty()) report(FindingKind::outside_limits, p, of_sensor);
    if (const auto& link = trial_.c.sensor.link) {
      const auto entering = entering_zone(*link, trial_.blockers, trial_.parts[0].exact.target().corners[0], p);
      if (entering) report(FindingKind::over_claim, p, trial_.object_of(*entering) + " enters the zone");
    }
  }

  void check(const Vec3& p, const PartView& part) {
    const SeenTarget& target = part.exact.target();
    if (!target.all_sides && target.height(p) < -trial_.noise()) report(FindingKind::behind_target, p, "");
    if (!part.exact.in_range(p, trial_.c.range)) report(FindingKind::out_of_range, p, "");
    const auto hidden = part.exact.first_hiding(p);
    if (!hidden) return;
    if (const auto solid = part.surely_hiding(p, TriangleFilter::not_thin)) {
      report(FindingKind::over_claim, p, trial_.object_of(*solid), merged_by(*solid, p, part));
    } else if (const auto thin = part.surely_hiding(p)) {
      report(FindingKind::thin_over_claim, p, trial_.object_of(*thin), merged_by(*thin, p, part));
    } else {
      report(FindingKind::touching, p, trial_.object_of(*hidden));
    }
  }

  /// How late the triangle may end the view because its corners were merged: vantage/volume.h.
  double merged_by(std::size_t triangle, const Vec3& p, const PartView& part) const {
    const double near = distance_to_triangle(part.centre, trial_.blockers.triangles[triangle].corners);
    return near > 0 ? trial_.blockers.merging * (p - part.centre).norm() / near : 0;
  }

  /// Only what lies deeper than the guarantee allows counts.
  void report(FindingKind which, const Vec3& p, const std::string& detail, double late = 0) {
    const double away = (p - trial_.parts[0].centre).norm();
    const double share = mesh_.distance(p) / away;
    if (share > kDepth + (trial_.rounding() + late) / away) {
      trial_.result.add({which, share, trial_.to_scene(p), detail});
    } else {
      const Vec3& centre = trial_.parts[0].centre;
      const Vec3 outer = centre + (p - centre) / (1 - kDepth);
      if (which == FindingKind::over_claim && mesh_.locate(outer) == Place::inside)
        trial_.result.add({FindingKind::shallow, share, trial_.to_scene(p), detail});
    }
  }

  /// A facet moved in by kDepth about the centre. Corners that rounding left under the target's plane are raised to
  /// `clear` above it: the same way for all facets, so that the mesh stays closed.
  Corners moved_in(const Corners& facet, const PartView& part, double clear) const {
    Corners moved;
    const SeenTarget& target = part.exact.target();
    for (int k = 0; k < 3; ++k) {
      moved[k] = part.centre + (1 - kDepth) * (facet[k] - part.centre);
      const double height = target.height(moved[k]);
      if (!target.all_sides && height < clear) moved[k] += (clear - height) * target.normal;
    }
    return moved;
  }

  /// What a facet is asked for: all of the target as stored; the smaller target; that by triangles that are not thin.
  enum Level { as_stored, smaller, smaller_not_thin, levels };

  std::optional<std::size_t> hidden(const Corners& facet, const PartView& part, Level level) const {
    if (level == as_stored) return part.exact.first_hiding(facet);
    return part.surely_hiding(facet, level == smaller ? TriangleFilter::all : TriangleFilter::not_thin);
  }

  // The theorem: let no triangle of the scene meet the interior of conv(facet, target), for every facet that faces away
  // from a point c of the target. Then every point of the mesh sees all of the target: the ray from c through it
  // leaves the mesh for good through such a facet, at or behind the point.
  void prove(std::size_t index) {
    const PartView& part = trial_.parts[index];
    Judgement& result = trial_.result;
    int level = as_stored, failed[levels] = {};
    std::size_t tried = 0;
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      if (!matters(i, part)) continue;
      if (++tried > trial_.options.proofs) {
        ++result.untried;
        continue;
      }
      int reached = level;
      for (; reached < levels; ++reached) {
        if (!hidden(moved_in(mesh_.corners(i), part, reached == as_stored ? trial_.noise() : 2 * part.margin), part,
                    static_cast<Level>(reached)))
          break;
      }
      ++(reached == as_stored ? result.proved : reached == smaller ? result.proved_smaller : result.unproved);
      if (reached == level) continue;
      constexpr int kFew = 12;  // more of the same tell nothing new
      if (++failed[reached - 1] <= kFew) {
        search(i, static_cast<Level>(reached - 1));
      } else if (reached < levels) {
        level = reached;
      }
    }
  }

  /// Whether the facet, moved in, faces away from the target; those in its plane do not.
  bool matters(std::size_t i, const PartView& part) const {
    const SeenTarget& target = part.exact.target();
    const Corners facet = moved_in(mesh_.corners(i), part, trial_.noise());
    if (orientation(facet[0], facet[1], facet[2], target.corners[0]) >= 0) return false;
    return target.all_sides || std::any_of(facet.begin(), facet.end(), [&](const Vec3& p) {
             return target.height(p) > 4 * trial_.noise() + 1e-12;
           });
  }

  /// Looks from behind a facet that is not clear. Where nothing is found that is deep enough, says what the facet is.
  void search(std::size_t i, Level level) {
    const auto count = [this] {
      return std::count_if(trial_.result.findings.begin(), trial_.result.findings.end(),
                           [](const Finding& f) { return f.share > kDepth; });
    };
    const auto before = count();
    look_behind(i, 15);
    if (count() > before) return;
    const Corners facet = mesh_.corners(i);
    trial_.result.add({level == as_stored ? FindingKind::touching : FindingKind::shallow, 0,
                       trial_.to_scene((facet[0] + facet[1] + facet[2]) / 3), "facet " + std::to_string(i)});
  }

  Trial& trial_;
  ClosedMesh mesh_;
  NavigationMargins navigation_;
  SensorMargins sensor_;
};

}  // namespace

void judge_claims(Trial& trial) {
  Claims claims(trial);
  if (!claims.check_mesh()) return;
  claims.look();
  claims.prove();
}

}  // namespace attack
