// What to do about an object of the scene that stands on the target.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "vantage/error.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// How to leave out an object of a map; nothing for buildings, and in other scenes. `object`: of the scene.
/// `target_object`: the map's object that is the target ("way/123" or its name), or empty: its own fence may stand on
/// its outline.
std::optional<std::string> how_to_leave_out(const LoadedScene& loaded, std::uint32_t object,
                                            const std::string& target_object);

/// How to leave out a stand-in of the scene's ledger, and what it is; nothing for other objects.
std::optional<std::string> how_to_leave_out_stand_in(const LoadedScene& loaded, std::uint32_t object);

/// How to make the roof of an object the target that has a place inside of it: "for its roof write ...".
std::string how_to_take_roof(const LoadedScene& loaded, std::uint32_t object, const Vec3& at);

/// The same error, ErrorCode::target_pierced, with advice that fits the object, or the scene where that seems to lie on
/// its side.
Error explained(const Error& error, const LoadedScene& loaded, const std::string& target_object);

}  // namespace vantage::internal::app
