#include "maps/city/tile_frame.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/input.h"
#include "maps/osm/longitude_span.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

constexpr std::size_t kSamples = 64;  // along each side of a box
constexpr double kPad = 2;            // metres
constexpr double kMostReach = 100e3;  // metres

/// Calls `visit(s, t)`, both from 0 to 1, for places along the sides of a square.
template <typename Visit>
void for_samples(const Visit& visit) {
  for (std::size_t i = 0; i <= kSamples; ++i) {
    const double s = static_cast<double>(i) / kSamples;
    visit(s, 0.0);
    visit(s, 1.0);
    visit(0.0, s);
    visit(1.0, s);
  }
}

PlanBounds padded(PlanBounds bounds) {
  // Between two samples a side of 100 km may bulge by a ten-thousandth of its length.
  const double pad = kPad + 1e-4 * (bounds.max - bounds.min).maxCoeff();
  bounds.min.array() -= pad;
  bounds.max.array() += pad;
  return bounds;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& fix) {
  throw Error(ErrorCode::value_out_of_range, problem, "frame", fix);
}

}  // namespace

void check_frame(const CityOptions& options) {
  const CityFrame& frame = *options.frame;
  const auto& [west, south, east, north] = frame.ground_m;
  const char* const fix = "take the frame of a plan of tiles";
  if (!(west < east) || !(south < north) || !(std::max({-west, -south, east, north}) <= kMostReach) ||
      !(std::min({west, south, -east, -north}) >= -kMostReach)) {
    refuse("the ground of the frame is no rectangle of west, south, east, north in metres", fix);
  }
  if (!(frame.reach_m >= 0) || !(frame.reach_m <= kMostReach)) {
    refuse("the reach of the frame is " + shortest(frame.reach_m) + " m", fix);
  }
  if (!options.terrain.empty()) {
    throw Error(ErrorCode::not_applicable, "a region of a frame stands on flat ground", "terrain",
                "leave the terrain out, or build the map in one piece");
  }
}

Box bounds_of_whole(const CityFrame& frame) {
  Box box;
  box.extend({frame.ground_m[0], frame.ground_m[1], 0});
  box.extend({frame.ground_m[2], frame.ground_m[3], 0});
  return box;
}

PlanBounds plan_bounds(const osm::Region& region, const geo::LocalFrame& frame) {
  PlanBounds bounds;
  if (region.circle) {
    const Vec2 centre = frame.to_local(region.circle->first);
    bounds.extend(centre - Vec2::Constant(region.circle->second));
    bounds.extend(centre + Vec2::Constant(region.circle->second));
  }
  if (region.box_deg) {
    const std::array<double, 4>& box = *region.box_deg;  // west, south, east, north
    const double width = geo::LongitudeRange{box[0], box[2]}.width_deg(), height = box[3] - box[1];
    for_samples([&](double s, double t) { bounds.extend(frame.to_local({box[0] + s * width, box[1] + t * height})); });
  }
  return padded(bounds);
}

std::array<double, 4> degrees_round(const PlanBounds& bounds, const geo::LocalFrame& frame) {
  const PlanBounds larger = padded(bounds);
  const Vec2 pole = frame.to_local({0, frame.origin().latitude_deg > 0 ? 90.0 : -90.0});
  if (larger.meets({pole, pole})) {
    throw Error(ErrorCode::not_applicable, "a map round a pole cannot be cut into tiles", "tiles",
                "build the map in one piece");
  }
  osm::LongitudeSpan longitudes;
  double low = 90, high = -90;
  for_samples([&](double s, double t) {
    const geo::LonLat at = frame.to_lonlat(larger.min + Vec2(s, t).cwiseProduct(larger.max - larger.min));
    longitudes.add(at.longitude_deg);
    low = std::min(low, at.latitude_deg);
    high = std::max(high, at.latitude_deg);
  });
  return {longitudes.range().west, low, longitudes.range().east, high};
}

void leave_out_beyond(const std::optional<osm::Region>& region, const geo::LocalFrame& frame, Site& site) {
  if (!region) return;
  const PlanBounds wanted = plan_bounds(*region, frame);
  const std::size_t before = site.items.size();
  std::erase_if(site.items, [&](const Item& item) { return !wanted.meets(bounds_of(item.shapes)); });
  site.outside.add(before - site.items.size(), 0);
}

}  // namespace vantage::internal::city
