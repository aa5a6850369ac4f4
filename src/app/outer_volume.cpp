// Docs/proof.md, "Maximal": a star-shaped mesh of which every facet has a witness holds all that belongs to the volume.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "app/combine_targets.h"
#include "app/join_volumes.h"
#include "core/parallel.h"
#include "core/places.h"
#include "core/portable_math.h"
#include "core/triangle_distance.h"
#include "vantage/each_limit.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

/// In parts of the distance from the target's centre: what the proof moves facets out by, and what the mesh is moved
/// out by, which must be more.
constexpr double kProofGrow = 1e-6, kMeshGrow = 2e-6;

/// Facets of the range lie up to the tolerance inside: moved out by these times it. The first is enough where the
/// target is small beside the range; corners of the others are moved out further, for as many rounds.
constexpr double kOutward[] = {2, 8, 64};

/// Beyond the range by this part of it: above what is rounded.
constexpr double kBeyondRange = 1e-6;

constexpr double kPartOfRange = 1e-3;  ///< the default tolerance

/// The cone of an incidence is stood for by a pyramid round it. Of wider cones the pyramid would be too large.
constexpr std::size_t kSidesOfCone = 64;
constexpr double kWidestConeDeg = 85;

/// A star-shaped mesh about `centre`, on the way out.
struct StarMesh {
  Vec3 centre = Vec3::Zero();
  Mesh mesh;

  double length(std::uint32_t v) const { return (mesh.vertices[v] - centre).norm(); }
  void move_out(std::uint32_t v, double by) {
    const double now = length(v);
    if (now > 0) mesh.vertices[v] = centre + (now + by) / now * (mesh.vertices[v] - centre);
  }
  void scale(std::uint32_t v, double by) { mesh.vertices[v] = centre + by * (mesh.vertices[v] - centre); }
};

std::vector<std::uint32_t> corners_of(const std::vector<std::uint32_t>& facets, const Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t facet : facets) {
    corners.insert(corners.end(), mesh.triangles[facet].begin(), mesh.triangles[facet].end());
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Until no point of these facets is within range. Moving a corner out moves no point of any facet inwards. False where
/// a facet is so near to the centre that its corners would be too far for doubles.
bool move_beyond(const std::vector<std::uint32_t>& facets, double range_m, StarMesh& star) {
  constexpr double kFarthest = 1e3;  // ranges
  const double needed = (1 + kBeyondRange) * range_m;
  for (const std::uint32_t facet : facets) {
    const Triangle& t = star.mesh.triangles[facet];
    const auto& v = star.mesh.vertices;
    const double nearest =
        std::sqrt(internal::core::squared_distance_to_triangle(star.centre, v[t[0]], v[t[1]], v[t[2]]));
    if (nearest >= needed) continue;
    if (!(nearest * kFarthest > needed)) return false;
    for (const std::uint32_t corner : t) star.scale(corner, needed / nearest);
  }
  return true;
}

/// What all parts of the work need.
struct Work {
  const Mission& mission;
  const PreparedScene& scene;
  const OuterOptions& options;
  const Progress& progress;
  double range_m = 0, tolerance_m = 0;
  OuterVolume& result;
};

Volume with_mesh(Mesh mesh, const PreparedTarget& part) {
  Volume volume = volume_of_mesh(std::move(mesh), "outer");
  volume.frame = part.frame();
  return volume;
}

/// Of a part of a target with nothing but a range; `scene`: what the proof looks for hiding in. Nothing where no mesh
/// can be shown to hold it.
std::optional<Volume> around_part(const PreparedTarget& part, const Scene& scene, const Work& work) {
  const Volume inner = compute_visibility(part, {.tolerance_m = work.tolerance_m}, work.progress);
  if (inner.outcome == Outcome::out_of_range) return inner;
  if (inner.empty()) return std::nullopt;  // as far as the engine tells
  StarMesh star{inner.frame.origin, inner.mesh};
  for (std::uint32_t v = 0; v < star.mesh.vertices.size(); ++v) star.move_out(v, kOutward[0] * work.tolerance_m);
  std::vector<std::uint32_t> open;
  for (std::size_t round = 0; round < std::size(kOutward); ++round) {
    if (round > 0) {
      for (const std::uint32_t v : corners_of(open, star.mesh)) star.move_out(v, kOutward[round] * work.tolerance_m);
    }
    const MaximalProof proof = prove_maximal(
        scene, part.target(), part.sensor(), {}, star.mesh,
        {.shrink = kProofGrow, .lift_m = {part.lift_m()}, .maximal = true, .tolerance_m = 0}, work.progress);
    if (!proof.conditions_hold()) return std::nullopt;
    open = proof.open;
    if (open.empty()) break;
  }
  for (std::uint32_t v = 0; v < star.mesh.vertices.size(); ++v) star.scale(v, 1 + kMeshGrow);
  if (!move_beyond(open, work.range_m, star)) return std::nullopt;
  work.result.facets += star.mesh.triangles.size();
  work.result.open_facets += open.size();
  return with_mesh(std::move(star.mesh), part);
}

/// All that is in range of a part, and in front of it.
Volume range_of_part(const PreparedTarget& part, const Work& work) {
  if (auto volume = around_part(part.alone(), Scene(), work)) return *std::move(volume);
  throw Error(ErrorCode::internal_defect, "no mesh holds what is in range of the target", part.target().name, "");
}

bool cuts_incidence(const Sensor& sensor) { return sensor.incidence_deg && *sensor.incidence_deg <= kWidestConeDeg; }

/// Holds the cone about the normal at a corner, up to a height, and all that is so near to it.
Mesh round_cone(const TargetFrame& frame, const Eigen::Vector2d& corner, double angle_rad, double height_m,
                double margin_m) {
  namespace portable = internal::portable;
  const double sine = portable::sin(angle_rad), part = std::numbers::pi / static_cast<double>(kSidesOfCone);
  const double below = margin_m / sine;
  const double radius = (height_m + below) * sine / (portable::cos(angle_rad) * portable::cos(part));
  Mesh mesh;
  mesh.vertices.push_back(frame.to_scene({corner.x(), corner.y(), -below}));
  for (std::size_t i = 0; i < kSidesOfCone; ++i) {
    const double turn = 2 * part * static_cast<double>(i);
    mesh.vertices.push_back(frame.to_scene(
        {corner.x() + radius * portable::cos(turn), corner.y() + radius * portable::sin(turn), height_m}));
  }
  constexpr auto kLast = static_cast<std::uint32_t>(kSidesOfCone);
  for (std::uint32_t i = 1; i <= kLast; ++i) mesh.triangles.push_back({0, i % kLast + 1, i});
  for (std::uint32_t i = 2; i < kLast; ++i) mesh.triangles.push_back({1, i, i + 1});
  return mesh;
}

/// A viewpoint sees each corner within its cone: so it lies in the cones of some of them.
Volume within_incidence(const Volume& volume, const PreparedTarget& part, const Work& work) {
  constexpr std::size_t kMostCones = 8;
  const TargetFrame& frame = part.frame();
  if (volume.empty() || frame.all_sides) return volume;
  Navigation cones;
  const std::size_t count = frame.polygon.size(), taken = std::min(count, kMostCones);
  const double margin = work.options.limit_margin_m;
  for (std::size_t i = 0; i < taken; ++i) {
    cones.meshes.push_back({round_cone(frame, frame.polygon[i * count / taken],
                                       *work.mission.sensor.incidence_deg * std::numbers::pi / 180,
                                       (1 + kPartOfRange) * work.range_m + margin, margin),
                            "incidence"});
  }
  return cut_to_limits(volume, part, cones, work.progress, work.mission.as_written.exact.work_limit);
}

Volume around_target(const Target& target, const Work& work) {
  Sensor range_only;
  range_only.max_range_m = work.range_m;
  const PreparedTarget prepared(work.scene, target, range_only);
  std::vector<Volume> parts;
  for (std::size_t i = 0; i < prepared.part_count(); ++i) {
    const PreparedTarget part = prepared.part(i);
    std::optional<Volume> volume;
    if (!work.mission.sensor.visible) volume = around_part(part, work.mission.scene(), work);
    if (!volume) volume = range_of_part(part, work);
    parts.push_back(cuts_incidence(work.mission.sensor) ? within_incidence(*volume, part, work) : *std::move(volume));
  }
  return internal::app::joined(std::move(parts), work.progress, work.mission.as_written.exact.work_limit);
}

/// Limits to which an outer volume is cut, made wider; the others are named.
class Widening {
 public:
  Widening(double margin_m, std::vector<std::string>& ignored) : margin_m_(margin_m), ignored_(ignored) {}

  void operator()(LimitIs<Limit::altitude> /*limit*/, const Navigation::Altitude& altitude) {
    wide_.altitude = {altitude.min_m - margin_m_, altitude.max_m + margin_m_};
  }
  void operator()(LimitIs<Limit::above_ground> /*limit*/, const AboveGround& band) {
    wide_.above_ground = band;
    wide_.above_ground->min_m -= margin_m_;
    wide_.above_ground->max_m += margin_m_;
  }
  void operator()(LimitIs<Limit::keep_in> limit, const std::vector<Zone>& zones) {
    if (!are_boxes(zones)) return ignore(limit);
    for (const Zone& zone : zones) {
      wide_.keep_in.push_back(Box{zone.box().min.array() - margin_m_, zone.box().max.array() + margin_m_});
    }
  }
  void operator()(LimitIs<Limit::keep_out> limit, const std::vector<Zone>& zones) {
    for (const Zone& zone : zones) {
      if (!zone.is_box) continue;
      const Box box{zone.box().min.array() + margin_m_, zone.box().max.array() - margin_m_};
      if ((box.min.array() < box.max.array()).all()) wide_.keep_out.push_back(box);
    }
    if (!are_boxes(zones)) ignore(limit);
  }
  void operator()(LimitIs<Limit::meshes> limit, const std::vector<KeepInMesh>& /*meshes*/) { ignore(limit); }
  void operator()(LimitIs<Limit::clearance> limit, const Clearance& /*clearance*/) { ignore(limit); }

  const Navigation& wide() const { return wide_; }

 private:
  static bool are_boxes(const std::vector<Zone>& zones) {
    return std::all_of(zones.begin(), zones.end(), [](const Zone& zone) { return zone.is_box; });
  }
  void ignore(Limit limit) { ignored_.emplace_back(name_of(limit)); }

  double margin_m_;
  std::vector<std::string>& ignored_;
  Navigation wide_;
};

void name_ignored(const Sensor& sensor, std::vector<std::string>& ignored) {
  each_limit(sensor, [&](Limit limit, const auto& /*value*/) {
    if (limit == Limit::incidence && cuts_incidence(sensor)) return;
    ignored.emplace_back(limit == Limit::frame ? "camera" : name_of(limit));
  });
  if (sensor.link) ignored.emplace_back("link");
  if (sensor.visible) ignored.emplace_back("visible");
}

void check(const OuterOptions& options) {
  if (!(options.tolerance_m >= 0 && std::isfinite(options.tolerance_m))) {
    throw Error(ErrorCode::value_out_of_range, "the tolerance is not a number of at least 0", "tolerance_m",
                "give metres, or 0 for a thousandth of the range");
  }
  if (!(options.limit_margin_m > 0 && std::isfinite(options.limit_margin_m))) {
    throw Error(ErrorCode::value_out_of_range, "the margin of limits is not a positive number", "limit_margin_m",
                "give metres, as 0.01");
  }
}

void fill(Work& work) {
  const Mission& mission = work.mission;
  const double asked = work.options.tolerance_m, work_limit = mission.as_written.exact.work_limit;
  work.tolerance_m = asked > 0 ? asked : kPartOfRange * work.range_m;
  std::vector<Volume> all;
  std::optional<Target> first;
  for (const std::vector<Target>& list : internal::app::views_of(mission)) {
    std::vector<Volume> any;
    for (const Target& target : list) {
      if (!first) first = target;
      any.push_back(around_target(target, work));
    }
    all.push_back(internal::app::united(std::move(any), work.progress, work_limit));
  }
  Volume volume = internal::app::joined(std::move(all), work.progress, work_limit);
  Widening widening(work.options.limit_margin_m, work.result.ignored);
  each_limit(mission.navigation, widening);
  const Navigation& wide = widening.wide();
  name_ignored(mission.sensor, work.result.ignored);
  if (!volume.empty() && !wide.empty()) {
    Sensor range_only;
    range_only.max_range_m = work.range_m;
    volume = cut_to_limits(volume, PreparedTarget(work.scene, *first, range_only), wide, work.progress, work_limit);
  }
  work.result.volume = std::move(volume);
}

}  // namespace

OuterVolume outer_volume(const Mission& mission, const RunOptions& options, const OuterOptions& outer,
                         const Progress& progress) {
  check(outer);
  if (volume_count(mission) != 1) {
    throw Error(ErrorCode::not_applicable, "the mission asks for a volume for each of its targets",
                mission.as_written.places.target, "ask for one of them: one_volume");
  }
  OuterVolume result;
  internal::parallel::with_threads(options.threads, [&] {
    const PreparedScene scene = options.prepared ? *options.prepared : PreparedScene(mission.scene(), progress);
    Work work{mission, scene, outer, progress, range_limit_m(mission.sensor), 0, result};
    internal::core::with_place(mission.as_written.places.target, [&] { fill(work); });
  });
  return result;
}

}  // namespace vantage
