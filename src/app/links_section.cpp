// docs/mission-file.md describes every key.
#include "app/links_section.h"

#include <algorithm>
#include <array>

#include "app/described_section.h"
#include "app/schema.h"
#include "app/tour_home.h"
#include "common/input.h"
#include "common/json.h"
#include "core/places.h"
#include "request/describe_sensor.h"
#include "vantage/error.h"
#include "vantage/sensor.h"

namespace vantage::internal::app {
namespace {

constexpr const char* kPlaceForm = "write 'point: [x, y, z]', or 'at: [latitude, longitude]' for a place on the ground";

void parse_place(const YamlNode& node, const std::string& what, const ValueReader& reader, MissionLink& link) {
  const YamlNode *point = find(node, "point"), *at = find(node, "at"), *height = find(node, "height");
  if (point && at) {
    reader.fail(ErrorCode::conflicting_keys, *at, what + " has both 'point' and 'at'", "keep one of them");
  }
  if (!point && !at) reader.fail(ErrorCode::missing_key, node, what + " does not say where it is", kPlaceForm);
  if (point) {
    link.position = reader.vector(*point, what + ".point");
    if (height) {
      reader.fail(ErrorCode::not_applicable, *height, what + ".height is above the ground, and a point has its z",
                  "raise the point itself, or give 'at: [latitude, longitude]'");
    }
    return;
  }
  const char* const form = "write [latitude, longitude] in degrees: [48.137, 11.575]";
  if (reader.list(*at, what + ".at", form).size() != 2) {
    reader.fail(ErrorCode::wrong_type, *at, what + ".at must be two numbers, not " + describe(*at), form);
  }
  link.at_deg = {reader.angle(at->items[0], what + ".at[0]"), reader.angle(at->items[1], what + ".at[1]")};
  if (height) {
    link.height_m = reader.length(*height, what + ".height");
    if (link.height_m < 0) {
      reader.fail(ErrorCode::value_out_of_range, *height, what + ".height is below the ground",
                  "write metres above it");
    }
  }
}

void parse_reach(const YamlNode& node, const std::string& what, const ValueReader& reader, MissionLink& link) {
  const YamlNode *range = find(node, "max_range"), *vlos = find(node, "vlos"), *clear = find(node, "clear");
  if (range && vlos) {
    reader.fail(ErrorCode::conflicting_keys, *vlos, what + " has both 'max_range' and 'vlos'",
                "keep the range, or let it follow from the aircraft");
  }
  if (range) link.max_range_m = reader.positive_length(*range, what + ".max_range");
  if (vlos) {
    read_section(*vlos, reader, link.vlos.emplace(), what + ".vlos");
    link.max_range_m = visual_range_m(link.vlos->range);
  }
  if (find(node, "frequency") || clear) read_keys(node, what, reader, link.radio.emplace());
}

MissionLink parse_link(const YamlNode& node, std::size_t index, const ValueReader& reader) {
  check_keys(node, "an entry of links", reader.file());
  const std::string what = "links[" + std::to_string(index) + "]";
  MissionLink link;
  link.place = place_in(reader.file(), node.place);
  const YamlNode* const name = find(node, "name");
  link.name = name ? reader.text(*name, what + ".name") : "link " + std::to_string(index + 1);
  parse_place(node, what, reader, link);
  parse_reach(node, what, reader, link);
  return link;
}

}  // namespace

std::vector<MissionLink> parse_links(const YamlNode& node, const ValueReader& reader) {
  const char* const form = "write a list: [{name: pilot, point: [x, y, z]}]";
  std::vector<MissionLink> links;
  for (const YamlNode& item : reader.list(node, "links", form)) {
    MissionLink link = parse_link(item, links.size(), reader);
    const auto is_same = [&](const MissionLink& other) { return other.name == link.name; };
    if (std::any_of(links.begin(), links.end(), is_same)) {
      reader.fail(ErrorCode::conflicting_keys, item, "two links are called " + in_quotes(link.name),
                  "give each its own name");
    }
    links.push_back(std::move(link));
  }
  if (links.empty()) reader.fail(ErrorCode::nothing_given, node, "links is an empty list", form);
  return links;
}

std::string links_section_text(const std::vector<MissionLink>& links) {
  std::string text;
  for (const MissionLink& link : links) {
    text +=
        (text.empty() ? "links:\n" : "") + std::string("  - name: ") + json_text(std::string_view{link.name}) + "\n";
    if (link.position) {
      const Vec3& at = *link.position;
      text += "    point: [" + shortest(at.x()) + ", " + shortest(at.y()) + ", " + shortest(at.z()) + "]\n";
    } else if (link.at_deg) {
      text += "    at: [" + shortest((*link.at_deg)[0]) + ", " + shortest((*link.at_deg)[1]) + "]\n";
      if (link.height_m > 0) text += "    height: " + shortest(link.height_m) + "\n";
    }
    if (link.vlos) {
      text += "    vlos: " + flow_text(*link.vlos) + "\n";
    } else if (link.max_range_m) {
      text += "    max_range: " + shortest(*link.max_range_m) + "\n";
    }
    if (link.radio) {
      text += "    frequency: " + shortest(link.radio->frequency_ghz) + "\n    clear: " + shortest(link.radio->clear) +
              "\n";
    }
  }
  return text;
}

void place_links(Mission& mission) {
  for (const MissionLink& given : mission.as_written.links) {
    FlightLink link{given.name, Vec3::Zero(), given.max_range_m, given.radio};
    const PlaceOfFlight place{"the link '" + given.name + "'", "'point: [x, y, z]'", given.place};
    link.point = core::with_place(given.place, [&] {
      const double above_m = given.height_m + (given.vlos ? given.vlos->eye_height_m : 0);
      if (given.at_deg) return on_the_ground(mission, *given.at_deg, place, above_m);
      Vec3 point = in_the_frame(mission, given.position.value_or(Vec3::Zero()), place);
      point.z() += above_m;
      return point;
    });
    mission.links.push_back(std::move(link));
  }
}

}  // namespace vantage::internal::app
