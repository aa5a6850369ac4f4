#include <cmath>
#include <memory>
#include <optional>

#include "flight/view_describer_data.h"
#include "vantage/error.h"
#include "vantage/standpoints.h"

namespace vantage::internal::flight {
namespace {

std::optional<GroundLevels> ground_levels(const Mission& mission) {
  try {
    return std::optional<GroundLevels>(std::in_place, ground_of(mission));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::ground_missing) throw;
    return std::nullopt;
  }
}

std::optional<geo::OnGlobe> globe_of(const Mission& mission) {
  const auto& place = mission.scene().georeference;
  return place ? std::optional<geo::OnGlobe>(std::in_place, *place) : std::nullopt;
}

}  // namespace

Surroundings::Surroundings(const Mission& mission)
    : obstacles(mission),
      ground(ground_levels(mission)),
      earth(globe_of(mission)),
      sea_level_m(vantage::sea_level_m(mission)) {}

}  // namespace vantage::internal::flight

namespace vantage {
namespace {

using internal::flight::Surroundings;
using internal::flight::TargetView;

std::shared_ptr<const ViewDescriber::Data> describer_data(const Mission& mission,
                                                          std::shared_ptr<const Surroundings> around) {
  if (volume_count(mission) != 1) {
    throw Error(ErrorCode::not_applicable, "the mission asks for a volume for each of several targets", "mission",
                "take one_volume of it");
  }
  if (!around) around = std::make_shared<const Surroundings>(mission);
  return std::make_shared<const ViewDescriber::Data>(
      ViewDescriber::Data{TargetView(mission), internal::flight::ViewAim(mission), std::move(around)});
}

}  // namespace

ViewDescriber::ViewDescriber(const Mission& mission) : data_(describer_data(mission, nullptr)) {}

ViewDescriber::ViewDescriber(const Mission& mission, const ViewDescriber& other)
    : data_(describer_data(mission, other.data_->around)) {}

ViewDescription ViewDescriber::describe(const Vec3& position) const {
  if (!position.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "a position is not finite", "position", "give three finite numbers");
  }
  const TargetView& target = data_->target;
  const Surroundings& around = *data_->around;
  ViewDescription view;
  view.position = position;
  double height_m = position.z();  // above the level surface through the origin; a map has it as z
  if (around.earth) {
    const internal::geo::Geodetic place = around.earth->to_geodetic(position);
    view.longitude_deg = place.place.longitude_deg;
    view.latitude_deg = place.place.latitude_deg;
    if (around.earth->is_cartesian()) height_m = place.height_m;
  }
  if (around.ground) {
    if (const auto level = around.ground->at(position.x(), position.y())) {
      view.above_ground_m = position.z() - level->highest_m;
    }
  }
  if (around.sea_level_m) view.above_sea_m = height_m - *around.sea_level_m;
  const internal::flight::AimedCamera camera = data_->aim.at(position, target.centre());
  view.yaw_deg = camera.aim.yaw_deg < 360 ? camera.aim.yaw_deg : 0;
  view.pitch_deg = camera.aim.pitch_deg;
  view.is_centred = camera.is_centred;
  view.distance_m = target.distance_m(position);
  if (target.has_pixels()) {
    const double pixel_m = target.pixel_m(position);
    if (std::isfinite(pixel_m)) view.pixel_m = pixel_m;
  }
  if (target.has_incidence()) view.incidence_deg = target.incidence_deg(position);
  if (!around.obstacles.empty()) {
    const internal::flight::Obstacles::Nearest nearest = around.obstacles.nearest(position);
    view.obstacle_distance_m = nearest.distance_m;
    view.obstacle = nearest.name;
  }
  return view;
}

}  // namespace vantage
