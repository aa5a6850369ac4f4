// What of a mission makes every tour impossible: found before anything is searched for.
#pragma once

#include <filesystem>

#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/navigation.h"
#include "vantage/scene.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// In plan: the width of the narrowest strip that holds all positions that the limits allow, or more. Infinite where
/// nothing is to be stayed in.
double least_width_m(const Navigation& navigation);

/// Throws Error(input) where a closed flight of a fixed wing does not fit in the zones to stay in: by its turns it is
/// as wide in each direction as the smallest circle, whatever its course is.
void check_room_to_turn(const Mission& mission, const TourSettings& settings);

/// For an open flight of a fixed wing in such zones, which cannot turn round in them: throws Error(input) where no
/// target is visited, and returns a note where some are left out. Nothing else.
std::optional<std::string> note_of_narrow_zones(const Mission& mission, const TourSettings& settings, const Tour& tour);

/// Straight above the home that is given, the lowest place where the airspace allows to be, with all within
/// `deviation_m`. Throws Error(input) where there is none, where something stands on the way up, and for a home inside
/// a solid, or more than 2 m under the ground.
Vec3 start_above(const Vec3& given, const Mission& mission, const PreparedScene& scene, const Airspace& airspace,
                 double deviation_m);

/// So far above the home, but 20 m at most, the airspace allows to climb on from the tour's start straight above it.
/// To the centimetre, never more, and so that rounding a plan breaks no limit.
double room_above_m(const Vec3& home, const Vec3& start, const Airspace& airspace);

/// Throws Error(input or output) where a certificate of the mission's tour, or the mesh of a target beside it, cannot
/// be written, would replace an input, or, of a mesh, a file that vantage did not write.
void check_tour_certificate_files(const Mission& mission, const std::filesystem::path& certificate);

}  // namespace vantage::internal::flight::tour
