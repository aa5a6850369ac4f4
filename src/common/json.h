// What vantage finds out, as JSON texts: UTF-8, indented, a newline at the end. Lengths are metres in the scene frame.
// Names are bytes from files, and JSON takes UTF-8 only: bytes that are not are replaced.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/objects.h"
#include "vantage/camera.h"
#include "vantage/city.h"
#include "vantage/devices.h"
#include "vantage/export.h"
#include "vantage/prove.h"
#include "vantage/scene_source.h"
#include "vantage/simplify.h"
#include "vantage/solid.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {

/// A text as a JSON value, and a list of them; on one line.
VANTAGE_API std::string json_text(std::string_view text);
VANTAGE_API std::string json_text(const std::vector<std::string>& texts);

/// A scene as it was read or built: of a map with a record for each object.
VANTAGE_API std::string json_text(const LoadedScene& loaded);
/// How many objects of each kind are built.
VANTAGE_API std::map<std::string, std::size_t> kinds_of(const CityReport& report);
/// The entries as a list.
VANTAGE_API std::string json_text(const std::vector<LedgerEntry>& ledger);

/// The same with what preparing it found.
VANTAGE_API std::string json_text(const LoadedScene& loaded, const SceneStatistics& statistics);

/// `proof`: what came before the rays; null: there is none. Right is what neither of the two refutes.
VANTAGE_API std::string json_text(const VerifyReport& report, const ProofReport* proof = nullptr);

/// `certificate`: the file that was written; empty: none was.
VANTAGE_API std::string json_text(const ProofReport& report, const std::string& certificate = {});

/// `written`: files that hold what one of the two claims alone.
VANTAGE_API std::string json_text(const Comparison& comparison, const std::string& file_a, const std::string& file_b,
                                  const std::vector<std::string>& written);

/// `volume` and `output`: the files; `written`: what the second holds.
VANTAGE_API std::string json_text(const SimplifiedVolume& simplified, const std::string& volume,
                                  const std::string& output, const WrittenVolume& written);

/// `reason`: why `chosen` was.
VANTAGE_API std::string json_text(const RenderDevices& found, const ChosenDevice& chosen, const std::string& reason);

/// Each camera with its field of view and its focal length in pixels. What is not known is null, and so is `problem`
/// of a camera that can be used.
VANTAGE_API std::string json_text(const std::vector<ListedCamera>& cameras);

/// GeoJSON (RFC 7946): a feature for each area, with the properties "osm", "name", "area_m2", "center" (latitude,
/// longitude) and "tags".
VANTAGE_API std::string json_text(const std::vector<MapArea>& areas);

/// {"objects": [...]}, with name, source_id, kind, triangles, min_z_m, max_z_m, height_m, footprint_m2 (null where it
/// is not known) and mission of each.
VANTAGE_API std::string json_text(const std::vector<ListedObject>& objects);

}  // namespace vantage
