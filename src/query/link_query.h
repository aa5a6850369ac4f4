// Positions of a vehicle against the scene, by the exact zone of its radio link: docs/theory.md, "Radio links".
#pragma once

#include <cstdint>
#include <functional>

#include "scene/prepared_data.h"
#include "vantage/sensor.h"

namespace vantage::internal::query {

class LinkQuery {
 public:
  /// `antenna`: scene frame. Keeps a reference to the scene.
  LinkQuery(const PreparedScene::Data& scene, const Vec3& antenna, const RadioLink& link);

  /// How far a vehicle may be in a direction (scene axes, unit length) so that nothing enters its zone, at most
  /// `farthest` metres. What enters the zone of one position enters that of all farther ones. Cost: one walk of the
  /// scene's hierarchy, along the line.
  double reach(const Vec3& direction, double farthest) const;

  /// Calls visit(object) for what enters the zone of the vehicle at that distance; for an object once or more.
  void for_each_entering(const Vec3& direction, double distance, const std::function<void(std::uint32_t)>& visit) const;

  // For legs; positions are about the antenna, and zones are of ways that are longer by `more` metres, which is not
  // negative.

  /// Calls visit(polygon, point) for each polygon that enters the zone, with a point where it does.
  void for_each_polygon_entering(const Vec3& vehicle, double more,
                                 const std::function<void(std::uint32_t, const Vec3&)>& visit) const;
  bool enters(std::uint32_t polygon, const Vec3& vehicle, double more) const;
  double distance_m(std::uint32_t polygon, const Vec3& from) const;
  /// Whether the straight way to the vehicle crosses the polygon.
  bool crosses(std::uint32_t polygon, const Vec3& vehicle) const;
  std::uint32_t object_of(std::uint32_t polygon) const { return scene_.polygon_object[polygon]; }

  const Vec3& antenna() const { return antenna_; }  ///< relative to the scene's origin
  double excess_m() const { return excess_; }       ///< how much longer the ways of a zone are than the straight one

 private:
  const PreparedScene::Data& scene_;
  Vec3 antenna_;  // relative to the scene's origin
  double excess_;
};

}  // namespace vantage::internal::query
