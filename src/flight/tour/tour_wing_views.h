// How a fixed wing views a target: a straight level stretch in its volume, full circles, or one pose.
#pragma once

#include <optional>
#include <vector>

#include "flight/tour/tour_course.h"
#include "flight/tour/tour_random.h"
#include "vantage/dubins.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

struct View {
  int region = Stop::kFixed;  ///< home
  SpacePose enter;
  double straight_m = 0;  ///< level, after `enter`; 0 with circles
  double circles_m = 0;   ///< on level full circles of the turn radius; they end where they begin
  int side = 1;           ///< of the circles: 1 left, -1 right
};

SpacePose leave(const View& view);

/// From where to where views are drawn: about a place and a heading.
struct ViewHint {
  Vec3 place = Vec3::Zero();
  double heading_rad = 0;
  double spread = 1;  ///< 1: anywhere; less: as much of the region's size and of half a turn
};

/// What all parts of the search for a fixed wing share. Regions are deeper than the margin by the chord error: so a
/// curve is as deep as it should be where its chords are in them.
class WingSpace {
 public:
  WingSpace(const TourRequest& request, const Regions& regions);

  /// The length of a view that takes the dwell; a little more, for rounding.
  double view_m() const { return view_m_; }
  const WingLimits& limits() const { return limits_; }
  const Regions& regions() const { return regions_; }
  const TourRequest& request() const { return request_; }

  /// Whether the camera can follow the target of a region along chords, or past the one place where a view is a point.
  bool can_follow(int region, const std::vector<Vec3>& points, const Vec3& direction) const;
  /// Whether it is in its region and in the airspace, and slow enough for the camera.
  bool is_valid(const View& view) const;
  /// Up to `count` valid views. Straight ones, and circles where there are none. None: no room was found.
  std::vector<View> draw_views(int region, const ViewHint& hint, std::size_t count, SplitMix64& draw) const;

  /// From the end of one view to the beginning of another; its length, infinite where there is none.
  std::optional<DubinsAirplanePath> path(const View& from, const View& to) const;
  double path_m(const View& from, const View& to) const;
  /// No such path is shorter: the plane's shortest path, and the difference of heights. Some hundred times as fast.
  double path_bound_m(const View& from, const View& to) const;
  /// Whether the airspace allows it all, and the camera can turn from the one target to the other meanwhile.
  bool is_clear(const View& from, const View& to) const;

  /// Chords of a path or a view, with both ends. Those of a path are the ends of its views: rounding took it past them.
  std::vector<Vec3> chords(const DubinsAirplanePath& path, const View& from, const View& to) const;
  std::vector<Vec3> chords(const View& view) const;

 private:
  bool is_allowed(const std::vector<Vec3>& points, double deviation) const;
  int circle_pieces() const;
  View drawn(int region, const ViewHint& hint, SplitMix64& draw) const;

  const TourRequest& request_;
  const Regions& regions_;
  WingLimits limits_;
  double view_m_ = 0;
};

}  // namespace vantage::internal::flight::tour
