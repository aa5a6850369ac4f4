// Where on the earth a scene or a volume lies, as Python gets it.
#pragma once

#include <optional>
#include <string>
#include <tuple>

#include "vantage/georeference.h"

namespace vantage::python {

/// Latitude, longitude, what heights are measured from, reference system of the source.
using PlaceRow = std::tuple<double, double, std::string, std::string>;

inline std::optional<PlaceRow> place_row(const std::optional<Georeference>& place) {
  if (!place) return std::nullopt;
  return PlaceRow{place->latitude_deg, place->longitude_deg, place->vertical, place->source_crs};
}

inline std::optional<std::string> projection_row(const std::optional<Georeference>& place) {
  return place ? std::optional(projection_text(*place)) : std::nullopt;
}

}  // namespace vantage::python
