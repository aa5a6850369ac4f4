// GPX 1.1, https://www.topografix.com/GPX/1/1/: tracks, or else routes, or else waypoints.
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/kml.h"
#include "flight/plans/point_details.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

class GpxTracks {
 public:
  GpxTracks(const XmlTree& xml, const PlanSource& source) : xml_(xml), source_(source) {}

  FlightPlan read() {
    FlightPlan plan;
    plan.format = PlanFormat::gpx;
    plan.file = source_.name;
    PlanTrack waypoints;
    std::vector<PlanTrack> tracks, routes;
    for (XmlTree::Node node = xml_.first_child(xml_.root()); node != XmlTree::kNone; node = xml_.next(node)) {
      const std::string_view kind = xml_.name(node);
      if (kind == "trk") {
        add_line(node, "trkpt", tracks);
      } else if (kind == "rte") {
        add_line(node, "rtept", routes);
      } else if (kind == "wpt") {
        add_point(node, waypoints);
      } else {
        refuse_positions(node);
      }
    }
    std::map<std::string, std::size_t> left_out;
    if (!tracks.empty()) {
      if (!routes.empty()) left_out[routes.size() == 1 ? "route" : "routes"] = routes.size();
      take_tracks(std::move(tracks), "track", "tracks", source_, plan);
    } else if (!routes.empty()) {
      take_tracks(std::move(routes), "route", "routes", source_, plan);
    } else {
      plan.items = std::move(waypoints.items);
    }
    if (!plan.items.empty() && !waypoints.items.empty())
      left_out[waypoints.items.size() == 1 ? "waypoint" : "waypoints"] = waypoints.items.size();
    if (!left_out.empty()) {
      plan.notes.push_back(
          {WarningCode::plan_left_out, source_.name + " has more than is flown: " + counted(left_out)});
    }
    check_plan(plan, source_);
    return plan;
  }

 private:
  void add_line(XmlTree::Node line, std::string_view point, std::vector<PlanTrack>& lines) {
    PlanTrack track;
    track.name = printable(xml_.child_text(line, "name"));
    track.place = line_of(xml_, line);
    std::size_t segments = 0;
    xml_.walk(line, [&](XmlTree::Node node) {
      const bool is_segment = xml_.name(node) == "trkseg" && point == "trkpt";
      segments += is_segment && xml_.child(node, point) != XmlTree::kNone ? 1 : 0;
      if (xml_.name(node) == point) {
        add_point(node, track);
      } else if (!is_segment) {
        refuse_positions(node);
      }
      return is_segment;
    });
    if (track.items.empty()) return;
    if (segments > 1) track.segments = segments;
    lines.push_back(std::move(track));
  }

  void add_point(XmlTree::Node point, PlanTrack& track) {
    source_.progress.tick();
    PlanItem& item = new_item(track, total_, line_of(xml_, point), source_);
    const XmlTree::Node latitude = xml_.child(point, "@lat"), longitude = xml_.child(point, "@lon");
    if (latitude == XmlTree::kNone || longitude == XmlTree::kNone) {
      PlanSource::fail_at(ErrorCode::plan_syntax, item.place, "the point has no \"lat\" and \"lon\"", "give both");
    }
    item.position.horizontal =
        checked_lonlat(number_of(xml_, longitude, source_), number_of(xml_, latitude, source_), item.place);
    // "Elevation of the point"; where <geoidheight> is beside it, that of NMEA is meant, above mean sea level.
    item.position.datum = HeightDatum::sea_level;
    for (XmlTree::Node node = xml_.first_child(point); node != XmlTree::kNone; node = xml_.next(node)) {
      const std::string_view name = xml_.name(node);
      if (node == latitude || node == longitude) continue;
      refuse_positions(node);
      if (name == "ele" && !std::isnan(item.position.height_m)) {
        source_.fail(ErrorCode::conflicting_keys, line_of(xml_, node), "\"ele\" is given twice", "keep one of them");
      }
      if (name == "ele") item.position.height_m = number_of(xml_, node, source_);
      if (name != "extensions") continue;
      for (XmlTree::Node more = xml_.first_child(node); more != XmlTree::kNone; more = xml_.next(more)) {
        set_detail(xml_.name(more), xml_.text(more), item);
      }
    }
  }

  /// What is not read at its place may hold no position, not even an extension, and be no misspelt name of what is
  /// read.
  void refuse_positions(XmlTree::Node unread) const {
    const std::string_view kind = xml_.name(unread);
    const std::string_view meant =
        meant_name(kind, {"trk", "trkseg", "trkpt", "rte", "rtept", "wpt", "ele", "extensions", "@lat", "@lon"});
    if (!meant.empty()) {
      source_.fail(ErrorCode::plan_syntax, line_of(xml_, unread), "GPX has no " + in_quotes(kind),
                   "write " + in_quotes(meant));
    }
    const auto check = [&](XmlTree::Node node) {
      std::string_view name = xml_.name(node);
      if (kind == "extensions" && !name.starts_with("@")) return true;  // data of the point, as QGIS writes it
      name.remove_prefix(name.find_last_of("@:") + 1);
      if (is_alike(name, "lat") || is_alike(name, "lon") || is_alike(name, "latitude") || is_alike(name, "longitude")) {
        source_.fail(ErrorCode::value_unsupported, line_of(xml_, node),
                     in_quotes(kind) + " holds a position, and is not read there",
                     "write it as a point of a track or a route, or take it out");
      }
      return true;
    };
    check(unread);
    xml_.walk(unread, check);
  }

  const XmlTree& xml_;
  const PlanSource& source_;
  std::size_t total_ = 0;
};

}  // namespace

FlightPlan read_gpx(const PlanSource& source) {
  const XmlTree xml(source);
  return GpxTracks(xml, source).read();
}

}  // namespace vantage::internal::flight::plans
