// How a place on the earth is written into files of every format, and read again. See docs/scene.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/export.h"
#include "vantage/georeference.h"

namespace vantage::internal::io {

/// What stands before the JSON text in a comment of an OBJ or PLY file.
inline constexpr std::string_view kGeoreferenceMark = "vantage georeference:";

/// {"latitude_deg": …, "longitude_deg": …, "vertical": …, "source_crs": …, "projection": …}; the numbers read back
/// exactly. "projection" is what projection_text says, for other programs; it is not read.
nlohmann::ordered_json georeference_json(const Georeference& georeference);
/// The same as text on one line, in ASCII.
std::string georeference_text(const Georeference& georeference);

/// A line for OBJ or the header of PLY, `start` ("# ", "comment ") before it; nothing without a place.
std::string place_comment(const std::optional<Georeference>& georeference, const char* start);

/// Reads what georeference_json and georeference_text have written; unknown keys are passed over. Throws
/// GeoreferenceProblem.
Georeference parse_georeference(const nlohmann::json& json);
Georeference parse_georeference(std::string_view text);

/// Reads the text of a comment, after its sign of a comment, into `known` if it is ours. Throws GeoreferenceProblem,
/// also for a second one that differs: two meshes were joined that lie elsewhere.
void read_georeference_comment(std::string_view comment, std::optional<Georeference>& known);

/// The value of "georeference" in the object "vantage" of a JSON object, or nullptr: so it stands in glTF's "extras"
/// and in files of their own.
const nlohmann::json* georeference_in(const nlohmann::json& object);

/// What is wrong with a georeference; whoever reads the file adds where it stands.
struct GeoreferenceProblem {
  std::string text;
};

}  // namespace vantage::internal::io
