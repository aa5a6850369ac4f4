// The judge of docs/proof.md.
#include "vantage/prove.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "prove/convex_polygon.h"
#include "prove/limited_volume.h"
#include "prove/limits.h"
#include "prove/maximal.h"
#include "prove/orientation.h"
#include "prove/rounded_surface.h"
#include "prove/sight.h"
#include "prove/solid_mesh.h"
#include "prove/view.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace prove = internal::prove;

void check_options(const Target& target, const Sensor& sensor, const ProveOptions& options) {
  check_sensor(sensor);
  if (!(options.shrink >= 0 && options.shrink < 1)) {
    throw Error(ErrorCode::value_out_of_range, "shrink is not a number from 0 to below 1", "shrink",
                "give the part of the distance by which the volume is shrunk, as 1e-6");
  }
  if (!(options.rounding_m >= 0 && std::isfinite(options.rounding_m))) {
    throw Error(ErrorCode::value_out_of_range, "rounding_m is not a number of at least 0", "rounding_m",
                "give how far a file's numbers moved the surface, in metres");
  }
  if (!(options.tolerance_m >= 0 && std::isfinite(options.tolerance_m))) {
    throw Error(ErrorCode::value_out_of_range, "tolerance_m is not a number of at least 0", "tolerance_m",
                "give how far facets of the volume may lie inside its range, in metres");
  }
  if (target.parts.empty()) {
    throw Error(ErrorCode::target_parts_invalid, "the target has no parts", "target", "give it one or more");
  }
  for (const double lift : options.lift_m) {
    if (lift >= 0 && lift <= ProveOptions::kMostLift) continue;
    throw Error(ErrorCode::value_out_of_range, "a lift is not a number from 0 to 0.01", "lift_m",
                "give how far the part was raised, in metres");
  }
  if (!options.lift_m.empty() && options.lift_m.size() != target.parts.size()) {
    throw Error(ErrorCode::array_sizes_differ, "the lifts are not as many as the target's parts", "lift_m",
                "give one for each part, or none");
  }
  if (options.other_side_m) {
    if (!(*options.other_side_m >= 0 && std::isfinite(*options.other_side_m))) {
      throw Error(ErrorCode::value_out_of_range, "other_side_m is not a number of at least 0", "other_side_m",
                  "give how far the other side's plane lies behind, in metres");
    }
    if (target.parts.size() != 1 || (target.is_point() && !target.front)) {
      throw Error(ErrorCode::not_applicable, "only a target of one part with a front has two sides", "other_side_m",
                  "leave it out");
    }
  }
  const char* const what = sensor.visible ? "a share of the target" : sensor.link ? "a radio link" : nullptr;
  if (!what) return;
  throw Error(ErrorCode::not_applicable,
              std::string("the volume is for ") + what + ", and only the sight of a whole target can be proved",
              sensor.visible ? "sensor.visible" : "sensor.link", "check it with 'vantage verify'");
}

/// What nobody looked at before: a scene may be made in memory.
void check_scene(const Scene& scene) {
  constexpr const char* kFix = "mend the scene";
  if (!scene.object_of.empty() && scene.object_of.size() != scene.mesh.triangles.size()) {
    throw Error(ErrorCode::array_sizes_differ, "the scene's triangles and their objects are not as many", "scene",
                kFix);
  }
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : scene.mesh.triangles[t]) {
      if (v >= scene.mesh.vertices.size()) {
        throw Error(ErrorCode::index_out_of_range,
                    "triangle " + std::to_string(t) + " of the scene names vertex " + std::to_string(v) + " of " +
                        std::to_string(scene.mesh.vertices.size()),
                    "scene", kFix);
      }
      if (scene.mesh.vertices[v].allFinite()) continue;
      throw Error(ErrorCode::coordinate_not_finite,
                  "vertex " + std::to_string(v) + " of the scene has a coordinate that is not finite", "scene", kFix);
    }
  }
}

/// The vertex at which something is largest.
struct Worst {
  double by = -std::numeric_limits<double>::infinity();
  Vec3 at = Vec3::Zero();  ///< scene frame

  void see(double value, const Vec3& place) {
    if (value <= by) return;
    by = value;
    at = place;
  }
};

class Prover {
 public:
  Prover(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
         const Mesh& volume, const ProveOptions& options)
      : scene_(scene),
        target_(target),
        sensor_(sensor),
        navigation_(navigation),
        volume_(volume),
        range_(range_limit_m(sensor)),
        options_(options),
        solid_(prove::solid_mesh(volume)) {}

  ProofReport run(const internal::core::ProgressReporter& progress);
  MaximalProof run_maximal(const internal::core::ProgressReporter& progress);

 private:
  static constexpr double kSightPart = 0.8;  ///< of the time, roughly

  void look_at(std::size_t part, double lift_m, const internal::core::ProgressReporter& progress);
  void add_certificate(std::size_t part, double lift_m, const prove::View& view,
                       const std::vector<std::uint32_t>& numbers, const prove::SightProof& proof);
  void look_beyond(const prove::View& view, const prove::SceneTree& obstacles,
                   const internal::core::ProgressReporter& progress);
  void add_range(const prove::LimitedVolume& volume);
  void add_front(const prove::LimitedVolume& volume);
  std::vector<Vec3> shrunk(const prove::View& view) const;
  prove::SolidMesh in_front(const std::vector<Vec3>& vertices, const prove::View& view);
  struct Judged;
  void look_for_witness(const Judged& judged, const prove::View& view, const prove::SceneTree& obstacles,
                        const std::vector<prove::OpenFacet>& open, const internal::core::ProgressReporter& progress);

  const Scene& scene_;
  const Target& target_;
  const Sensor& sensor_;
  const Navigation& navigation_;
  const Mesh& volume_;
  double range_;
  const ProveOptions& options_;
  prove::SolidMesh solid_;
  ProofReport report_;
  Worst farthest_;  ///< from a corner of the target, metres
  Worst behind_;    ///< its plane, metres
};

std::vector<Vec3> Prover::shrunk(const prove::View& view) const {
  std::vector<Vec3> vertices;
  vertices.reserve(solid_.mesh.vertices.size());
  for (const Vec3& vertex : solid_.mesh.vertices) vertices.push_back((1 - options_.shrink) * (vertex - view.origin));
  return vertices;
}

/// The part of the facets in front of the target. Between its two sides there must be nothing.
prove::SolidMesh Prover::in_front(const std::vector<Vec3>& vertices, const prove::View& view) {
  const prove::HalfSpace front{-view.normal, 0};
  const double other = (1 - options_.shrink) * *options_.other_side_m;  // as heights are
  prove::SolidMesh part;
  part.mesh.vertices = vertices;
  for (std::size_t t = 0; t < solid_.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = solid_.mesh.triangles[t];
    const prove::CutPolygon cut = prove::cut({vertices[a], vertices[b], vertices[c]}, front);
    const prove::ConvexPolygon between = prove::cut(cut.outside, {-view.normal, other}).inside;
    for (const Vec3& corner : between) {
      // Whatever passes has a place half way.
      const Vec3 at = between.size() > 2 ? Vec3((corner + prove::middle_of(between)) / 2) : corner;
      const double height = -view.normal.dot(at);
      behind_.see(std::min(height, other - height) - view.margin_m, view.origin + at);
    }
    const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
    if (cut.outside.empty()) {
      part.mesh.triangles.push_back({a, b, c});
      part.facet_of.push_back(solid_.facet_of[t]);
      continue;
    }
    part.mesh.vertices.insert(part.mesh.vertices.end(), cut.inside.begin(), cut.inside.end());
    for (std::uint32_t k = 2; k < cut.inside.size(); ++k) {
      part.mesh.triangles.push_back({first, first + k - 1, first + k});
      part.facet_of.push_back(solid_.facet_of[t]);
    }
  }
  return part;
}

/// The volume, shrunk, about View::origin.
struct Prover::Judged {
  Mesh whole;
  prove::SolidMesh front;              ///< what of it is looked at
  std::vector<Triangle> facets;        ///< of that, those that are tested
  std::vector<std::uint32_t> numbers;  ///< of these, in the volume that was given
};

/// Where a segment passes the plane of a triangle.
Vec3 passage(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double at_from = normal.dot(from - corners[0]), at_to = normal.dot(to - corners[0]);
  return from + at_from / (at_from - at_to) * (to - from);
}

/// Whether it is so as it is told, in the scene frame, where sums are rounded once more; and whether what hides counts.
bool is_hidden(const prove::Blocked& blocked, const prove::View& view, const std::array<Vec3, 3>& corners) {
  const Vec3 from = view.origin + blocked.viewpoint, to = view.origin + blocked.target_point;
  if (!prove::passes_through(from, to, corners)) return false;
  return view.all_sides || view.normal.dot(passage(from, to, corners) - view.origin) > view.margin_m;
}

void Prover::look_for_witness(const Judged& judged, const prove::View& view, const prove::SceneTree& obstacles,
                              const std::vector<prove::OpenFacet>& open,
                              const internal::core::ProgressReporter& progress) {
  if (open.empty()) return;
  constexpr std::size_t kMostFacets = 2000;  // looked at: evenly among those that are open
  const std::size_t step = 1 + open.size() / kMostFacets;
  const prove::RoundedSurface surface(judged.whole, options_.rounding_m);
  for (std::size_t i = 0; i < open.size(); i += step) {
    progress.report(i, open.size());
    const prove::Piece& obstacle = obstacles.pieces[open[i].piece];
    std::array<Vec3, 3> facet, corners;
    for (std::size_t k = 0; k < 3; ++k) {
      facet[k] = judged.front.mesh.vertices[judged.facets[open[i].facet][k]];
      corners[k] = scene_.mesh.vertices[scene_.mesh.triangles[obstacle.of][k]];
    }
    // At a corner the volume may lie beside the line to the target. Behind or before a place inside of the facet it
    // does not, unless the facet bounds nothing.
    const Vec3 middle = (facet[0] + facet[1] + facet[2]) / 3;
    for (const double inward : {0.0, 0.1}) {
      for (Vec3& corner : facet) corner += inward * (middle - corner);
      const auto blocked = prove::find_blocked(facet, view, obstacle);
      if (!blocked || (report_.witness && blocked->depth_m <= report_.witness->depth_m)) break;
      if (!is_hidden(*blocked, view, corners)) continue;
      if (!surface.surely_held(blocked->viewpoint, blocked->depth_m)) continue;
      const std::uint32_t object = scene_.object_of.empty() ? 0 : scene_.object_of[obstacle.of];
      report_.witness = HiddenView{.viewpoint = view.origin + blocked->viewpoint,
                                   .target_point = view.origin + blocked->target_point,
                                   .triangle = obstacle.of,
                                   .object = object < scene_.objects.size() ? display_name(scene_.objects[object]) : "",
                                   .facet = judged.numbers[open[i].facet],
                                   .depth_m = blocked->depth_m};
      break;
    }
  }
}

void Prover::look_at(std::size_t part, double lift_m, const internal::core::ProgressReporter& progress) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();  // of a vertex that lies in the plane
  const prove::View view = prove::make_view(target_, part, lift_m);
  Judged judged{{shrunk(view), solid_.mesh.triangles}, {}, {}, {}};
  judged.front =
      options_.other_side_m ? in_front(judged.whole.vertices, view) : prove::SolidMesh{judged.whole, solid_.facet_of};
  const std::vector<Vec3>& vertices = judged.front.mesh.vertices;
  Box near;
  for (const Vec3& corner : view.corners) near.extend(corner);
  for (std::size_t t = 0; t < judged.front.mesh.triangles.size(); ++t) {
    const Triangle& triangle = judged.front.mesh.triangles[t];
    for (const std::uint32_t v : triangle) {
      const Vec3& at = vertices[v];
      near.extend(at);
      if (options_.maximal) near.extend((1 + 3 * options_.shrink) * at);
      for (const Vec3& corner : view.whole) farthest_.see((at - corner).norm(), view.origin + at);
      if (!view.all_sides) behind_.see(-view.normal.dot(at) - view.margin_m - kRounding * at.norm(), view.origin + at);
    }
    const auto& [a, b, c] = triangle;
    if (prove::orientation(vertices[a], vertices[b], vertices[c], Vec3::Zero()) == 0) continue;
    judged.facets.push_back(triangle);
    judged.numbers.push_back(judged.front.facet_of[t]);
  }
  const bool is_recorded = options_.certificate;
  const prove::SceneTree obstacles =
      is_recorded ? prove::all_obstacles_in_front(scene_, view) : prove::obstacles_in_front(scene_, view, near);
  const double share = options_.maximal ? 0.5 : 1;
  const prove::SightProof proof =
      prove::prove_sight(vertices, judged.facets, view, scene_, obstacles, is_recorded, progress.part(0, 0.9 * share));
  report_.tested_facets += judged.facets.size();
  report_.separations += proof.separations;
  report_.margin_m = std::max(report_.margin_m, view.margin_m);
  report_.lift_m = std::max(report_.lift_m, lift_m);
  for (const prove::OpenFacet& open : proof.open) report_.unproved.push_back(judged.numbers[open.facet]);
  look_for_witness(judged, view, obstacles, proof.open, progress.part(0.9 * share, share));
  if (is_recorded) add_certificate(part, lift_m, view, judged.numbers, proof);
  if (options_.maximal && !options_.other_side_m) look_beyond(view, obstacles, progress.part(0.5, 1));
}

void Prover::look_beyond(const prove::View& view, const prove::SceneTree& obstacles,
                         const internal::core::ProgressReporter& progress) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Vec3> vertices;
  vertices.reserve(solid_.mesh.vertices.size());
  for (const Vec3& vertex : solid_.mesh.vertices) vertices.push_back(vertex - view.origin);
  constexpr double kPointRadius = 5e-4, kFullRange = 20;  // docs/proof.md, "Maximal"
  const prove::LimitsBeyond limits = prove::limits_beyond(navigation_, sensor_, view);
  const prove::Beyond beyond{.scene = scene_,
                             .view = view,
                             .obstacles = obstacles,
                             .limits = limits,
                             .range_m = range_,
                             .tolerance_m = options_.tolerance_m,
                             .grow = options_.shrink,
                             .rounding_m = options_.rounding_m,
                             .point_radius_m = kPointRadius * std::min(1.0, range_ / kFullRange)};
  const prove::Witnesses found = prove::find_witnesses(vertices, solid_.mesh.triangles, beyond, progress);
  MaximalProof proof;
  proof.facets.assign(volume_.triangles.size(), {WitnessKind::edge_on, 0, 0});  // those without area
  for (std::size_t t = 0; t < found.facets.size(); ++t) proof.facets[solid_.facet_of[t]] = found.facets[t];
  for (const prove::LimitBeyond& limit : limits.limits) proof.limits.push_back(limit.name);
  proof.sampled = limits.without_argument;
  proof.conditions = prove::whole_conditions(vertices, solid_.mesh.triangles, found, beyond);
  proof.grow = options_.shrink;
  proof.tolerance_m = options_.tolerance_m;
  proof.range_m = range_ - options_.tolerance_m;
  proof.point_radius_m = view.corners.size() < 3 ? beyond.point_radius_m : 0;
  prove::finish_maximal(volume_, proof);
  proof.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report_.maximal = report_.maximal ? join(*report_.maximal, proof, volume_) : proof;
}

void Prover::add_certificate(std::size_t part, double lift_m, const prove::View& view,
                             const std::vector<std::uint32_t>& numbers, const prove::SightProof& proof) {
  constexpr double kSureHeight = 1.5;  // in margins: what was left out lies lower, whatever was rounded
  if (!report_.certificate) {
    report_.certificate = Certificate{options_.shrink, options_.rounding_m, range_, {}, {}};
  }
  CertificatePart& record = report_.certificate->parts.emplace_back();
  record.target = target_.parts[part];
  record.shift_m = target_.offset_m + lift_m;
  record.centre = view.origin;
  record.corners = view.corners;
  record.normal = view.normal;
  record.all_sides = view.all_sides;
  record.cut_height_m = kSureHeight * view.margin_m;
  for (const std::uint32_t facet : proof.order) record.facets.push_back(numbers[facet]);
  record.steps = proof.steps;
}

ProofReport Prover::run(const internal::core::ProgressReporter& progress) {
  report_.facets = solid_.mesh.triangles.size();
  report_.shrink = options_.shrink;
  report_.rounding_m = options_.rounding_m;
  const double parts = static_cast<double>(target_.parts.size());
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    const double lift = options_.lift_m.empty() ? 0 : options_.lift_m[part];
    look_at(part, lift,
            progress.part(kSightPart * static_cast<double>(part) / parts,
                          kSightPart * static_cast<double>(part + 1) / parts));
  }
  std::vector<std::uint32_t>& unproved = report_.unproved;
  std::sort(unproved.begin(), unproved.end());
  unproved.erase(std::unique(unproved.begin(), unproved.end()), unproved.end());
  ProofVerdict sight = unproved.empty() ? ProofVerdict::proved : ProofVerdict::not_proved;
  if (report_.witness) sight = ProofVerdict::wrong;
  report_.claims.push_back({"sight", sight,
                            unproved.empty() ? "what lies between a facet and the target is free, for every facet"
                                             : "of some facets it is open, or wrong"});
  std::vector<prove::View> views;
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    views.push_back(prove::make_view(target_, part, options_.lift_m.empty() ? 0 : options_.lift_m[part]));
  }
  const prove::LimitedVolume all(solid_.mesh, views.front().origin, options_.shrink, options_.rounding_m);
  report_.limit_tolerance_m = all.tolerance_m();
  add_range(all);
  add_front(all);
  const prove::LimitedVolume& seen = options_.other_side_m ? all.in_front_of(Vec3::Zero(), views.front().normal) : all;
  const std::vector<ClaimProof> claims =
      prove::prove_limits(all, seen, views, sensor_, navigation_, progress.part(kSightPart, 1));
  report_.claims.insert(report_.claims.end(), claims.begin(), claims.end());
  return std::move(report_);
}

MaximalProof Prover::run_maximal(const internal::core::ProgressReporter& progress) {
  const double parts = static_cast<double>(target_.parts.size());
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    const prove::View view = prove::make_view(target_, part, options_.lift_m.empty() ? 0 : options_.lift_m[part]);
    Box near;
    for (const Vec3& corner : view.corners) near.extend(corner);
    for (const Vec3& vertex : solid_.mesh.vertices) near.extend((1 + 3 * options_.shrink) * (vertex - view.origin));
    near.min.array() -= options_.rounding_m;
    near.max.array() += options_.rounding_m;
    look_beyond(view, prove::obstacles_in_front(scene_, view, near),
                progress.part(static_cast<double>(part) / parts, static_cast<double>(part + 1) / parts));
  }
  return std::move(*report_.maximal);
}

/// A file's rounding may have moved vertices out of range, and does not count.
void Prover::add_range(const prove::LimitedVolume& volume) {
  const double beyond = farthest_.by - range_, allowed = options_.rounding_m;
  if (beyond > allowed + volume.unsure_m()) {
    report_.claims.push_back(volume.wrong("range", {beyond, farthest_.at - volume.origin()}, "the range"));
  } else if (!(beyond <= allowed)) {
    report_.claims.push_back(prove::not_proved("range", "a vertex is as far as the range, as far as numbers can tell"));
  } else {
    std::string how = "every vertex is within range of every corner of the target";
    if (beyond > 0) how += internal::core::format(", but for {:.3g} m that the file's numbers explain", beyond);
    report_.claims.push_back(prove::proved("range", how));
  }
}

/// From what a file's rounding moved behind the target nothing is known: its view is not looked at.
void Prover::add_front(const prove::LimitedVolume& volume) {
  if (behind_.by > options_.rounding_m + volume.unsure_m()) {
    report_.claims.push_back(volume.wrong("front", {behind_.by, behind_.at - volume.origin()}, "the target's plane"));
  } else if (behind_.by > 0) {
    report_.claims.push_back(prove::not_proved(
        "front", internal::core::format("a vertex is {:.3g} m behind the target's plane, which is no more than was "
                                        "rounded",
                                        behind_.by)));
  } else {
    report_.claims.push_back(prove::proved("front", "every vertex is in front of the target"));
  }
}

Box box_of(const Navigation::Altitude& altitude) {
  const double all = std::numeric_limits<double>::infinity();
  return {{-all, -all, altitude.min_m}, {all, all, altitude.max_m}};
}

/// Sight, range and front, the first claims, are proved, and nothing else is wrong.
bool can_certify(const ProofReport& report) {
  constexpr std::ptrdiff_t kFirst = 3;
  return report.verdict() != ProofVerdict::wrong &&
         std::all_of(report.claims.begin(), report.claims.begin() + kFirst,
                     [](const ClaimProof& claim) { return claim.verdict == ProofVerdict::proved; });
}

/// The limits that are boxes, where they are proved.
std::vector<CertifiedBox> certified_boxes(const Navigation& navigation, const std::vector<ClaimProof>& claims) {
  std::vector<CertifiedBox> boxes;
  for (const ClaimProof& claim : claims) {
    if (claim.verdict != ProofVerdict::proved) continue;
    if (claim.name == "altitude") boxes.push_back({claim.name, box_of(*navigation.altitude)});
    if (claim.name == "keep_in" && navigation.keep_in.size() == 1 && navigation.keep_in_zones.empty()) {
      boxes.push_back({claim.name, navigation.keep_in[0]});
    }
  }
  return boxes;
}

}  // namespace

const char* name_of(ProofVerdict verdict) {
  switch (verdict) {
    case ProofVerdict::proved:
      return "proved";
    case ProofVerdict::not_proved:
      return "not proved";
    case ProofVerdict::wrong:
      return "wrong";
  }
  return "";
}

ProofVerdict ProofReport::verdict() const {
  ProofVerdict worst = ProofVerdict::proved;
  for (const ClaimProof& claim : claims) worst = std::max(worst, claim.verdict);
  return worst;
}

ProofReport prove_volume(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                         const Mesh& volume, const ProveOptions& options, const Progress& callback) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(target, sensor, options);
  check_scene(scene);
  const internal::core::ProgressReporter progress(callback);
  progress.begin("prove");
  ProofReport report = Prover(scene, target, sensor, navigation, volume, options).run(progress);
  if (options.certificate && !options.other_side_m && can_certify(report)) {
    report.certificate->boxes = certified_boxes(navigation, report.claims);
  } else {
    report.certificate.reset();
  }
  if (!report.unproved.empty()) {
    Mesh unproved{volume.vertices, {}};
    for (const std::uint32_t facet : report.unproved) unproved.triangles.push_back(volume.triangles[facet]);
    report.unproved_area_share = surface_area(unproved) / surface_area(volume);
  }
  progress.finish();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

MaximalProof prove_maximal(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                           const Mesh& volume, const ProveOptions& options, const Progress& callback) {
  check_options(target, sensor, options);
  if (options.other_side_m) {
    throw Error(ErrorCode::not_applicable, "what is missing is not looked for behind a target", "other_side_m",
                "leave it out");
  }
  check_scene(scene);
  const internal::core::ProgressReporter progress(callback);
  progress.begin("prove");
  MaximalProof proof = Prover(scene, target, sensor, navigation, volume, options).run_maximal(progress);
  progress.finish();
  return proof;
}

}  // namespace vantage
