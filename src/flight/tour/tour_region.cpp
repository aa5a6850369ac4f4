#include "flight/tour/tour_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <queue>
#include <utility>

#include "core/bounds_distance.h"
#include "core/closed_mesh_check.h"
#include "core/format.h"
#include "core/parallel.h"
#include "core/walk_bvh.h"
#include "flight/tour/tour_detour.h"
#include "flight/tour/tour_half_spaces.h"
#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

/// Points move by a rounding of the largest coordinate when they are written in the scene frame. 64 of them, and a
/// billionth of the mesh, are more than all that is computed here loses.
constexpr double kRoundings = 64 * std::numeric_limits<double>::epsilon();
constexpr double kOfSize = 1e-9;
constexpr std::size_t kMostAnchors = 64;

Vec3 middle_of(const Box& box) { return box.empty() ? Vec3(Vec3::Zero()) : Vec3((box.min + box.max) / 2); }

Mesh moved(const Mesh& mesh, const Vec3& origin) {
  Mesh result = mesh;
  for (Vec3& vertex : result.vertices) vertex -= origin;
  return result;
}

const Mesh& checked(const Mesh& mesh, const std::string& name) {
  if (mesh.empty()) {
    throw Error(ErrorCode::mesh_empty, "the volume of a target has no triangles: nowhere is the target seen", name,
                "leave the target out, or change what its volume is computed from");
  }
  try {
    core::check_closed(mesh);
    core::check_oriented(mesh);
  } catch (const Error& error) {
    throw error.with_where(name);
  }
  if (!(enclosed_volume(mesh) > 0)) {
    throw Error(ErrorCode::mesh_inside_out, "the volume of a target encloses no space, or faces inward", name,
                "give a closed mesh whose triangles face outward");
  }
  return mesh;
}

core::Bounds bounds_of(const Box& box) {
  constexpr float kUnbounded = std::numeric_limits<float>::infinity();
  core::Bounds bounds{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -kUnbounded);
    bounds.max[axis] = std::nextafter(static_cast<float>(box.max[axis]), kUnbounded);
  }
  return bounds;
}

double distance_to_box(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

/// Ericson, "Real-Time Collision Detection", 2005, 5.1.5.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? Vec3(a + d1 / (d1 - d3) * ab) : a;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 > d6 ? Vec3(a + d2 / (d2 - d6) * ac) : a;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double sum = (d4 - d3) + (d5 - d6);
    return sum > 0 ? Vec3(b + (d4 - d3) / sum * (c - b)) : b;
  }
  const double sum = va + vb + vc;
  return sum != 0 ? Vec3(a + vb / sum * ab + vc / sum * ac) : a;
}

}  // namespace

TourRegion::TourRegion(std::string name, const Mesh& volume, double margin_m)
    : name_(std::move(name)),
      origin_(middle_of(bounding_box(checked(volume, name_)))),
      mesh_(moved(volume, origin_)),
      tree_(mesh_),
      margin_(margin_m) {
  const Box mesh_box = bounding_box(mesh_);
  size_ = (mesh_box.max - mesh_box.min).norm();
  rounding_ = kOfSize * size_ + kRoundings * (origin_.cwiseAbs().maxCoeff() + size_);
  least_depth_ = margin_ + rounding_;
  sought_depth_ = least_depth_ + rounding_;
  box_ = {mesh_box.min.array() + margin_ + origin_.array(), mesh_box.max.array() - margin_ + origin_.array()};

  std::vector<core::Bounds> bounds(mesh_.triangles.size());
  for (std::size_t t = 0; t < bounds.size(); ++t) bounds[t] = bounds_of(core::triangle_box(mesh_, t));
  std::vector<std::uint32_t> order;
  bvh_ = core::build_bvh(bounds, order);
  for (const std::uint32_t t : order) {
    const Triangle& triangle = mesh_.triangles[t];
    corners_.push_back({mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]], mesh_.vertices[triangle[2]]});
  }
  find_anchors();
}

TourRegion::Surface TourRegion::surface_at(const Vec3& point) const {
  const core::TriangleTree::Nearest found = tree_.nearest(point);
  const Triangle& t = mesh_.triangles[found.triangle];
  const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
  const Vec3 nearest = nearest_on_triangle(point, a, b, c);
  const double depth = signed_depth(found.distance, point);
  if (found.distance > rounding_) return {nearest, (depth > 0 ? 1 : -1) * (point - nearest).normalized(), depth};
  const Vec3 outward = (b - a).cross(c - a);
  const double area = outward.norm();
  return {nearest, area > 0 ? Vec3(-outward / area) : Vec3(Vec3::UnitZ()), depth};
}

double TourRegion::depth(const Vec3& point) const { return signed_depth(tree_.distance(point), point); }

/// What is so near to the surface that rounding decides counts as outside. Rays could not tell either.
double TourRegion::signed_depth(double distance, const Vec3& point) const {
  if (distance < rounding_ / 2) return -distance;
  return tree_.winding_number(point) < 1 ? -distance : distance;
}

double TourRegion::touch_bound_m(const Vec3& a, const Vec3& b) const {
  return std::max((a - b).norm(), distance_to_box(box_, a) + distance_to_box(box_, b));
}

/// The least one of the surface, of all triangles: branch and bound in the hierarchy.
Vec3 TourRegion::touch_of_mesh(const Vec3& a, const Vec3& b, double smoothing) const {
  Vec3 best = corners_.front()[0];
  double least = std::numeric_limits<double>::infinity();
  core::walk_nearer_first(
      bvh_, [&](const core::Bounds& box) { return core::distance_to(box, a) + core::distance_to(box, b); },
      [&](const core::BvhNode&, double bound) { return bound < least; },
      [&](std::uint32_t item) {
        const Vec3 x = shortest_on_triangle(corners_[item], a, b, smoothing);
        const double length = way_length(a, x, b, smoothing);
        if (length >= least) return;
        least = length;
        best = x;
      });
  return best;
}

/// The depth changes by at most a metre in a metre, so steps of what is lacking miss nothing; smaller ones than a
/// two-hundredth of the way are not made.
std::optional<Vec3> TourRegion::first_inside(const Vec3& from, const Vec3& to) const {
  const double length = (to - from).norm(), least_step = length / 200;
  for (double s = 0;;) {
    const Vec3 point = length > 0 ? Vec3(from + s / length * (to - from)) : from;
    const double lack = sought_depth_ - depth(point);
    if (lack <= 0) return point;
    if (s >= length || lack > length - s) return std::nullopt;
    s = std::min(length, s + std::max(lack, least_step));
  }
}

/// The point in the middle, or the nearest one to it.
std::optional<Vec3> TourRegion::on_segment(const Vec3& a, const Vec3& b) const {
  const Vec3 middle = (a + b) / 2;
  std::optional<Vec3> one = first_inside(middle, a);
  if (one && *one == middle) return one;
  const std::optional<Vec3> other = first_inside(middle, b);
  if (!one || !other) return one ? one : other;
  return (*one - middle).squaredNorm() <= (*other - middle).squaredNorm() ? one : other;
}

/// Cutting planes: the point is the best one of half-spaces; where it is not deep enough, the surface next to it gives
/// one more. In a convex region these are half-spaces of its facets, and the last point is the best one of the region.
std::optional<Vec3> TourRegion::by_cuts(const Vec3& start, const Vec3& a, const Vec3& b, double smoothing) const {
  HalfSpaces cuts;
  Vec3 point = start;
  constexpr int kMostCuts = 16;
  for (int i = 0; i < kMostCuts; ++i) {
    const Surface surface = surface_at(point);
    if (surface.depth >= sought_depth_) return point;
    cuts.add(surface.inward, surface.inward.dot(surface.nearest) + sought_depth_ + rounding_);
    const std::optional<Vec3> next = cuts.shortest_way(a, b, smoothing);
    if (!next) return std::nullopt;
    point = *next;
  }
  return std::nullopt;
}

/// From the best anchor as far towards a point as the region goes.
Vec3 TourRegion::from_anchors(const Vec3& towards, const Vec3& a, const Vec3& b) const {
  Vec3 best = anchors_.front() - origin_;
  for (const Vec3& anchor : anchors_) {
    const Vec3 point = anchor - origin_;
    if (way_length(a, point, b, 0) < way_length(a, best, b, 0)) best = point;
  }
  double inside = 0, outside = 1;
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (inside + outside) / 2;
    (depth(best + middle * (towards - best)) >= sought_depth_ ? inside : outside) = middle;
  }
  const Vec3 moved_on = best + inside * (towards - best);
  return depth(moved_on) >= sought_depth_ ? moved_on : best;
}

/// From a point of the region to better ones: the cuts next to it and next to where they lead, then as far that way as
/// the region goes. For regions that are not convex, where cuts from outside contradict each other.
Vec3 TourRegion::descend(const Vec3& start, const Vec3& a, const Vec3& b, double smoothing) const {
  Vec3 point = start;
  constexpr int kMostMoves = 10, kCuts = 4, kHalvings = 7;
  for (int move = 0; move < kMostMoves; ++move) {
    HalfSpaces cuts;
    const auto add = [&](const Surface& surface) {
      cuts.add(surface.inward, surface.inward.dot(surface.nearest) + sought_depth_ + rounding_);
    };
    add(surface_at(point));
    Vec3 wanted = point;
    for (int i = 0; i < kCuts; ++i) {
      const std::optional<Vec3> next = cuts.shortest_way(a, b, smoothing);
      if (!next) break;
      wanted = *next;
      const Surface surface = surface_at(wanted);
      if (surface.depth >= sought_depth_) break;
      add(surface);
    }
    const double before = way_length(a, point, b, smoothing);
    Vec3 best = point;
    double share = 1;
    for (int h = 0; h < kHalvings && best == point; ++h, share /= 2) {
      const Vec3 moved = point + share * (wanted - point);
      if (way_length(a, moved, b, smoothing) < before && depth(moved) >= sought_depth_) best = moved;
    }
    point = best;
    if (before - way_length(a, point, b, smoothing) <= 1e-5 * before) break;
  }
  return point;
}

Vec3 TourRegion::touch(const Vec3& a, const Vec3& b, double smoothing_m, const Vec3* known) const {
  const Vec3 from = a - origin_, to = b - origin_;
  const auto length = [&](const Vec3& x) { return way_length(from, x, to, smoothing_m); };
  if (touch_bound_m(a, b) <= (a - b).norm() * (1 + 1e-12)) {
    if (const std::optional<Vec3> on_way = on_segment(from, to)) return *on_way + origin_;
  }
  const Vec3 of_mesh = touch_of_mesh(from, to, smoothing_m);
  std::optional<Vec3> found = by_cuts(of_mesh, from, to, smoothing_m);
  // Much longer than past the mesh itself: the margin took away what was there, and another part may do better.
  if (!found || length(*found) - length(of_mesh) > 4 * sought_depth_) {
    const Vec3 other = descend(from_anchors(of_mesh, from, to), from, to, smoothing_m);
    if (!found || length(other) < length(*found)) found = other;
  }
  if (known && length(*known - origin_) <= length(*found)) return *known;
  return *found + origin_;
}

std::vector<LegInterval> TourRegion::parts_deeper(const Leg& leg, double least, double grain) const {
  const Vec3 from = leg.from - origin_, along = leg.to - leg.from;
  const double length = along.norm();
  if (!(length > 0)) return depth(from) >= least ? std::vector<LegInterval>{{0, 1}} : std::vector<LegInterval>{};
  std::vector<LegInterval> found;
  for (double s = 0; s < length;) {
    const double spare = depth(from + s / length * along) - least;
    // What is left of the leg may be shorter than the grain.
    if (spare < std::min(grain, length - s)) {
      s += std::max(grain - spare, grain);
      continue;
    }
    const double end = std::min(length, s + spare);
    if (found.empty() || found.back().end < s / length) found.push_back({s / length, s / length});
    found.back().end = end / length;
    s = end;
  }
  return found;
}

std::vector<LegInterval> TourRegion::stretches(const Leg& leg) const {
  return parts_deeper(leg, sought_depth_, std::max(kGrain * size_, rounding_));
}

/// Between two places of a stretch, a point is as deep as half of the grain more than is asked for, or the rest of the
/// stretch is nearer than that.
bool TourRegion::holds_leg(const Leg& leg) const {
  const std::vector<LegInterval> parts = parts_deeper(leg, least_depth_, std::max(kGrain * size_, rounding_) / 2);
  return parts.size() == 1 && parts[0].begin == 0 && parts[0].end == 1;
}

void TourRegion::add_anchor(const Vec3& point) {
  if (anchors_.size() < kMostAnchors && depth(point) >= sought_depth_) anchors_.push_back(point + origin_);
}

/// The deepest point by best-first search in an octree: no point of a cube is deeper than its middle by more than half
/// its diagonal. Then points beside the facets.
void TourRegion::find_anchors() {
  struct Cube {
    double bound;
    Vec3 middle;
    double half;
    bool operator<(const Cube& other) const { return bound < other.bound; }
  };
  const double root_of_3 = std::sqrt(3.0), largest = (box_.max - box_.min).cwiseAbs().maxCoeff() / 2 + margin_;
  std::priority_queue<Cube> open;
  open.push({std::numeric_limits<double>::infinity(), middle_of(bounding_box(mesh_)), largest});
  double deepest = 0;
  std::vector<std::pair<double, Vec3>> points;
  constexpr int kMostCubes = 6000;
  for (int cubes = 0; cubes < kMostCubes && !open.empty();) {
    const Cube cube = open.top();
    open.pop();
    const bool is_enough = deepest >= sought_depth_ && cube.bound <= 1.05 * deepest;
    if (cube.bound < sought_depth_ || is_enough) break;
    for (int corner = 0; corner < 8; ++corner, ++cubes) {
      const double half = cube.half / 2;
      const Vec3 middle = cube.middle + half * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const double found = depth(middle);
      if (found >= sought_depth_) points.emplace_back(found, middle);
      deepest = std::max(deepest, found);
      open.push({found + root_of_3 * half, middle, half});
    }
  }
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  const std::size_t step = std::max<std::size_t>(1, points.size() / (kMostAnchors / 2));
  for (std::size_t i = 0; i < points.size() && anchors_.size() < kMostAnchors / 2; i += step) {
    anchors_.push_back(points[i].second + origin_);
  }
  const std::size_t facet_step = std::max<std::size_t>(1, corners_.size() / (2 * kMostAnchors));
  for (std::size_t i = 0; i < corners_.size(); i += facet_step) {
    const Corners& t = corners_[i];
    const Vec3 outward = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = outward.norm();
    if (!(area > 0)) continue;
    add_anchor((t[0] + t[1] + t[2]) / 3 - (sought_depth_ + rounding_) / area * outward);
  }
  if (!anchors_.empty()) return;
  throw Error(
      ErrorCode::limits_empty,
      core::format("no point of the volume of a target is {:g} m from its border; the deepest found is {:.3g} m",
                   margin_, deepest),
      name_, "ask for a smaller margin or tube, or for a larger volume");
}

Regions make_regions(const std::vector<TourTarget>& targets, double margin_m, const core::ProgressReporter& progress) {
  progress.begin("volumes of the tour");
  Regions regions(targets.size());
  std::vector<std::exception_ptr> wrong(targets.size());
  core::ProgressCounter counter(progress, targets.size());
  parallel::for_ranges(targets.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      try {
        regions[i] = std::make_unique<const TourRegion>(targets[i].name, targets[i].volume, margin_m);
      } catch (const Error&) {
        wrong[i] = std::current_exception();
      }
      counter.add();
    }
  });
  for (const std::exception_ptr& error : wrong) {
    if (error) std::rethrow_exception(error);
  }
  progress.finish();
  return regions;
}

}  // namespace vantage::internal::flight::tour
