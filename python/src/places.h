// Where on the earth a scene or a volume lies, as Python gets it.
#pragma once

#include <optional>
#include <string>
#include <tuple>

#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/scene.h"

namespace vantage::python {

/// Latitude, longitude, what heights are measured from, reference system of the source.
using PlaceRow = std::tuple<double, double, std::string, std::string>;

inline std::optional<PlaceRow> place_row(const std::optional<Georeference>& place) {
  if (!place) return std::nullopt;
  return PlaceRow{place->latitude_deg, place->longitude_deg, place->vertical, place->source_crs};
}

inline Georeference place_of(const PlaceRow& place) {
  return {std::get<0>(place), std::get<1>(place), std::get<2>(place), std::get<3>(place)};
}

/// Throws Error(not_georeferenced).
inline const Georeference& place_of(const Scene& scene) {
  if (scene.georeference) return *scene.georeference;
  throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies", "",
              "use positions in the scene's frame, or give the scene an origin");
}

inline std::optional<std::string> projection_row(const std::optional<Georeference>& place) {
  return place ? std::optional(projection_text(*place)) : std::nullopt;
}

}  // namespace vantage::python
