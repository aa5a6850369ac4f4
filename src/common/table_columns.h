// Tables of positions with a header, as `check` and `query` read them: what the titles of columns mean, and their
// numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/input.h"
#include "vantage/export.h"
#include "vantage/flight.h"

namespace vantage {

enum class TableColumn {
  longitude,
  latitude,
  height,
  x,
  y,
  z,
  hold,
  speed,
  yaw,
  gimbal_yaw,
  gimbal_pitch,
  mode,
  curve
};

/// A column with a known title.
struct KnownColumn {
  std::string_view name;  ///< in lower case, without blanks and underscores, without its unit
  TableColumn column;
  HeightDatum datum = HeightDatum::unknown;  ///< of heights, what the title says
  double factor = 1;                         ///< from the unit of the title to metres, degrees, seconds, m/s
};

/// "Altitude (m)", "altitude_m", "altitude(m)" are "altitude" in metres; "AltitudeAGL" is "altitude_agl". Nothing for
/// another title; `has_unknown_unit` says whether that is a known one with something else behind it.
VANTAGE_API std::optional<KnownColumn> known_column(std::string_view title, bool* has_unknown_unit = nullptr);

/// The numbers of one table. Where semicolons or tabs separate its fields they may have decimal commas: all, or none.
class VANTAGE_API TableNumbers {
 public:
  TableNumbers() = default;
  explicit TableNumbers(char separator) : may_have_commas_(separator == ';' || separator == '\t') {}

  /// As it stands there, without the factor of its column. Longitudes and latitudes may be degrees, minutes and
  /// seconds.
  ParsedNumber parse(std::string_view field, TableColumn column);

 private:
  bool may_have_commas_ = false;
  char mark_ = 0;  ///< '.' or ',' once one of them was there
};

/// What to write instead of a field that TableNumbers refused.
VANTAGE_API std::string table_advice(std::string_view field, TableColumn column, NumberFault fault);

/// Degrees as parse_number reads them, or with their sign, minutes and seconds, and the letter of the hemisphere before
/// or behind: 47\u00b059'60"N is 48. Seconds and minutes may be 60, as programs round them. Never throws.
VANTAGE_API ParsedNumber parse_coordinate(std::string_view text, bool is_latitude);

}  // namespace vantage
