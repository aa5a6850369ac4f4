// What positions and legs of a flight see of a mission's targets, told by every triangle of the scene. Exact for what
// hides; limits by their definitions.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flight_margins.h"
#include "trial.h"
#include "vantage/mission.h"
#include "vantage/query.h"

namespace attack {

/// Part of a leg, in shares, and the object that hides there.
struct HiddenPart {
  double begin = 0, end = 0;
  std::uint32_t object = 0;
};

/// One of the targets of which a position has to see one. Positions are in the scene frame.
class OneTarget {
 public:
  OneTarget(const vantage::Scene& scene, const vantage::PreparedTarget& prepared);

  /// Why not all of it is seen from there, whatever the guarantee excepts (vantage/query.h); empty: it is not sure.
  std::string surely_not_seen(const Vec3& position, double rounding_m) const;
  /// Whether all of it is seen with some margin: neither a place `aside_m` beside nor an outline larger by that changes
  /// it. `link_share`: of the zone of a link, that must be free.
  bool surely_seen(const Vec3& position, double aside_m, double margin_m) const;
  /// Whether a triangle of the object hides something from there, surely.
  bool surely_hidden_by(const Vec3& position, std::uint32_t object) const;
  /// Whether a triangle of the object hides something from the position, or from somewhere `aside_m` beside it.
  bool may_be_hidden_by(const Vec3& position, std::uint32_t object, double aside_m) const;

  /// What each triangle surely hides along a leg: one part each, as it is convex. It ends in the planes through a side
  /// of the target and a corner of the triangle, or the other way round; between two of these nothing changes, so one
  /// place between them tells all. Nothing where that would take too long.
  std::vector<HiddenPart> hidden_parts(const vantage::Leg& leg) const;

  std::vector<Margin> margins(const Vec3& position) const { return margins_->at(local(position)); }
  /// For each place on the way from the target to it, what is added by rounding of 1e-9 of the distance.
  double reach(const Vec3& position) const;
  const vantage::Sensor& sensor() const { return sensor_; }

 private:
  Vec3 local(const Vec3& position) const { return position - blockers_.origin; }
  /// The views of one part, for triangles that hide all of these.
  bool hides(const PartView& part, std::size_t triangle, const Vec3& local) const {
    return part.surely_hides(triangle, local);
  }
  std::vector<Vec3> places_beside(const Vec3& local, double aside_m) const;

  vantage::Sensor sensor_;
  Blockers blockers_;
  std::vector<SeenTarget> parts_;
  std::deque<PartView> views_;
  std::unique_ptr<SensorMargins> margins_;
};

/// One volume of a mission: a position sees, of each list, one target or more.
class FlightOracle {
 public:
  FlightOracle(const vantage::Mission& one_volume, const vantage::PreparedScene& scene);

  std::string surely_not_seen(const Vec3& position, double rounding_m) const;
  bool surely_seen(const Vec3& position, double aside_m, double margin_m) const;
  /// The one target, where there is no other.
  const OneTarget* single() const;
  const std::vector<std::vector<std::unique_ptr<OneTarget>>>& lists() const { return lists_; }

 private:
  std::vector<std::vector<std::unique_ptr<OneTarget>>> lists_;
};

/// The smallest distance of a leg from a triangle: where they meet 0, else from end to face or from line to side.
double distance_from_leg(const vantage::Leg& leg, const Corners& triangle);

}  // namespace attack
