// Texts of files of zones: GeoJSON, ED-269, KML and plans of QGroundControl.
#pragma once

#include <string>

namespace vantage::testing::zone_texts {

inline const std::string kSquare = "[[[11, 48], [11.001, 48], [11.001, 48.001], [11, 48.001], [11, 48]]]";

inline std::string feature(const std::string& geometry, const std::string& properties = "{}") {
  return "{\"type\": \"Feature\", \"properties\": " + properties + ", \"geometry\": " + geometry + "}";
}
inline std::string polygon(const std::string& more = "") {
  return "{\"type\": \"Polygon\", \"coordinates\": " + kSquare + more + "}";
}
inline std::string collection(const std::string& features) {
  return "{\"type\": \"FeatureCollection\", \"features\": [" + features + "]}";
}
/// A feature of ED-269 with one volume.
inline std::string volume(const std::string& projection, const std::string& heights) {
  return "{\"features\": [{\"identifier\": \"Z1\", \"geometry\": [{" + heights +
         ", \"horizontalProjection\": " + projection + "}]}]}";
}
inline const std::string kMetres =
    "\"uomDimensions\": \"M\", \"lowerLimit\": 10, \"lowerVerticalReference\": \"AMSL\", \"upperLimit\": 120, "
    "\"upperVerticalReference\": \"AGL\"";
inline std::string plan(const std::string& polygons, const std::string& circles = "") {
  return "{\"fileType\": \"Plan\", \"geoFence\": {\"version\": 2, \"polygons\": [" + polygons + "], \"circles\": [" +
         circles + "]}}";
}
inline std::string kml(const std::string& body) {
  return "<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>" + body +
         "</Document></kml>";
}
inline std::string placemark(const std::string& more, const std::string& altitude = "") {
  return "<Placemark><name>park</name><Polygon>" + more + "<outerBoundaryIs><LinearRing><coordinates>11,48" + altitude +
         " 11.001,48" + altitude + "\n11.001,48.001" + altitude + " 11,48" + altitude +
         "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>";
}

}  // namespace vantage::testing::zone_texts
