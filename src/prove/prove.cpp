// The judge of docs/proof.md.
#include "vantage/prove.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

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

std::string at_text(const Vec3& place) {
  return "the vertex at " + std::to_string(place.x()) + ", " + std::to_string(place.y()) + ", " +
         std::to_string(place.z());
}

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

 private:
  static constexpr double kSightPart = 0.8;  ///< of the time, roughly

  void look_at(std::size_t part, double lift_m, const internal::core::ProgressReporter& progress);
  void add_certificate(std::size_t part, double lift_m, const prove::View& view,
                       const std::vector<std::uint32_t>& numbers, const prove::SightProof& proof);
  void look_beyond(const prove::View& view, const prove::SceneTree& obstacles,
                   const internal::core::ProgressReporter& progress);
  void add_limits(const internal::core::ProgressReporter& progress);
  std::vector<Vec3> shrunk(const prove::View& view) const;
  prove::SolidMesh in_front(const std::vector<Vec3>& vertices, const prove::View& view);
  void look_for_witness(const Mesh& judged, const std::vector<Triangle>& facets,
                        const std::vector<std::uint32_t>& numbers, const prove::View& view,
                        const prove::SceneTree& obstacles, const std::vector<prove::OpenFacet>& open);

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

/// `judged`: shrunk, about View::origin, of which `facets` are tested and `numbers` are in the file.
void Prover::look_for_witness(const Mesh& judged, const std::vector<Triangle>& facets,
                              const std::vector<std::uint32_t>& numbers, const prove::View& view,
                              const prove::SceneTree& obstacles, const std::vector<prove::OpenFacet>& open) {
  if (open.empty()) return;
  constexpr std::size_t kMostFacets = 2000;  // looked at: evenly among those that are open
  const std::size_t step = 1 + open.size() / kMostFacets;
  const prove::RoundedSurface surface(judged, options_.rounding_m);
  for (std::size_t i = 0; i < open.size(); i += step) {
    const auto& [a, b, c] = facets[open[i].facet];
    const prove::Piece& obstacle = obstacles.pieces[open[i].piece];
    const auto blocked =
        prove::find_blocked({judged.vertices[a], judged.vertices[b], judged.vertices[c]}, view, obstacle);
    if (!blocked) continue;
    if (report_.witness && blocked->depth_m <= report_.witness->depth_m) continue;
    if (!surface.was_below_for_sure(blocked->viewpoint, blocked->depth_m)) continue;
    // As it is told: sums are rounded once more.
    const Vec3 viewpoint = view.origin + blocked->viewpoint, target_point = view.origin + blocked->target_point;
    const auto& [first, second, third] = scene_.mesh.triangles[obstacle.of];
    const std::vector<Vec3>& corners = scene_.mesh.vertices;
    if (!prove::passes_through(viewpoint, target_point, {corners[first], corners[second], corners[third]})) continue;
    const std::uint32_t object = scene_.object_of.empty() ? 0 : scene_.object_of[obstacle.of];
    report_.witness = HiddenView{.viewpoint = viewpoint,
                                 .target_point = target_point,
                                 .triangle = obstacle.of,
                                 .object = object < scene_.objects.size() ? display_name(scene_.objects[object]) : "",
                                 .facet = numbers[open[i].facet],
                                 .depth_m = blocked->depth_m};
  }
}

void Prover::look_at(std::size_t part, double lift_m, const internal::core::ProgressReporter& progress) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();  // of a vertex that lies in the plane
  const prove::View view = prove::make_view(target_, part, lift_m);
  prove::SolidMesh judged = solid_;
  judged.mesh.vertices = shrunk(view);
  if (options_.other_side_m) judged = in_front(judged.mesh.vertices, view);
  const std::vector<Vec3>& vertices = judged.mesh.vertices;
  Box near;
  for (const Vec3& corner : view.corners) near.extend(corner);
  std::vector<Triangle> facets;
  std::vector<std::uint32_t> numbers;
  for (std::size_t t = 0; t < judged.mesh.triangles.size(); ++t) {
    const Triangle& triangle = judged.mesh.triangles[t];
    for (const std::uint32_t v : triangle) {
      const Vec3& at = vertices[v];
      near.extend(at);
      if (options_.maximal) near.extend((1 + 3 * options_.shrink) * at);
      for (const Vec3& corner : view.whole) farthest_.see((at - corner).norm(), view.origin + at);
      if (!view.all_sides) behind_.see(-view.normal.dot(at) - view.margin_m - kRounding * at.norm(), view.origin + at);
    }
    const auto& [a, b, c] = triangle;
    if (prove::orientation(vertices[a], vertices[b], vertices[c], Vec3::Zero()) == 0) continue;
    facets.push_back(triangle);
    numbers.push_back(judged.facet_of[t]);
  }
  const bool is_recorded = options_.certificate;
  const prove::SceneTree obstacles =
      is_recorded ? prove::all_obstacles_in_front(scene_, view) : prove::obstacles_in_front(scene_, view, near);
  const double share = options_.maximal ? 0.5 : 1;
  const prove::SightProof proof =
      prove::prove_sight(vertices, facets, view, scene_, obstacles, is_recorded, progress.part(0, share));
  report_.tested_facets += facets.size();
  report_.separations += proof.separations;
  report_.margin_m = std::max(report_.margin_m, view.margin_m);
  report_.lift_m = std::max(report_.lift_m, lift_m);
  for (const prove::OpenFacet& open : proof.open) report_.unproved.push_back(numbers[open.facet]);
  look_for_witness(judged.mesh, facets, numbers, view, obstacles, proof.open);
  if (is_recorded) add_certificate(part, lift_m, view, numbers, proof);
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
  const auto add = [&](const char* name, bool holds, const char* how, const std::string& broken) {
    report_.claims.push_back(
        {name, holds ? ProofVerdict::proved : ProofVerdict::wrong, holds ? std::string(how) : broken});
  };
  add("range", farthest_.by <= range_ + options_.rounding_m,
      "every vertex is within range of every corner of the target",
      at_text(farthest_.at) + " is " + std::to_string(farthest_.by) + " m from a corner of the target");
  add("front", behind_.by <= options_.rounding_m, "every vertex is in front of the target",
      at_text(behind_.at) + " is " + std::to_string(behind_.by) + " m behind the target's plane");
  add_limits(progress.part(kSightPart, 1));
  return std::move(report_);
}

void Prover::add_limits(const internal::core::ProgressReporter& progress) {
  std::vector<prove::View> parts;
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    parts.push_back(prove::make_view(target_, part, options_.lift_m.empty() ? 0 : options_.lift_m[part]));
  }
  const prove::LimitedVolume volume(solid_.mesh, parts.front().origin, options_.shrink, options_.rounding_m);
  report_.limit_tolerance_m = volume.tolerance_m();
  const std::vector<ClaimProof> claims = prove::prove_limits(
      volume, options_.other_side_m ? volume.in_front_of(Vec3::Zero(), parts.front().normal) : volume, parts, sensor_,
      navigation_, progress);
  report_.claims.insert(report_.claims.end(), claims.begin(), claims.end());
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

}  // namespace vantage
