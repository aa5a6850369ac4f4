// Where a plan of a tour takes its photos.
#pragma once

#include <optional>
#include <string>

#include "vantage/flight.h"
#include "vantage/mission_tour.h"

namespace vantage::internal::flight::tour {

/// The points of the tour's flight with one more for each view, where the camera is turned so that it has the whole
/// target in its picture (ViewAim) and takes a photo: where the vehicle hovers in the view, or in the middle of its way
/// through it. Of several views from one place each has a point of its own there, and its part of the time, or as long
/// as the camera needs to turn. A view of a volume has no photo. The camera of a fixed wing is turned to a point, since
/// its nose cannot be: the vehicle's yaw is that of its track.
void add_views(const MissionTour& of, const Mission& mission, FlightOut& out);

/// Where the gimbal does not reach the pitches of these photos, or it is not known whether it does.
std::optional<std::string> note_of_pitches(const MissionTour& of, const Mission& mission);

}  // namespace vantage::internal::flight::tour
