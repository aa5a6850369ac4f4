// KML 2.2 (OGC 07-147r2) with Google's tracks: LineString, gx:Track, or else the points of placemarks.
#include "flight/plans/kml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/point_details.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

HeightDatum datum_of_mode(std::string_view mode) {
  if (mode == "absolute") return HeightDatum::sea_level;
  if (mode == "relativeToGround") return HeightDatum::ground;
  return HeightDatum::unknown;  // clamped to the ground, or to the sea's
}

class KmlTracks {
 public:
  KmlTracks(const XmlTree& xml, const PlanSource& source) : xml_(xml), source_(source) {}

  FlightPlan read() {
    FlightPlan plan;
    plan.format = PlanFormat::kml;
    plan.file = source_.name;
    xml_.walk(xml_.root(), [&](XmlTree::Node node) {
      source_.progress.tick();
      if (xml_.name(node) != "Placemark") return add(node, "");  // nothing flown may lie outside of one
      const std::string name = printable(xml_.child_text(node, "name"));
      const std::size_t points = points_.track.items.size(), tracks = tracks_.size();
      xml_.walk(node, [&](XmlTree::Node part) { return add(part, name); });
      join_at_antimeridian(tracks_, tracks);
      for (std::size_t i = points; i < points_.track.items.size(); ++i) add_details(node, i);
      return false;
    });
    if (!left_out_.empty()) {
      plan.notes.push_back({WarningCode::plan_left_out,
                            source_.name + " has more than is flown, by its elements: " + counted(left_out_)});
    }
    take_details(std::move(points_), tracks_, source_, plan);
    take_tracks(std::move(tracks_), "track", "tracks", source_, plan);
    check_plan(plan, source_);
    return plan;
  }

 private:
  /// Whether to go into the element.
  bool add(XmlTree::Node part, const std::string& name, std::string_view outer_mode = {}) {
    const std::string_view kind = xml_.name(part);
    if (kind == "ExtendedData") {
      refuse_positions(part);
      return false;
    }
    constexpr std::array<std::string_view, 6> kNotFlown = {"Polygon", "Model",        "NetworkLink",
                                                           "Tour",    "PhotoOverlay", "GroundOverlay"};
    if (std::find(kNotFlown.begin(), kNotFlown.end(), kind) != kNotFlown.end()) {
      ++left_out_[std::string(kind)];
      return false;
    }
    if (kind == "MultiTrack" && outer_mode.empty()) {  // its tracks may leave the mode to it
      const std::string_view mode = xml_.child_text(part, "altitudeMode");
      if (!mode.empty()) xml_.walk(part, [&](XmlTree::Node inner) { return add(inner, name, mode); });
      return mode.empty();
    }
    const bool is_list = kind == "LineString" || kind == "LinearRing" || kind == "Point";
    if (!is_list && kind != "Track") {
      const std::string_view meant =
          meant_name(kind, {"LineString", "LinearRing", "Track", "MultiTrack", "Point", "Placemark"});
      if (!meant.empty()) fail(part, "KML has no " + in_quotes(kind), "write " + in_quotes(meant));
      refuse_position(part);
      return true;
    }
    for (const char* const only : {"coordinates", "altitudeMode", "altitudeOffset"}) refuse_second(part, only);
    refuse_others(part, is_list ? "coordinates" : "coord");
    PlanTrack track;
    track.name = name;
    track.place = line_of(xml_, part);
    const std::string_view own_mode = xml_.child_text(part, "altitudeMode");
    const HeightDatum datum = datum_of_mode(own_mode.empty() ? outer_mode : own_mode);
    if (kind == "Track") {
      for (XmlTree::Node child = xml_.first_child(part); child != XmlTree::kNone; child = xml_.next(child)) {
        if (xml_.name(child) == "coord") add_position(xml_.text(child), ' ', datum, line_of(xml_, child), track);
      }
    } else {
      add_list(xml_.child_text(part, "coordinates"), datum, track);
    }
    if (track.items.empty()) return false;
    if (const XmlTree::Node offset = xml_.child(part, "altitudeOffset"); offset != XmlTree::kNone) {
      for (PlanItem& item : track.items) item.position.height_m += number_of(xml_, offset, source_);
    }
    if (kind == "Point") {
      if (track.items.size() > 1) fail(part, "a point has several positions", "write a line, or several points");
      points_.track.items.push_back(std::move(track.items.front()));
      points_.numbers.push_back(0);
    } else {
      tracks_.push_back(std::move(track));
    }
    return false;
  }

  [[noreturn]] void fail(XmlTree::Node node, const std::string& problem, const std::string& fix) const {
    source_.fail(ErrorCode::plan_syntax, line_of(xml_, node), problem, fix);
  }

  /// Positions of other elements than lines, tracks and points would not be flown.
  void refuse_position(XmlTree::Node node) const {
    for (const char* name : {"coordinates", "coord", "coordinate", "coords"}) {
      if (!is_alike(xml_.name(node), name)) continue;
      source_.fail(ErrorCode::value_unsupported, line_of(xml_, node),
                   in_quotes(xml_.name(node)) + " is in no line, track or point, and is not read there",
                   "write it in \"LineString\", or take it out");
    }
  }

  void refuse_positions(XmlTree::Node within) const {
    xml_.walk(within, [this](XmlTree::Node node) {
      refuse_position(node);
      return true;
    });
  }

  /// A line, a track or a point has its own elements alone, its positions as `read`, and no text beside them.
  void refuse_others(XmlTree::Node part, std::string_view read) const {
    constexpr std::array<std::string_view, 7> kKnown = {"altitudeMode", "altitudeOffset", "extrude", "tessellate",
                                                        "drawOrder",    "when",           "angles"};
    const std::string within = " in " + in_quotes(xml_.name(part));
    const auto is_attribute = [&](XmlTree::Node node) { return xml_.name(node).starts_with("@"); };
    if (!xml_.text(part).empty()) fail(part, "there is text" + within, "write positions in " + in_quotes(read));
    for (XmlTree::Node child = xml_.first_child(part); child != XmlTree::kNone; child = xml_.next(child)) {
      const std::string_view name = xml_.name(child);
      if (is_attribute(child)) continue;
      if (read == "coord" && (name == "Model" || name == "ExtendedData")) {
        refuse_positions(child);
        continue;
      }
      const bool is_known = name == read || std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
      if (!is_known)
        fail(child, "KML has no " + in_quotes(name) + within, "write " + in_quotes(read) + " for positions");
      xml_.walk(child, [&](XmlTree::Node node) {
        if (!is_attribute(node)) fail(node, "there is an element in " + in_quotes(name), "write numbers alone");
        return false;
      });
    }
  }

  void refuse_second(XmlTree::Node part, const char* name) const {
    XmlTree::Node node = xml_.child(part, name);
    if (node == XmlTree::kNone) return;
    for (node = xml_.next(node); node != XmlTree::kNone; node = xml_.next(node)) {
      if (xml_.name(node) != name) continue;
      source_.fail(ErrorCode::conflicting_keys, line_of(xml_, node), in_quotes(name) + " is given twice",
                   "keep one of them");
    }
  }

  /// Adds what the placemark says: <Data name="..."><value>, or <SimpleData name="...">.
  void add_details(XmlTree::Node placemark, std::size_t point) {
    const XmlTree::Node data = xml_.child(placemark, "ExtendedData");
    if (data == XmlTree::kNone) return;
    xml_.walk(data, [&](XmlTree::Node node) {
      const bool has_value = xml_.child(node, "value") != XmlTree::kNone;
      set_detail(xml_.child_text(node, "@name"), has_value ? xml_.child_text(node, "value") : xml_.text(node),
                 points_.track.items[point], &points_.numbers[point]);
      return true;
    });
  }

  /// "longitude,latitude[,altitude]" with blanks between, and none within.
  void add_list(std::string_view text, HeightDatum datum, PlanTrack& track) {
    constexpr std::string_view kBlanks = " \t\r\n";
    for (;;) {
      const std::size_t begin = text.find_first_not_of(kBlanks);
      if (begin == std::string_view::npos) return;
      text.remove_prefix(begin);
      std::string_view tuple = text.substr(0, text.find_first_of(kBlanks));
      text.remove_prefix(tuple.size());
      if (tuple.front() == ',') tuple.remove_prefix(1);  // some writers separate positions so, too
      if (tuple.empty()) continue;
      source_.progress.tick();
      add_position(tuple, ',', datum, track.place + ", position " + std::to_string(track.items.size() + 1), track);
    }
  }

  void add_position(std::string_view text, char separator, HeightDatum datum, const std::string& within,
                    PlanTrack& track) {
    const std::string where = source_.place(within);
    const std::vector<double> numbers = numbers_of(text, separator, 2, 3, where);
    PlanItem& item = new_item(track, total_, within, source_);
    item.position.horizontal = checked_lonlat(numbers[0], numbers[1], where);
    // A height of 0 that is not to be used is what writers put in for none.
    const bool is_given = numbers.size() > 2 && (datum != HeightDatum::unknown || numbers[2] != 0);
    if (is_given) item.position.height_m = numbers[2];
    item.position.datum = datum;
  }

  const XmlTree& xml_;
  const PlanSource& source_;
  std::vector<PlanTrack> tracks_;
  DetailPoints points_;
  std::map<std::string, std::size_t> left_out_;
  std::size_t total_ = 0;
};

}  // namespace

double number_of(const XmlTree& xml, XmlTree::Node node, const PlanSource& source) {
  const ParsedNumber number = parse_number(xml.text(node));
  if (number.fault == NumberFault::none) return number.value;
  const std::string_view name = xml.name(node);
  source.fail(ErrorCode::not_a_number, line_of(xml, node),
              in_quotes(name.substr(name.front() == '@' ? 1 : 0)) + " is not a number: " + in_quotes(xml.text(node)),
              number_advice(xml.text(node), number.fault));
}

std::vector<double> numbers_of(std::string_view text, char separator, std::size_t least, std::size_t most,
                               const std::string& where) {
  std::vector<double> numbers;
  std::string_view rest = without_blanks(text);
  bool is_good = !rest.empty();
  while (is_good && numbers.size() < most) {
    const std::size_t end = rest.find(separator);
    const ParsedNumber number = parse_number(without_blanks(rest.substr(0, end)));
    is_good = number.fault == NumberFault::none;
    numbers.push_back(number.value);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (end == std::string_view::npos) break;
  }
  if (is_good && rest.empty() && numbers.size() >= least) return numbers;
  PlanSource::fail_at(ErrorCode::plan_syntax, where,
                      "a position is not made of " + std::to_string(least) + " to " + std::to_string(most) +
                          " finite numbers: " + in_quotes(text.substr(0, 60)),
                      "write them in the order of the format, and no blanks within");
}

FlightPlan read_kml(const PlanSource& source) {
  const XmlTree xml(source);
  if (is_wpml(xml)) return read_wpml(xml, source);
  return KmlTracks(xml, source).read();
}

}  // namespace vantage::internal::flight::plans
