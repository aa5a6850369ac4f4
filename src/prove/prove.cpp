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
#include "prove/layer.h"
#include "prove/lift.h"
#include "prove/limited_volume.h"
#include "prove/limits.h"
#include "prove/maximal.h"
#include "prove/open_volume.h"
#include "prove/orientation.h"
#include "prove/sight.h"
#include "prove/solid_mesh.h"
#include "prove/view.h"
#include "prove/witness.h"
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
      const Vec3& at = scene.mesh.vertices[v];
      if (!at.allFinite()) {
        throw Error(ErrorCode::coordinate_not_finite,
                    "vertex " + std::to_string(v) + " of the scene has a coordinate that is not finite", "scene", kFix);
      }
      if (at.cwiseAbs().maxCoeff() <= prove::kFarthestM) continue;
      throw Error(ErrorCode::coordinate_too_large,
                  "vertex " + std::to_string(v) + " of the scene is farther from the origin than 1,000,000 km", "scene",
                  "give coordinates in metres");
    }
  }
}

/// Numbers of a file are not coarser than single precision: half of a grid's diagonal is 0.87 of its step, and a file
/// that was rounded before has that twice (src/app/read_volume.cpp). About the scene's origin, or about a middle.
double most_rounding_m(const Mesh& solid) {
  Box box;
  for (const auto& [i, j, k] : solid.triangles) {
    const Vec3 &a = solid.vertices[i], &b = solid.vertices[j], &c = solid.vertices[k];
    if (prove::are_on_a_line(a, b, c)) continue;
    for (const Vec3& corner : {a, b, c}) box.extend(corner);
  }
  if (box.empty()) return 0;
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  return std::ldexp(std::max(largest, (box.max - box.min).maxCoeff()), -22);
}

/// The vertex at which something is largest.
struct Worst {
  double by = -std::numeric_limits<double>::infinity();
  Vec3 at = Vec3::Zero();  ///< scene frame

  /// What is not a number counts as the worst.
  void see(double value, const Vec3& place) {
    if (value <= by) return;
    by = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
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
        solid_(prove::solid_mesh(volume)),
        thickest_layer_m_(prove::thickest_layer_m(solid_.mesh)),
        other_side_m_(options.other_side_m) {
    options_.rounding_m = std::min(options.rounding_m, most_rounding_m(solid_.mesh));
  }

  ProofReport run(const internal::core::ProgressReporter& progress);
  MaximalProof run_maximal(const internal::core::ProgressReporter& progress);

 private:
  static constexpr double kSightPart = 0.8;  ///< of the time, roughly

  struct Judged;

  void set_lifts(const internal::core::ProgressReporter& progress);
  std::string lifts_text() const;
  void look_at(std::size_t part, const internal::core::ProgressReporter& progress);
  void look_at_vertices(const Judged& judged, const prove::View& view);
  /// How far rounding may have moved what lies in the target's plane.
  double most_rounded_m() const { return options_.rounding_m + prove::rounding_of_cuts_m(range_); }
  /// Whether it explains that the volume reaches so far behind the target. Not between two sides of one.
  bool is_rounded(double behind_m) const {
    return !other_side_m_ && behind_m <= most_rounded_m() && behind_m + most_unsure_m_ <= thickest_layer_m_;
  }
  Box reach_of(const Judged& judged, const prove::View& view) const;
  void add_certificate(std::size_t part, const prove::View& view, const std::vector<std::uint32_t>& numbers,
                       const prove::SightProof& proof);
  void check_has_areas() const;
  void look_beyond(const prove::View& view, const prove::SceneTree& obstacles,
                   const internal::core::ProgressReporter& progress);
  void add_sight();
  void add_range(const prove::LimitedVolume& volume);
  void add_front(const prove::LimitedVolume& volume);
  std::vector<Vec3> shrunk(const prove::View& view) const;
  prove::SolidMesh in_front(const std::vector<Vec3>& vertices, const prove::View& view);
  Judged judged(const std::vector<Vec3>& vertices, const prove::View& view);

  const Scene& scene_;
  const Target& target_;
  const Sensor& sensor_;
  const Navigation& navigation_;
  const Mesh& volume_;
  double range_;
  ProveOptions options_;  ///< of the rounding, what is believed
  /// How far a part of the target is raised: as it is stated, and how much of it is believed.
  struct Lift {
    double stated_m = 0, used_m = 0;
  };

  prove::SolidMesh solid_;
  double thickest_layer_m_;
  bool is_layer_too_thick_ = false, has_too_many_open_ = false;
  std::vector<Lift> lifts_;
  std::optional<double> other_side_m_;
  ProofReport report_;
  Worst farthest_;            ///< from a corner of the target, metres
  Worst behind_;              ///< its plane, metres
  double most_unsure_m_ = 0;  ///< so much less than a vertex is behind it, as far as numbers can tell
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
  const double other = (1 - options_.shrink) * *other_side_m_;  // as heights are
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

/// What is looked at of a mesh.
struct Prover::Judged {
  prove::SolidMesh front;              ///< `facet_of`: in the volume that was given
  std::vector<Triangle> facets;        ///< of that, those that are tested
  std::vector<std::uint32_t> numbers;  ///< of these, in the volume that was given
};

/// The part of a mesh that is judged. `vertices`: of the mesh, about View::origin.
Prover::Judged Prover::judged(const std::vector<Vec3>& vertices, const prove::View& view) {
  Judged judged;
  if (other_side_m_) {
    judged.front = in_front(vertices, view);
  } else {
    judged.front = {{vertices, solid_.mesh.triangles}, solid_.facet_of};
  }
  const std::vector<Vec3>& at = judged.front.mesh.vertices;
  for (std::size_t t = 0; t < judged.front.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = judged.front.mesh.triangles[t];
    if (prove::orientation(at[a], at[b], at[c], Vec3::Zero()) == 0) continue;
    judged.facets.push_back(judged.front.mesh.triangles[t]);
    judged.numbers.push_back(judged.front.facet_of[t]);
  }
  return judged;
}

/// Also of a way so short that squares of its coordinates are zero.
double length_of(const Vec3& way) {
  constexpr double kSquarable = 1e-140;
  const double length = way.norm();
  return length > kSquarable ? length : way.stableNorm();
}

/// What vertices say of the range and of the front.
void Prover::look_at_vertices(const Judged& judged, const prove::View& view) {
  for (const Triangle& triangle : judged.front.mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3& at = judged.front.mesh.vertices[v];
      for (const Vec3& corner : view.whole) farthest_.see(length_of(at - corner), view.origin + at);
      if (view.all_sides) continue;
      behind_.see(-view.normal.dot(at) - view.unsure_at(at), view.origin + at);
      most_unsure_m_ = std::max(most_unsure_m_, view.unsure_at(at));
    }
  }
  // No vertex is farther behind than that: so all that is as deep below the surface is in front.
  if (behind_.by > 0 && is_rounded(behind_.by)) {
    report_.layer_m = std::max(report_.layer_m, behind_.by + most_unsure_m_);
  }
}

/// All that a hull of a facet and the target may reach.
Box Prover::reach_of(const Judged& judged, const prove::View& view) const {
  Box near;
  for (const Vec3& corner : view.corners) near.extend(corner);
  for (const Triangle& triangle : judged.front.mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3& at = judged.front.mesh.vertices[v];
      near.extend(at);
      if (options_.maximal) near.extend((1 + 3 * options_.shrink) * at);
    }
  }
  constexpr double kRoundings = 16;  // of what is cut of the scene
  const double largest = std::max(near.min.cwiseAbs().maxCoeff(), near.max.cwiseAbs().maxCoeff());
  const double by = kRoundings * std::numeric_limits<double>::epsilon() * largest;
  near.min.array() -= by;
  near.max.array() += by;
  return near;
}

void Prover::look_at(std::size_t part, const internal::core::ProgressReporter& progress) {
  const bool is_recorded = options_.certificate;
  const prove::View view = prove::make_view(target_, part, lifts_[part].used_m);
  const Mesh whole{shrunk(view), solid_.mesh.triangles};
  const Judged seen = judged(whole.vertices, view);
  look_at_vertices(seen, view);
  const std::vector<Vec3>& vertices = seen.front.mesh.vertices;
  const prove::SceneTree obstacles = is_recorded ? prove::all_obstacles_in_front(scene_, view)
                                                 : prove::obstacles_in_front(scene_, view, reach_of(seen, view));
  const double share = options_.maximal ? 0.5 : 1;
  prove::SightProof proof = prove::prove_sight(vertices, seen.facets, view, scene_, obstacles,
                                               {.is_recorded = is_recorded}, progress.part(0, 0.8 * share));
  const prove::OpenVolume volume{whole,        vertices,   seen.facets,
                                 seen.numbers, proof.open, options_.rounding_m + prove::rounding_of_cuts_m(range_)};
  report_.witness = prove::deepest_witness(scene_, view, obstacles, volume, std::move(report_.witness),
                                           progress.part(0.8 * share, 0.9 * share));
  if (!proof.open.empty() && !report_.witness) {  // nothing is wrong: it may be open for what is rounded
    prove::LayerProof less =
        prove::prove_less_layer(volume, view, scene_, obstacles, progress.part(0.9 * share, share));
    report_.layer_m = std::max(report_.layer_m, less.depth_m);
    if (less.depth_m > 0) report_.margin_m = std::max(report_.margin_m, view.inner_margin_m());
    is_layer_too_thick_ = is_layer_too_thick_ || less.is_too_thick;
    has_too_many_open_ = has_too_many_open_ || less.has_too_many;
    proof.open = std::move(less.open);
  }
  report_.tested_facets += seen.facets.size();
  report_.separations += proof.separations;
  report_.margin_m = std::max(report_.margin_m, view.margin_m);
  report_.lift_m = std::max(report_.lift_m, lifts_[part].used_m);
  report_.lift_of_part_m.push_back(lifts_[part].used_m);
  for (const prove::OpenFacet& open : proof.open) report_.unproved.push_back(seen.numbers[open.facet]);
  if (is_recorded) add_certificate(part, view, seen.numbers, proof);
  if (options_.maximal && !other_side_m_) look_beyond(view, obstacles, progress.part(0.5, 1));
}

/// Areas, which are squared, would be zero.
void Prover::check_has_areas() const {
  constexpr double kSmallest = 0x1p-200;
  Box box;
  for (const Triangle& triangle : solid_.mesh.triangles) {
    for (const std::uint32_t v : triangle) box.extend(solid_.mesh.vertices[v]);
  }
  const double extent = (box.max - box.min).maxCoeff();
  if (extent >= kSmallest) return;
  throw Error(ErrorCode::value_out_of_range,
              internal::core::format("the volume is only {:.3g} m across: doubles cannot hold its areas, so it is not "
                                     "known whether anything is missing",
                                     extent),
              "volume", "give a volume in metres, or leave out the question whether it is maximal");
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

void Prover::add_certificate(std::size_t part, const prove::View& view, const std::vector<std::uint32_t>& numbers,
                             const prove::SightProof& proof) {
  constexpr double kSureHeight = 1.5;  // in margins: what was left out lies lower, whatever was rounded
  if (!report_.certificate) {
    report_.certificate = Certificate{options_.shrink, options_.rounding_m, range_, {}, {}};
  }
  CertificatePart& record = report_.certificate->parts.emplace_back();
  record.target = target_.parts[part];
  record.shift_m = target_.offset_m + lifts_[part].used_m;
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
  if (options_.maximal) check_has_areas();
  set_lifts(progress);
  const double parts = static_cast<double>(target_.parts.size());
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    look_at(part, progress.part(kSightPart * static_cast<double>(part) / parts,
                                kSightPart * static_cast<double>(part + 1) / parts));
  }
  // If a target is raised by less than its file says, the certificate would be one of another target.
  const auto is_lowered = [](const Lift& lift) { return lift.used_m != lift.stated_m; };
  if (std::any_of(lifts_.begin(), lifts_.end(), is_lowered)) report_.certificate.reset();
  add_sight();
  std::vector<prove::View> views;
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    views.push_back(prove::make_view(target_, part, lifts_[part].used_m));
  }
  const prove::LimitedVolume all(solid_.mesh, views.front().origin, options_.shrink, options_.rounding_m,
                                 prove::rounding_of_cuts_m(range_));
  report_.limit_tolerance_m = all.tolerance_m();
  add_range(all);
  add_front(all);
  const prove::LimitedVolume& seen = other_side_m_ ? all.in_front_of(Vec3::Zero(), views.front().normal) : all;
  const std::vector<ClaimProof> claims =
      prove::prove_limits(all, seen, views, sensor_, navigation_, progress.part(kSightPart, 1));
  report_.claims.insert(report_.claims.end(), claims.begin(), claims.end());
  return std::move(report_);
}

MaximalProof Prover::run_maximal(const internal::core::ProgressReporter& progress) {
  check_has_areas();
  set_lifts(progress);
  const double parts = static_cast<double>(target_.parts.size());
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    const prove::View view = prove::make_view(target_, part, lifts_[part].used_m);
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

/// A target is raised by no more than its own surface needs, whatever a file says.
void Prover::set_lifts(const internal::core::ProgressReporter& progress) {
  const bool is_raised = std::any_of(options_.lift_m.begin(), options_.lift_m.end(), [](double m) { return m > 0; });
  std::vector<double> needed;
  if (is_raised) needed = prove::lifts_needed_m(scene_, target_, range_, progress);
  for (std::size_t part = 0; part < target_.parts.size(); ++part) {
    Lift& lift = lifts_.emplace_back();
    if (!options_.lift_m.empty()) lift.stated_m = lift.used_m = options_.lift_m[part];
    if (lift.stated_m > 0) lift.used_m = std::min(lift.stated_m, needed[part]);
    if (other_side_m_) *other_side_m_ = std::max(0.0, *other_side_m_ - (lift.stated_m - lift.used_m));
  }
}

/// Tells of the parts that are raised by less than was stated.
std::string Prover::lifts_text() const {
  constexpr std::size_t kMostTold = 3;
  std::string text;
  std::size_t lowered = 0;
  for (std::size_t part = 0; part < lifts_.size(); ++part) {
    const Lift& lift = lifts_[part];
    if (lift.used_m == lift.stated_m || lowered++ >= kMostTold) continue;
    const std::string what = lifts_.size() > 1 ? "part " + std::to_string(part) + " of the target" : "the target";
    text += internal::core::format("; {} is raised by {:.3g} m, which its surface needs, not by {:.3g} m", what,
                                   lift.used_m, lift.stated_m);
  }
  if (lowered > kMostTold) text += "; and so with " + std::to_string(lowered - kMostTold) + " more parts";
  return text;
}

void Prover::add_sight() {
  std::vector<std::uint32_t>& unproved = report_.unproved;
  std::sort(unproved.begin(), unproved.end());
  unproved.erase(std::unique(unproved.begin(), unproved.end()), unproved.end());
  ProofVerdict sight = unproved.empty() ? ProofVerdict::proved : ProofVerdict::not_proved;
  if (report_.witness) sight = ProofVerdict::wrong;
  std::string text = unproved.empty() ? "what lies between a facet and the target is free, for every facet"
                                      : "of some facets it is open, or wrong";
  if (report_.layer_m > 0) {
    text += internal::core::format(", of the volume less a layer of {:.3g} m, for what is rounded", report_.layer_m);
  }
  if (is_layer_too_thick_) {
    text += internal::core::format(
        "; the file's rounding of {:.3g} m is more than 1 % of the volume's width, {:.3g} m: write PLY",
        options_.rounding_m, thickest_layer_m_ / prove::kThickestLayer);
  }
  if (has_too_many_open_) text += "; they are too many to look whether what is hidden is less than was rounded";
  report_.claims.push_back({"sight", sight, text + lifts_text()});
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

/// From what lies behind the target nothing is known, as its view is not looked at. What rounding moved there is moved
/// back for that; but not between the two sides of a target.
void Prover::add_front(const prove::LimitedVolume& volume) {
  if (behind_.by > most_rounded_m() + volume.unsure_m()) {
    report_.claims.push_back(volume.wrong("front", {behind_.by, behind_.at - volume.origin()}, "the target's plane"));
  } else if (behind_.by > 0 && !is_rounded(behind_.by)) {
    report_.claims.push_back(prove::not_proved(
        "front", internal::core::format("a vertex is {:.3g} m behind the target's plane, which is no more than was "
                                        "rounded",
                                        behind_.by)));
  } else {
    std::string how = "every vertex is in front of the target";
    if (other_side_m_) how = "what is on this side of the target is in front of it";
    if (behind_.by > 0) how += internal::core::format(", but for {:.3g} m that roundings explain", behind_.by);
    report_.claims.push_back(prove::proved("front", how));
  }
}

Box box_of(const Navigation::Altitude& altitude) {
  const double all = std::numeric_limits<double>::infinity();
  return {{-all, -all, altitude.min_m}, {all, all, altitude.max_m}};
}

/// Sight, range and front, the first claims, are proved of the mesh as it is, and nothing else is wrong.
bool can_certify(const ProofReport& report) {
  constexpr std::ptrdiff_t kFirst = 3;
  return report.certificate && report.verdict() != ProofVerdict::wrong && report.layer_m == 0 &&
         std::all_of(report.claims.begin(), report.claims.begin() + kFirst,
                     [](const ClaimProof& claim) { return claim.verdict == ProofVerdict::proved; });
}

/// The limits that are boxes, where they are proved.
std::vector<CertifiedBox> certified_boxes(const Navigation& navigation, const std::vector<ClaimProof>& claims) {
  std::vector<CertifiedBox> boxes;
  for (const ClaimProof& claim : claims) {
    if (claim.verdict != ProofVerdict::proved) continue;
    if (claim.name == "altitude") boxes.push_back({claim.name, box_of(*navigation.altitude)});
    if (claim.name == "keep_in" && navigation.keep_in.size() == 1 && navigation.keep_in[0].is_box) {
      boxes.push_back({claim.name, navigation.keep_in[0].box()});
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
  ProofVerdict worst = claims.empty() ? ProofVerdict::not_proved : ProofVerdict::proved;
  for (const ClaimProof& claim : claims) worst = std::max(worst, claim.verdict);
  return worst;
}

ProofReport prove_volume(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                         const Mesh& volume, const ProveOptions& options, const Progress& callback) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(target, sensor, options);
  check_navigation(navigation, callback);
  check_scene(scene);
  const internal::core::ProgressReporter progress(callback);
  progress.begin("prove");
  ProofReport report = Prover(scene, target, sensor, navigation, volume, options).run(progress);
  if (!options.other_side_m && can_certify(report)) {
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
  check_navigation(navigation, callback);
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
