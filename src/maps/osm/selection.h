// Which objects lie in the region, and how far the others are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_set>

#include "maps/osm/extract.h"
#include "maps/osm/map_objects.h"
#include "maps/osm/region_filter.h"

namespace vantage::internal::osm {

/// An object lies in the region when a corner or some of a side does. What is closed, or may be an area, and every
/// relation do so when a box round them does: what is made of them is not known yet, and more of them than need be is
/// harmless. What belongs to one type=building relation is taken together: a tower without the parts that replace it
/// would be wrong.
class Selection {
 public:
  Selection(const MapObjects& objects, const RegionFilter& region);

  bool holds(ObjectId id) const;  ///< a way or a relation
  bool holds(const Point& point) const { return region_.contains(point.position); }

  // Count an object that is wanted and that is not held.
  void leave_out(const Point& point);
  void leave_out(const osmium::Way& way);
  void leave_out(const osmium::Relation& multipolygon);

  std::size_t outside() const { return outside_; }
  double nearest_outside_m() const { return outside_ == 0 || nearest_ > kFarthest ? 0 : nearest_; }

 private:
  static constexpr double kFarthest = std::numeric_limits<double>::max();

  bool meets(const osmium::Relation& relation) const;
  void take_buildings_together();
  void measure(const osmium::Way& way);

  const MapObjects& objects_;
  const RegionFilter& region_;
  std::unordered_set<std::int64_t> ways_, relations_;  // held
  std::size_t outside_ = 0;
  double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace vantage::internal::osm
