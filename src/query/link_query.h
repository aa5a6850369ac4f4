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

  /// Calls visit(object) for what enters the zone of the vehicle at that distance; for an object once or more. Of a
  /// zone whose ways are longer by `more` metres, which may be negative: nothing enters one without length.
  void for_each_entering(const Vec3& direction, double distance, const std::function<void(std::uint32_t)>& visit,
                         double more = 0) const;

  const Vec3& antenna() const { return antenna_; }  ///< relative to the scene's origin
  double excess_m() const { return excess_; }       ///< how much longer the ways of a zone are than the straight one

 private:
  const PreparedScene::Data& scene_;
  Vec3 antenna_;  // relative to the scene's origin
  double excess_;
};

}  // namespace vantage::internal::query
