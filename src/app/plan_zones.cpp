// https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html, "GeoFence". Latitudes come first.
#include <cmath>
#include <string>
#include <utility>

#include "app/json_zones.h"

namespace vantage::internal::app {
namespace {

using nlohmann::json;

class PlanReader {
 public:
  explicit PlanReader(const std::filesystem::path& file) : file_(file) { result_.has_no_heights = true; }

  ZoneList read(const json& fence) {
    if (!fence.is_object()) fail("geoFence", "\"geoFence\" is not an object");
    if (fence.contains("polygon")) {
      fail("geoFence", "the plan is of an old version of QGroundControl",
           "save it anew with QGroundControl 3.3 or later", ErrorCode::value_unsupported);
    }
    read_list(fence, "polygons", "polygon", [this](const json& entry, ListedZone& zone) { polygon(entry, zone); });
    read_list(fence, "circles", "circle", [this](const json& entry, ListedZone& zone) { circle(entry, zone); });
    return std::move(result_);
  }

 private:
  template <typename Read>
  void read_list(const json& fence, const char* key, const char* one, const Read& read) {
    const auto list = fence.find(key);
    if (list == fence.end()) return;
    if (!list->is_array()) fail(std::string("geoFence.") + key, "it is not an array");
    for (std::size_t i = 0; i < list->size(); ++i) {
      ListedZone zone;
      zone.name = std::string(one) + " " + std::to_string(i);
      zone.feature = result_.zones.size();
      zone.names = {zone.name};
      zone.place = std::string("geoFence.") + key + "[" + std::to_string(i) + "]";
      const json& entry = (*list)[i];
      if (!entry.is_object()) fail(zone.place, "the fence is not an object");
      const auto inclusion = entry.find("inclusion");
      if (inclusion == entry.end() || !inclusion->is_boolean()) {
        fail(zone.place, "\"inclusion\" is not true or false");
      }
      zone.is_inclusion = inclusion->get<bool>();
      read(entry, zone);
      result_.zones.push_back(std::move(zone));
    }
  }

  void polygon(const json& entry, ListedZone& zone) const {
    const auto positions = entry.find("polygon");
    if (positions == entry.end() || !positions->is_array())
      fail(zone.place, "\"polygon\" is not an array of positions");
    Zone::Ring ring;
    for (const json& numbers : *positions) {
      const Eigen::Vector2d p = position(numbers, zone.place);
      if (ring.empty() || ring.back() != p) ring.push_back(p);
    }
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    zone.outer = std::move(ring);
  }

  void circle(const json& entry, ListedZone& zone) const {
    const auto circle = entry.find("circle");
    if (circle == entry.end() || !circle->is_object() || !circle->contains("center") || !circle->contains("radius")) {
      fail(zone.place, "\"circle\" has no \"center\" and \"radius\"");
    }
    const double radius = number((*circle)["radius"], zone.place);
    if (!(radius > 0)) fail(zone.place, "the radius is not above 0", "correct it", ErrorCode::value_out_of_range);
    zone.circle = ListedCircle{position((*circle)["center"], zone.place), radius, radius};
  }

  Eigen::Vector2d position(const json& numbers, const std::string& place) const {
    if (!numbers.is_array() || numbers.size() < 2) fail(place, "a position is not an array of two numbers");
    return checked_position(number(numbers[1], place), number(numbers[0], place), file_, place);
  }

  double number(const json& value, const std::string& place) const {
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (!std::isfinite(number)) fail(place, "a value is not a number");
    return number;
  }

  [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& fix = "correct it",
                         ErrorCode code = ErrorCode::zone_file_syntax) const {
    fail_in_zones(code, file_, place, problem, fix);
  }

  const std::filesystem::path& file_;
  ZoneList result_;
};

}  // namespace

ZoneList plan_zones(const json& root, const std::filesystem::path& file) {
  return PlanReader(file).read(root["geoFence"]);
}

}  // namespace vantage::internal::app
