// KML 2.2 (OGC 07-147r2), and KMZ: a folder for each kind of cause, a placemark of triangles for each cause. Corners
// are longitude, latitude and height above the sea. Nothing is merged: sides are straight between the corners of the
// mesh.
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/output.h"
#include "core/xml_text.h"
#include "geo/local_frame.h"
#include "geo/on_globe.h"
#include "io/antimeridian.h"
#include "io/kind_colours.h"
#include "io/write_zip.h"
#include "io/writers.h"
#include "io/written_marks.h"
#include "vantage/error.h"
#include "vantage/target.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

/// Of degrees: half a step is 0.56 micrometres of latitude. And of metres.
constexpr int kPlaceDecimals = 11, kHeightDecimals = 6;
/// What both, and the conversion (15 nm), move a point at most.
constexpr double kRoundingM = 1e-6;

std::optional<double> known_sea_level(const Georeference& place, std::optional<double> given) {
  return given ? given : geo::sea_level_z_m(place.vertical);
}

/// "7f00a0ff": opacity, blue, green, red.
std::string kml_colour(const KindColour& colour) {
  constexpr const char* kDigits = "0123456789abcdef";
  constexpr double kMost = 255;
  std::string text;
  for (const int part :
       {static_cast<int>(std::lround(colour.opacity * kMost)), colour.blue, colour.green, colour.red}) {
    text += {kDigits[part / 16], kDigits[part % 16]};
  }
  return text;
}

std::string kml_style(const std::string& id, const KindColour& colour) {
  KindColour line = colour;
  line.opacity = 1;
  return "<Style id=\"" + id + "\"><LineStyle><color>" + kml_colour(line) + "</color></LineStyle><PolyStyle><color>" +
         kml_colour(colour) + "</color><outline>0</outline></PolyStyle></Style>\n";
}

class KmlVolume {
 public:
  using Sink = std::function<void(const std::string&)>;

  KmlVolume(const Volume& volume, const StoredMesh& stored, const Georeference& place, double sea_level_z_m)
      : volume_(volume), stored_(stored), place_(place), globe_(place), sea_level_z_m_(sea_level_z_m) {}

  void write(const Sink& sink) const {
    sink(head());
    const std::vector<Corner> corners = corner_texts();
    std::vector<std::vector<std::size_t>> facets_of(volume_.causes.size());
    for (std::size_t t = 0; t < stored_.cause_of.size(); ++t) facets_of[stored_.cause_of[t]].push_back(t);
    for (const CauseKind kind : kKinds) {
      bool is_open = false;
      for (std::size_t cause = 0; cause < facets_of.size(); ++cause) {
        if (volume_.causes[cause].kind != kind || facets_of[cause].empty()) continue;
        if (!is_open) sink(std::string("<Folder><name>") + name_of(kind) + "</name>\n");
        is_open = true;
        write_cause(volume_.causes[cause], facets_of[cause], corners, sink);
      }
      if (is_open) sink("</Folder>\n");
    }
    sink(targets() + "</Document>\n</kml>\n");
  }

 private:
  /// "11.5,48.1,520".
  std::string position(const geo::Geodetic& at) const {
    return core::decimal(at.place.longitude_deg, kPlaceDecimals) + "," +
           core::decimal(at.place.latitude_deg, kPlaceDecimals) + "," +
           core::decimal(at.height_m - sea_level_z_m_, kHeightDecimals);
  }

  struct Corner {
    double longitude_deg;
    std::string text;
  };

  std::vector<Corner> corner_texts() const {
    std::vector<Corner> corners;
    corners.reserve(stored_.mesh.vertices.size());
    for (const Vec3& vertex : stored_.mesh.vertices) {
      const geo::Geodetic at = globe_.to_geodetic(vertex);
      corners.push_back({at.place.longitude_deg, position(at)});
    }
    return corners;
  }

  std::string title() const {
    const std::string name = volume_.provenance ? volume_.provenance->target.name : std::string();
    return (name.empty() ? "" : name + ": ") + "visibility volume";
  }

  std::string about() const {
    const std::string vertical = place_.vertical.empty() ? "a level that is not named" : place_.vertical;
    std::string text = "Positions from which all of the target is visible, in colours of what bounds them. ";
    text += "Longitudes and latitudes: WGS 84. Altitudes: metres above mean sea level, which is z = " +
            shortest(sea_level_z_m_) + " m of the scene; its z is measured from: " + vertical +
            ". KML means EGM96 by it, from which other levels may differ by decimetres. A corner is off by at most " +
            shortest(stored_.rounding_m + volume_.read_rounding_m) + " m.";
    const std::string& credit = place_.attribution.empty() ? volume_.attribution : place_.attribution;
    return credit.empty() ? text : text + " " + credit;
  }

  std::string head() const {
    std::string text = std::string(kKmlStart) + VANTAGE_VERSION + " visibility volume: " + name_of(volume_.outcome) +
                       "\n-->\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>" +
                       core::xml_text(title()) + "</name>\n<open>1</open>\n<description>" + core::xml_text(about()) +
                       "</description>\n";
    for (const CauseKind kind : kKinds) text += kml_style(name_of(kind), colour_of(kind));
    return text + kml_style("target", {213, 94, 0, 0.8});
  }

  void write_cause(const Cause& cause, const std::vector<std::size_t>& facets, const std::vector<Corner>& corners,
                   const Sink& sink) const {
    sink("<Placemark><name>" + core::xml_text(cause.name) + "</name><description>" + core::decimal(cause.area_m2, 3) +
         " m2, " + std::to_string(facets.size()) + (facets.size() == 1 ? " facet" : " facets") +
         "</description><styleUrl>#" + name_of(cause.kind) + "</styleUrl><MultiGeometry>\n");
    for (const std::size_t t : facets) {
      const Triangle& triangle = stored_.mesh.triangles[t];
      const Corner &a = corners[triangle[0]], &b = corners[triangle[1]], &c = corners[triangle[2]];
      const bool crosses = crosses_antimeridian(a.longitude_deg, b.longitude_deg) ||
                           crosses_antimeridian(b.longitude_deg, c.longitude_deg) ||
                           crosses_antimeridian(c.longitude_deg, a.longitude_deg);
      const std::vector<Vec3>& at = stored_.mesh.vertices;
      sink(crosses ? cut_polygon({at[triangle[0]], at[triangle[1]], at[triangle[2]]})
                   : polygon({a.text, b.text, c.text}));
    }
    sink("</MultiGeometry></Placemark>\n");
  }

  static std::string polygon(const std::vector<std::string>& corners) {
    std::string text = "<Polygon><altitudeMode>absolute</altitudeMode><outerBoundaryIs><LinearRing><coordinates>";
    for (const std::string& corner : corners) text.append(corner).append(" ");
    return text.append(corners.front()).append("</coordinates></LinearRing></outerBoundaryIs></Polygon>\n");
  }

  /// A polygon for each side of the antimeridian. Corners where it is cut lie on the sides, to 2^-60 of their length.
  std::string cut_polygon(const std::vector<Vec3>& corners) const {
    std::string text;
    for (const GlobePolygon& part :
         cut_at_antimeridian({corners}, [this](const Vec3& point) { return globe_.to_geodetic(point); })) {
      std::vector<std::string> texts;
      for (const GlobeCorner& corner : part.front()) texts.push_back(position(corner.at));
      text += polygon(texts);
    }
    return text;
  }

  std::string target_text(const Target& target) const {
    std::string geometries;
    for (std::size_t i = 0; i < target.parts.size(); ++i) {
      const Vec3 offset =
          target.offset_m == 0 ? Vec3::Zero() : Vec3(target.offset_m * make_target_frame(target, i).normal);
      std::vector<Vec3> corners;
      for (const Vec3& corner : target.parts[i]) corners.push_back(corner + offset);
      if (corners.size() == 1) {
        geometries += "<Point><altitudeMode>absolute</altitudeMode><coordinates>" +
                      position(globe_.to_geodetic(corners[0])) + "</coordinates></Point>\n";
      } else if (corners.size() > 2) {
        geometries += cut_polygon(corners);
      }
    }
    if (geometries.empty()) return {};
    return "<Placemark><name>" + core::xml_text(target.name) + "</name><styleUrl>#target</styleUrl><MultiGeometry>\n" +
           geometries + "</MultiGeometry></Placemark>\n";
  }

  /// As they were asked for: moved by their offset, not by a lift.
  std::string targets() const {
    if (!volume_.provenance) return {};
    std::string text = target_text(volume_.provenance->target);
    for (const std::vector<Target>& view : volume_.provenance->views) {
      for (const Target& target : view) text += target_text(target);
    }
    return text.empty() ? text : "<Folder><name>target</name>\n" + text + "</Folder>\n";
  }

  const Volume& volume_;
  const StoredMesh& stored_;
  const Georeference& place_;
  geo::OnGlobe globe_;
  double sea_level_z_m_;
};

KmlVolume kml_of(const Volume& volume, const StoredMesh& stored, std::optional<double> sea_level_z_m) {
  const Georeference& place = volume.georeference.value();
  return {volume, stored, place, known_sea_level(place, sea_level_z_m).value()};
}

}  // namespace

void check_kml_place(const std::optional<Georeference>& georeference, std::optional<double> sea_level_z_m) {
  if (!georeference) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, and KML has to", "",
                "give a scene with a place: a map, a mesh with 'crs', or 'origin' under 'scene'; or write " +
                    scene_extensions_text());
  }
  if (known_sea_level(*georeference, sea_level_z_m)) return;
  throw Error(ErrorCode::height_unknown,
              "KML has heights above mean sea level, and those of the scene are above " +
                  (georeference->vertical.empty() ? "an unknown level" : georeference->vertical),
              "", "say which z of the scene the mean sea level has: 'sea_level' under 'scene' in the mission");
}

StoredMesh stored_for_kml(const Volume& volume) {
  StoredMesh stored = stored_as_doubles(volume);
  stored.rounding_m += kRoundingM;
  return stored;
}

void write_kml(const Volume& volume, const StoredMesh& stored, std::optional<double> sea_level_z_m, AtomicFile& file) {
  kml_of(volume, stored, sea_level_z_m).write([&](const std::string& text) { file.write(text); });
}

void write_kmz(const Volume& volume, const StoredMesh& stored, std::optional<double> sea_level_z_m, AtomicFile& file) {
  std::string kml;
  kml_of(volume, stored, sea_level_z_m).write([&](const std::string& text) { kml += text; });
  try {
    file.write(zipped({{"doc.kml", std::move(kml)}}));
  } catch (const std::length_error&) {
    throw Error(ErrorCode::format_too_small, "the volume is too large for KMZ", "at most 4 GB",
                "write another format or compute with a larger tolerance");
  }
}

}  // namespace vantage::internal::io
