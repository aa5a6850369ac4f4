// PointQuery::fractions: docs/theory.md, "How much is seen".
#include <algorithm>
#include <limits>
#include <optional>

#include "exact/blocker.h"
#include "query/join_pieces.h"
#include "query/measure.h"
#include "query/point_query_data.h"
#include "query/shadow.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::exact::BlockerBuilder;
using internal::exact::clip_to_front;
using internal::query::BlockerIndex;
using internal::query::JoinedPolygon;
using internal::query::Measure;
using internal::query::Pieces;
using internal::query::Reach;
using internal::query::Ring;
using internal::query::Shadows;
using internal::query::Side;
using HidingPlane = internal::core::Plane;

/// From here on lines of sight are parallel: all targets and scenes are smaller than 1e9 m.
constexpr double kParallel = 1e30;

/// Corners of seen polygons that are nearer to each other are one, in parts of the target's radius.
constexpr double kSnap = 1e-9;

/// The largest share of what is not seen whole.
constexpr double kLessThanAll = 1 - std::numeric_limits<double>::epsilon() / 2;

/// Sums over the parts that were looked at so far.
struct Sum {
  double seen = 0, all = 0;
  bool is_whole = true;  ///< in front of all, and nothing hides any of them
};

/// Finds what hides one side of a target from a point; kept from point to point by each thread.
class HidingSearch {
 public:
  /// Collects the shadows of all that hides some of the target from the point at `distance` along `direction` (local,
  /// unit length). By the test that PointQuery::answer makes. Returns whether there is anything.
  bool find(Side& side, const Vec3& direction, double distance, Shadows& shadows) {
    const double farthest = std::max(distance, 1 / side.range.gauge(direction));
    const Box pyramid = side.pyramid(direction, farthest);
    Reach& reach = side.reach_for(farthest);
    is_any_ = false;
    if (reach.index) {
      look_up(side, *reach.index, pyramid, direction, distance, shadows);
    } else {
      walk(side, reach, pyramid, direction, distance, shadows);
    }
    return is_any_;
  }

 private:
  bool add(const Side& side, std::uint32_t polygon, Shadows& shadows) {
    is_any_ = true;
    clip_to_front(corners_, side.target.slack, clipped_);
    return clipped_.size() < 3 || shadows.add(clipped_, polygon);
  }

  void look_up(const Side& side, BlockerIndex& index, const Box& pyramid, const Vec3& direction, double distance,
               Shadows& shadows) {
    index.for_each(direction, [&](const BlockerIndex::Entry& entry, double bound) {
      if (!(bound * distance > 1)) return false;
      const BlockerIndex::Blocker& blocker = index.blocker(entry.blocker);
      // The plane that gave the bound is most likely the one that the point is not behind.
      if (blocker.plane_count > 0 && !(index.plane(entry.plane).dot(direction) * distance > 1)) return true;
      if (!internal::query::hides(index.planes_of(blocker), direction, distance)) return true;
      if (!internal::query::overlap(side.scene.bvh.nodes[blocker.leaf].bounds, pyramid)) return true;
      internal::target::local_polygon(side.scene, side.frame, blocker.polygon, corners_);
      return add(side, blocker.polygon, shadows);
    });
  }

  void walk(const Side& side, Reach& reach, const Box& pyramid, const Vec3& direction, double distance,
            Shadows& shadows) {
    BlockerBuilder builder(side.target);
    std::size_t work = 0;
    bool is_any_left = true;
    internal::query::for_each_polygon(side.scene, pyramid, [&](std::uint32_t polygon) {
      internal::target::local_polygon(side.scene, side.frame, polygon, corners_);
      planes_.clear();
      clipped_.clear();
      ++work;
      if (builder.build(corners_, planes_, clipped_) && internal::query::hides(planes_, direction, distance)) {
        is_any_left = add(side, polygon, shadows);
      }
      return is_any_left;
    });
    reach.work += work;
  }

  std::vector<Vec3> corners_, clipped_;
  std::vector<HidingPlane> planes_;
  bool is_any_ = false;
};

std::vector<Vec3> in_scene(const TargetFrame& frame, const Ring& ring) {
  std::vector<Vec3> corners;
  corners.reserve(ring.size());
  for (const auto& t : ring) corners.push_back(frame.to_scene({t.x(), t.y(), 0}));
  return corners;
}

void append_polygons(const Side& side, const Pieces& pieces, std::vector<SeenPolygon>& polygons) {
  for (const JoinedPolygon& joined : internal::query::join_pieces(pieces, kSnap * side.target.radius)) {
    SeenPolygon polygon{in_scene(side.frame, joined.outer), {}};
    for (const Ring& hole : joined.holes) polygon.holes.push_back(in_scene(side.frame, hole));
    polygons.push_back(std::move(polygon));
  }
}

Vec3 eye_at(const Side& side, const internal::query::Bearing& bearing, const Vec3& scene_point) {
  return bearing.distance < kParallel ? side.frame.to_local(scene_point) : Vec3(bearing.direction * kParallel);
}

/// A single point is seen, or it is not.
void look_at_point(Side& side, const Vec3& scene_point, Shadows& shadows, Sum& sum) {
  thread_local HidingSearch search;
  const internal::query::Bearing bearing = side.bearing_of(scene_point);
  const Vec3 direction = bearing.distance > 0 ? bearing.direction : Vec3(Vec3::UnitZ());
  shadows.begin(side.target.vertices, eye_at(side, bearing, scene_point));
  sum.is_whole = !side.is_behind(bearing) && !search.find(side, direction, bearing.distance, shadows);
}

void look_at_part(Side& side, const Vec3& scene_point, const FractionOptions& options, Shadows& shadows, Sum& sum,
                  std::vector<SeenPolygon>& polygons) {
  thread_local HidingSearch search;
  const internal::query::Bearing bearing = side.bearing_of(scene_point);
  const bool is_behind = side.is_behind(bearing);
  const Vec3 eye = eye_at(side, bearing, scene_point);
  const Measure measure(options.measure, side.target.vertices, Vec3(eye.x(), eye.y(), std::abs(eye.z())));
  const double all = measure.of(side.target.vertices);
  sum.all += all;
  shadows.begin(side.target.vertices, eye);
  const bool is_whole = !is_behind && !search.find(side, bearing.direction, bearing.distance, shadows);
  sum.is_whole = sum.is_whole && is_whole;
  if (is_whole) sum.seen += all;
  if (is_behind || (is_whole && !options.with_polygons)) return;
  const Pieces& pieces = shadows.seen();
  for (std::size_t i = 0; i < pieces.count() && !is_whole; ++i) sum.seen += measure.of(pieces[i]);
  if (options.with_polygons) append_polygons(side, pieces, polygons);
}

double fraction_of(const Sum& sum) {
  if (sum.is_whole) return 1;
  return sum.all > 0 ? std::min(sum.seen / sum.all, kLessThanAll) : 0;
}

}  // namespace

const char* name_of(FractionMeasure measure) {
  switch (measure) {
    case FractionMeasure::area:
      return "area";
    case FractionMeasure::solid_angle:
      return "solid_angle";
    case FractionMeasure::pixels:
      return "pixels";
  }
  return "";
}

std::optional<FractionMeasure> fraction_measure(std::string_view name) {
  for (const auto measure : {FractionMeasure::area, FractionMeasure::solid_angle, FractionMeasure::pixels}) {
    if (name == name_of(measure)) return measure;
  }
  return std::nullopt;
}

void internal::query::check_has_share(const PreparedTarget& target) {
  if (!target.sensor().link) return;
  throw Error(ErrorCode::not_applicable, "the zone of a radio link is clear or not: no share of it is seen",
              "sensor.link", "leave out the link, or ask without a fraction");
}

std::vector<PointFraction> PointQuery::fractions(std::span<const Vec3> points, const FractionOptions& options) {
  internal::query::check_finite(points);
  internal::query::check_has_share(data_->target);
  const bool is_point = data_->target.target().is_point();
  std::vector<Sum> sums(points.size());
  std::vector<PointFraction> result(points.size());
  for (const internal::query::Sides& sides : data_->parts) {
    internal::query::look_from_all(sides, points, [&](Side& side, std::size_t i) {
      thread_local Shadows shadows;
      if (is_point) {
        look_at_point(side, points[i], shadows, sums[i]);
      } else {
        look_at_part(side, points[i], options, shadows, sums[i], result[i].seen);
      }
    });
  }
  for (std::size_t i = 0; i < points.size(); ++i) result[i].fraction = fraction_of(sums[i]);
  return result;
}

}  // namespace vantage
