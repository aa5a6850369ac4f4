#include "app/tour_home.h"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/places.h"
#include "vantage/earth.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage::internal::app {
namespace {

const Georeference& earth_of(const Mission& mission, const PlaceOfFlight& place) {
  if (mission.scene().georeference) return *mission.scene().georeference;
  throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies", place.where,
              "give " + place.instead + " in the scene frame, or a scene with a place: a map, or a mesh with 'crs'");
}

}  // namespace

Vec3 on_the_ground(const Mission& mission, const std::array<double, 2>& at_deg, const PlaceOfFlight& place,
                   double above_m) {
  const Georeference& earth = earth_of(mission, place);
  const GroundLevels levels(ground_of(mission));
  const Eigen::Vector2d at =
      scene_position(earth, at_deg[1], at_deg[0], [&](const Eigen::Vector2d& p) -> std::optional<double> {
        const auto there = levels.at(p.x(), p.y());
        return there ? std::optional(there->highest_m + above_m) : std::nullopt;
      });
  const std::optional<GroundLevels::Range> ground = levels.at(at.x(), at.y());
  if (!ground) {
    throw Error(ErrorCode::target_off_ground, "there is no ground under " + place.name, place.where,
                "check the order: [latitude, longitude]; or give " + place.instead);
  }
  return {at.x(), at.y(), ground->highest_m + above_m};
}

Vec3 in_the_frame(const Mission& mission, const Vec3& position, const PlaceOfFlight& place) {
  const std::string& crs = mission.as_written.crs;
  if (crs.empty()) return position;
  return scene_positions(earth_of(mission, place), crs, {&position, 1}).front();
}

void place_home(Mission& mission) {
  if (!mission.as_written.tour || !mission.as_written.tour->home) return;
  const TourHome& home = *mission.as_written.tour->home;
  const std::string& where = mission.as_written.places.tour;
  const PlaceOfFlight place{"tour.home", "tour.home as [x, y, z]", where};
  mission.home = core::with_place(where, [&]() -> std::optional<Vec3> {
    if (home.at_deg) return on_the_ground(mission, *home.at_deg, place);
    if (home.position) return in_the_frame(mission, *home.position, place);
    return std::nullopt;
  });
}

}  // namespace vantage::internal::app
