#include "mesh_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "closed_mesh.h"
#include "exact.h"
#include "limit_attack.h"
#include "vantage/target.h"

namespace attack {
namespace {

using vantage::ProofVerdict;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

bool has(const std::vector<std::string>& claims, const std::string& claim) {
  return std::find(claims.begin(), claims.end(), claim) != claims.end();
}

bool passes_through(const Vec3& from, const Vec3& to, const Corners& t) {
  const int start = orientation(t[0], t[1], t[2], from), end = orientation(t[0], t[1], t[2], to);
  if (start * end >= 0) return false;
  const int ab = orientation(from, to, t[0], t[1]), bc = orientation(from, to, t[1], t[2]),
            ca = orientation(from, to, t[2], t[0]);
  return ab != 0 && ab == bc && bc == ca;
}

template <typename Report>
double layer_of(const Report& report) {
  if constexpr (requires { report.layer_m; }) return report.layer_m;
  return 0;
}

class MeshJudge {
 public:
  MeshJudge(const MeshCase& c, const Verdicts& verdicts)
      : c_(c), verdicts_(verdicts), mesh_(c.volume), oracle_(c), random_(c.seed) {
    for (std::size_t i = 0; i < c.target.parts.size(); ++i) {
      const vantage::TargetFrame frame = vantage::make_target_frame(c.target, i);
      centres_.push_back(frame.origin);
      largest_ = std::max(largest_, frame.origin.cwiseAbs().maxCoeff());
    }
    for (const Vec3& v : c.volume.vertices) largest_ = std::max(largest_, v.cwiseAbs().maxCoeff());
    for (const vantage::ProofReport& report : verdicts.reports) {
      tolerance_ = std::max(tolerance_, report.limit_tolerance_m);
      margin_ = std::max(margin_, report.margin_m);
      layer_ = std::max(layer_, layer_of(report));
    }
  }

  void judge(MeshJudgement& result) {
    look_inside(result);
    if (c_.lift_m > 0) return;  // what is wrong is so for a target that was raised by a little more, as it is told
    for (const vantage::ProofReport& report : verdicts_.reports) {
      for (const vantage::ClaimProof& claim : report.claims) {
        if (claim.verdict != ProofVerdict::wrong) continue;
        ++result.witnesses;
        const std::string problem = claim.name == "sight" ? problem_of_view(report) : problem_of_place(claim);
        if (!problem.empty()) {
          result.findings.push_back({"false witness: " + claim.name, claim.place.value_or(Vec3::Zero()), problem});
        }
      }
    }
  }

  bool refutes(const std::string& claim, const Vec3& point) {
    if (turns(point) == 0) return false;
    const double layer = std::max(3 * c_.rounding_m, 1.1 * layer_) + 64 * kEpsilon * largest_;
    if (mesh_.distance(point) < layer) return false;
    const double part = 3 * c_.shrink + 64 * kEpsilon;
    for (const Vec3& centre : centres_) {  // the volume is smaller by a part of the distance
      if (turns(point + part * (point - centre)) == 0) return false;
    }
    std::vector<Vec3> about = {point};
    const double by = allowed(claim, point);
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Vec3 way(x, y, z);
          if (x != 0 || y != 0 || z != 0) about.push_back(point + by * way.normalized());
        }
      }
    }
    const auto broken = oracle_.broken(about);
    return std::all_of(broken.begin(), broken.end(), [&](const auto& claims) { return has(claims, claim); });
  }

 private:
  /// 0 also where it cannot be told.
  int turns(const Vec3& point) const { return mesh_.turns(point).value_or(0); }

  /// A claim may be broken by less than this, metres, at least.
  double allowed(const std::string& claim, const Vec3& point) const {
    const double away = (point - centres_[0]).norm();
    const double rounding = 64 * kEpsilon * (largest_ + away) + 2 * c_.rounding_m;
    if (claim == "sight") return std::max(4 * margin_, 1e-7 * away) + rounding;
    if (claim == "range" || claim == "front") return 4 * margin_ + 1e-9 * away + rounding;
    bool is_told_exactly = false;
    const auto look = [&](auto limit, const auto& value) {
      if (claim == facts_of<limit>().claim) is_told_exactly = is_exact<limit>(value);
    };
    each_limit(c_.navigation, look);
    each_limit(c_.sensor, look);
    if (is_told_exactly) return rounding;
    return 2.5 * tolerance_ + rounding;
  }

  Vec3 on_facet(std::size_t facet) {
    const Corners t = mesh_.corners(facet);
    const double u = std::sqrt(random_.uniform(0, 1)), v = random_.uniform(0, 1);
    return (1 - u) * t[0] + u * (1 - v) * t[1] + u * v * t[2];
  }

  std::size_t any_facet() { return static_cast<std::size_t>(random_.integer(0, static_cast<int>(mesh_.size()) - 1)); }

  /// Where limits are broken most. Next to a vertex, towards the middle of its neighbours.
  void add_points_at_vertices(std::vector<Vec3>& points) {
    std::map<std::uint32_t, std::pair<Vec3, int>> neighbours;
    for (const vantage::Triangle& t : c_.volume.triangles) {
      for (int k = 0; k < 3; ++k) {
        auto& [sum, count] = neighbours.try_emplace(t[k], Vec3::Zero(), 0).first->second;
        sum += c_.volume.vertices[t[(k + 1) % 3]] + c_.volume.vertices[t[(k + 2) % 3]];
        count += 2;
      }
    }
    const std::size_t step = 1 + neighbours.size() / 50;
    std::size_t i = 0;
    for (const auto& [vertex, about] : neighbours) {
      if (i++ % step != 0) continue;
      const Vec3& at = c_.volume.vertices[vertex];
      for (int k = 0; k < 2; ++k)
        points.push_back(at + random_.magnitude(1e-4, 0.5) * (about.first / about.second - at));
    }
  }

  std::vector<Vec3> draw_points() {
    std::vector<Vec3> points;
    const std::size_t step = 1 + mesh_.size() / 50;
    for (std::size_t f = 0; f < mesh_.size(); f += step) {
      const Corners t = mesh_.corners(f);
      const Vec3 area = (t[1] - t[0]).cross(t[2] - t[0]);
      const Vec3 off = std::sqrt(area.norm()) * area.stableNormalized();
      const Vec3 at = on_facet(f);
      points.push_back(at - random_.magnitude(1e-5, 0.3) * off);
      points.push_back(at + random_.magnitude(1e-5, 0.3) * off);
    }
    add_points_at_vertices(points);
    for (int i = 0; i < 40; ++i) {
      const Vec3 a = on_facet(any_facet()), b = on_facet(any_facet());
      points.push_back(a + random_.uniform(0, 1) * (b - a));
    }
    for (const Vec3& suspect : c_.suspects) {
      points.push_back(suspect);
      points.push_back(suspect + (suspect - centres_[0]).norm() * random_.magnitude(1e-4, 0.1) * random_.direction());
    }
    return points;
  }

  void look_inside(MeshJudgement& result) {
    std::vector<Vec3> inside;
    for (const Vec3& point : draw_points()) {
      if (turns(point) != 0) inside.push_back(point);
    }
    result.inside = inside.size();
    const auto broken = oracle_.broken(inside);
    std::map<std::string, int> found, tried;
    constexpr int kMostTried = 20;  // most of what is near a limit is so by less than what is allowed
    for (std::size_t i = 0; i < inside.size(); ++i) {
      for (const std::string& claim : broken[i]) {
        if (found[claim] > 0 || verdicts_.of(claim) != ProofVerdict::proved || tried[claim]++ >= kMostTried) continue;
        if (!refutes(claim, inside[i])) continue;
        ++found[claim];
        result.findings.push_back({"unsound: " + claim, inside[i], "turns " + std::to_string(turns(inside[i]))});
      }
    }
  }

  /// Of a hidden view; empty where it holds.
  std::string problem_of_view(const vantage::ProofReport& report) {
    if (!report.witness) return "there is none";
    const vantage::HiddenView& view = *report.witness;
    const auto& [a, b, c] = c_.scene.mesh.triangles[view.triangle];
    const std::vector<Vec3>& at = c_.scene.mesh.vertices;
    const Vec3 way = (view.target_point - view.viewpoint).normalized();
    if (!passes_through(view.viewpoint, view.target_point, {at[a], at[b], at[c]})) return "nothing is in the way";
    if (!is_of_target(view.target_point, report.lift_m)) return "what is hidden is not of the target";
    // Something is hidden from places in front of it, and from those behind it, away from the target's centre.
    std::vector<Vec3> there;
    for (double share = 1; share > 1e-9; share /= 2) {
      for (const Vec3& centre : centres_) {
        const Vec3 inward = (centre - view.viewpoint).normalized();
        for (const Vec3& from :
             {Vec3(view.viewpoint + share * view.depth_m * way), Vec3(view.viewpoint + share * view.depth_m * inward),
              Vec3(view.viewpoint + share / 8 * (view.viewpoint - centre))}) {
          if (turns(centre + (from - centre) / (1 - c_.shrink)) != 0) there.push_back(from);
        }
      }
    }
    const auto broken = oracle_.broken(there);
    if (std::any_of(broken.begin(), broken.end(), [](const auto& of) { return has(of, "sight"); })) return "";
    return "the volume does not wind round it, to a depth of " + std::to_string(view.depth_m);
  }

  bool is_of_target(const Vec3& point, double lift_m) const {
    for (std::size_t i = 0; i < c_.target.parts.size(); ++i) {
      const vantage::TargetFrame frame = vantage::make_target_frame(c_.target, i);
      const double near = 4 * margin_ + 1e-9 * frame.enclosing_radius_m + 64 * kEpsilon * largest_;
      Vec3 local = frame.to_local(point);
      local.z() -= std::clamp(local.z(), 0.0, lift_m);
      bool is_in = std::abs(local.z()) <= near;
      const std::size_t count = frame.polygon.size();
      if (count == 1) is_in = is_in && local.norm() <= near;
      for (std::size_t k = 0; k < count && count > 1; ++k) {
        const Eigen::Vector2d along = (frame.polygon[(k + 1) % count] - frame.polygon[k]).normalized();
        const Eigen::Vector2d from = local.head<2>() - frame.polygon[k];
        is_in = is_in && along.x() * from.y() - along.y() * from.x() >= -near;
      }
      if (is_in) return true;
    }
    return false;
  }

  /// Of a place that is said to break a limit.
  std::string problem_of_place(const vantage::ClaimProof& claim) {
    if (!claim.place) return "there is none";
    // Nearer than half of that it is broken as well.
    std::vector<Vec3> there;
    for (double step = claim.broken_by_m / 2; step > 8 * kEpsilon * largest_ && there.size() < 40; step /= 8) {
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          for (int z = -1; z <= 1; ++z) {
            const Vec3 way(x, y, z), at = *claim.place + step / std::max(way.norm(), 1.0) * way;
            if (turns(at) != 0) there.push_back(at);
          }
        }
      }
    }
    if (there.empty()) return "the volume does not wind round it, by " + std::to_string(claim.broken_by_m);
    const auto broken = oracle_.broken(there);
    const bool holds = std::any_of(broken.begin(), broken.end(), [&](const auto& of) { return has(of, claim.name); });
    return holds ? "" : "the limit is kept there, by " + std::to_string(claim.broken_by_m);
  }

  const MeshCase& c_;
  const Verdicts& verdicts_;
  ClosedMesh mesh_;
  QueryOracle oracle_;
  Random random_;
  std::vector<Vec3> centres_;
  double tolerance_ = 0, margin_ = 0, largest_ = 0, layer_ = 0;
};

}  // namespace

MeshJudgement judge_mesh(const MeshCase& c, const Verdicts& verdicts) {
  MeshJudgement result;
  result.kind = c.kind;
  if (verdicts.reports.empty()) {
    result.status = "refused";
    if (verdicts.refusal.rfind("defect", 0) == 0) result.findings.push_back({"defect", Vec3::Zero(), verdicts.refusal});
    return result;
  }
  result.status = vantage::name_of(verdicts.of_all());
  if (c.sensor.visible || c.sensor.link) {
    result.findings.push_back({"proved a share or a link", Vec3::Zero(), result.status});
    return result;
  }
  for (const std::string& name : verdicts.names()) {
    result.claims.emplace_back(name, vantage::name_of(verdicts.of(name)));
  }
  MeshJudge(c, verdicts).judge(result);
  return result;
}

bool refutes(const MeshCase& c, const Verdicts& verdicts, const std::string& claim, const Vec3& point) {
  return MeshJudge(c, verdicts).refutes(claim, point);
}

}  // namespace attack
