// Small OpenStreetMap files, written by hand in metres.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "geo/local_frame.h"
#include "support/internals.h"

namespace vantage::testing {

/// Objects about an origin, in metres east and north of it. Ids count up from 1 for each type.
class MapText {
 public:
  using Positions = std::vector<std::pair<double, double>>;
  using TagList = std::vector<std::pair<std::string, std::string>>;
  struct Member {
    std::string type;
    long ref;
    std::string role;
  };

  explicit MapText(geo::LonLat origin = {11.5755, 48.1374}) : frame_(origin) {}

  long node(double east, double north, const TagList& tags = {}) {
    const geo::LonLat at = frame_.to_lonlat({east, north});
    char text[128];
    std::snprintf(text, sizeof text, "<node id=\"%ld\" version=\"1\" lat=\"%.9f\" lon=\"%.9f\">", ++nodes_,
                  at.latitude_deg, at.longitude_deg);
    node_text_ += text + tag_text(tags) + "</node>\n";
    return nodes_;
  }

  long way(const std::vector<long>& refs, const TagList& tags) {
    way_text_ += "<way id=\"" + std::to_string(++ways_) + "\" version=\"1\">";
    for (const long ref : refs) way_text_ += "<nd ref=\"" + std::to_string(ref) + "\"/>";
    way_text_ += tag_text(tags) + "</way>\n";
    return ways_;
  }

  /// A closed way.
  long area(const Positions& corners, const TagList& tags) {
    std::vector<long> refs = nodes_at(corners);
    refs.push_back(refs.front());
    return way(refs, tags);
  }
  long line(const Positions& points, const TagList& tags) { return way(nodes_at(points), tags); }

  /// An axis-aligned rectangle.
  long box(double west, double south, double east, double north, const TagList& tags) {
    return area({{west, south}, {east, south}, {east, north}, {west, north}}, tags);
  }

  long relation(const std::vector<Member>& members, const TagList& tags) {
    relation_text_ += "<relation id=\"" + std::to_string(++relations_) + "\" version=\"1\">";
    for (const Member& member : members) {
      relation_text_ += "<member type=\"" + member.type + "\" ref=\"" + std::to_string(member.ref) + "\" role=\"" +
                        member.role + "\"/>";
    }
    relation_text_ += tag_text(tags) + "</relation>\n";
    return relations_;
  }

  std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\">\n" + node_text_ + way_text_ +
           relation_text_ + "</osm>\n";
  }

 private:
  std::vector<long> nodes_at(const Positions& positions) {
    std::vector<long> refs;
    for (const auto& [east, north] : positions) refs.push_back(node(east, north));
    return refs;
  }

  static std::string tag_text(const TagList& tags) {
    std::string text;
    for (const auto& [key, value] : tags) {
      text.append("<tag k=\"").append(key).append("\" v=\"").append(value).append("\"/>");
    }
    return text;
  }

  geo::LocalFrame frame_;
  long nodes_ = 0, ways_ = 0, relations_ = 0;
  std::string node_text_, way_text_, relation_text_;
};

}  // namespace vantage::testing
