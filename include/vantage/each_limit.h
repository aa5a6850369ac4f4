// All limits of a request, one after the other. What has to treat every limit goes through them here.
#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

#include "vantage/export.h"
#include "vantage/navigation.h"
#include "vantage/sensor.h"

namespace vantage {

/// What a volume is cut to once it is computed: first the limits of Navigation, then those of Sensor. The range, the
/// front, a radio link and the share that must be seen are none of these: the volume is computed with them.
enum class Limit {
  altitude,
  above_ground,
  keep_in,
  keep_out,
  meshes,
  clearance,
  min_range,
  incidence,
  pixel,  ///< PixelLimit::Kind::worst; the other kind is a range
  frame,  ///< of a camera, and of its mount
  sun,
};

/// As proofs and certificates have it: "agl" of Limit::above_ground, else the name above.
VANTAGE_API std::string_view name_of(Limit limit);

/// The type that a limit has in Navigation or Sensor.
template <Limit kLimit>
struct LimitValue;
template <>
struct LimitValue<Limit::altitude> : std::type_identity<Navigation::Altitude> {};
template <>
struct LimitValue<Limit::above_ground> : std::type_identity<AboveGround> {};
template <>
struct LimitValue<Limit::keep_in> : std::type_identity<std::vector<Zone>> {};
template <>
struct LimitValue<Limit::keep_out> : std::type_identity<std::vector<Zone>> {};
template <>
struct LimitValue<Limit::meshes> : std::type_identity<std::vector<KeepInMesh>> {};
template <>
struct LimitValue<Limit::clearance> : std::type_identity<Clearance> {};
template <>
struct LimitValue<Limit::min_range> : std::type_identity<double> {};
template <>
struct LimitValue<Limit::incidence> : std::type_identity<double> {};
template <>
struct LimitValue<Limit::pixel> : std::type_identity<PixelLimit> {};
template <>
struct LimitValue<Limit::frame> : std::type_identity<Pinhole> {};
template <>
struct LimitValue<Limit::sun> : std::type_identity<SunLimit> {};

template <Limit kLimit>
using LimitValueOf = typename LimitValue<kLimit>::type;

/// A limit as a type: what visits has one overload for each, so that one that is added does not compile before it has
/// its own.
template <Limit kLimit>
using LimitIs = std::integral_constant<Limit, kLimit>;

/// Calls `visit(LimitIs<...>, value)` for each limit that is given, in the order of Limit.
template <typename Visit>
void each_limit(const Navigation& navigation, Visit&& visit) {
  // All members are named, here and below: one that is added does not compile before it is. Visit it then.
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation;
  if (altitude) visit(LimitIs<Limit::altitude>{}, *altitude);
  if (above_ground) visit(LimitIs<Limit::above_ground>{}, *above_ground);
  if (!keep_in.empty()) visit(LimitIs<Limit::keep_in>{}, keep_in);
  if (!keep_out.empty()) visit(LimitIs<Limit::keep_out>{}, keep_out);
  if (!meshes.empty()) visit(LimitIs<Limit::meshes>{}, meshes);
  if (clearance) visit(LimitIs<Limit::clearance>{}, *clearance);
}

template <typename Visit>
void each_limit(const Sensor& sensor, Visit&& visit) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = sensor;
  if (min_range_m > 0) visit(LimitIs<Limit::min_range>{}, min_range_m);
  if (incidence_deg) visit(LimitIs<Limit::incidence>{}, *incidence_deg);
  if (pixel && pixel->kind == PixelLimit::Kind::worst) visit(LimitIs<Limit::pixel>{}, *pixel);
  if (camera) visit(LimitIs<Limit::frame>{}, *camera);
  if (sun) visit(LimitIs<Limit::sun>{}, *sun);
}

}  // namespace vantage
