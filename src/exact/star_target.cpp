#include "exact/star_target.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/enclosing_circle.h"
#include "scene/prepared_data.h"
#include "target/lengths.h"
#include "target/range_check.h"
#include "target/star_cover.h"

namespace vantage::internal::exact {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

/// Of Lengths::slack: the volume's own corners in the plane are rounded, too.
constexpr double kOfSlack = 0.25;

/// The parts in the frame of the first one. Nothing where one lies in another plane: the volume is in front of all of
/// them, as far as it reaches.
std::vector<Polygon> parts_in_one_plane(const PreparedTarget& prepared) {
  const TargetFrame& frame = prepared.frame();
  const double range = range_limit_m(prepared.sensor());
  const double near = kOfSlack * target::lengths_of(prepared.scene().data(), frame, range).slack;
  std::vector<Polygon> parts;
  for (std::size_t i = 0; i < prepared.part_count(); ++i) {
    const TargetFrame& own = prepared.frame(i);
    if (!((own.normal - frame.normal).norm() * range <= near)) return {};
    Polygon& part = parts.emplace_back();
    for (const Vector2d& corner : own.polygon) {
      const Vec3 at = frame.to_local(own.to_scene({corner.x(), corner.y(), 0}));
      if (std::abs(at.z()) > near) return {};
      part.emplace_back(at.x(), at.y());
    }
  }
  return parts;
}

}  // namespace

std::optional<StarTarget> star_target(const PreparedTarget& prepared) {
  if (prepared.target().is_point()) return std::nullopt;
  if (prepared.part_count() == 1) {
    if (!target::can_reach(prepared.frame(), prepared.sensor())) return std::nullopt;
    return StarTarget{prepared.frame(), {prepared.frame().polygon}};
  }
  const std::vector<Polygon> parts = parts_in_one_plane(prepared);
  if (parts.empty()) return std::nullopt;
  std::optional<target::StarCover> cover = target::star_cover(parts);
  if (!cover) return std::nullopt;

  StarTarget star{prepared.frame(), std::move(cover->polygons)};
  star.frame.origin = prepared.frame().to_scene({cover->centre.x(), cover->centre.y(), 0});
  // What rounding does to its place in the scene is taken out of the coordinates.
  const Vector2d moved = prepared.frame().to_local(star.frame.origin).head<2>();
  star.frame.polygon = std::move(cover->hull);
  for (Vector2d& corner : star.frame.polygon) corner -= moved;
  for (Polygon& polygon : star.cover) {
    for (Vector2d& corner : polygon) corner -= moved;
  }
  star.frame.enclosing_radius_m = core::smallest_enclosing_circle(star.frame.polygon).radius;
  double farthest = 0;
  for (const Vector2d& corner : star.frame.polygon) farthest = std::max(farthest, corner.norm());
  // As far as origins of other targets may be: move_into_range.
  const double allowed = 0.5 * (star.frame.enclosing_radius_m + range_limit_m(prepared.sensor()));
  if (!target::can_reach(star.frame, prepared.sensor()) || farthest > allowed) return std::nullopt;
  return star;
}

}  // namespace vantage::internal::exact
