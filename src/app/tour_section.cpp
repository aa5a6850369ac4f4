// docs/mission-file.md describes every key.
#include "app/tour_section.h"

#include <array>
#include <string>

#include "app/places.h"
#include "app/schema.h"
#include "core/format.h"
#include "vantage/error.h"
#include "vantage/input.h"

namespace vantage::internal::app {
namespace {

class TourParser {
 public:
  explicit TourParser(const ValueReader& reader) : reader_(reader) {}

  TourSettings parse(const YamlNode& tour) {
    check_keys(tour, Section::tour, reader_.file());
    take(tour, "vehicle", [&](const YamlNode& node) { parse_vehicle(node); });
    take(tour, "home", [&](const YamlNode& node) { result_.home = home(node); });
    take(tour, "closed", [&](const YamlNode& node) { result_.closed = yes_or_no(node, "tour.closed"); });
    take(tour, "view", [&](const YamlNode& node) { parse_view(node); });
    take(tour, "gimbal", [&](const YamlNode& node) {
      check_keys(node, Section::tour_gimbal, reader_.file());
      take_number(node, "rate", "tour.gimbal.rate", result_.gimbal_rate_deg_s);
    });
    take(tour, "clearance",
         [&](const YamlNode& node) { result_.clearance_m = reader_.length(node, "tour.clearance"); });
    take_number(tour, "gap", "tour.gap", result_.gap);
    take_number(tour, "time_limit", "tour.time_limit", result_.time_limit_s);
    return result_;
  }

 private:
  /// What is out of range is told of the key that brought it.
  template <typename Set>
  void take(const YamlNode& map, const char* key, const Set& set) {
    const YamlNode* node = find(map, key);
    if (node == nullptr) return;
    set(*node);
    with_place(place_in(reader_.file(), node->place), [&] {
      check_tour_settings(result_);
      return 0;
    });
  }

  void take_number(const YamlNode& map, const char* key, const char* what, double& value) {
    take(map, key, [&](const YamlNode& node) { value = reader_.number(node, what); });
  }

  void take_length(const YamlNode& map, const char* key, const std::string& what, double& value) {
    take(map, key, [&](const YamlNode& node) { value = reader_.length(node, what); });
  }

  bool yes_or_no(const YamlNode& node, const std::string& what) const {
    const std::string word = reader_.text(node, what);
    if (word == "true") return true;
    if (word == "false") return false;
    reader_.fail(ErrorCode::unknown_choice, node, what + " must be true or false, not " + in_quotes(word),
                 "write true or false");
  }

  void parse_vehicle(const YamlNode& node) {
    check_keys(node, Section::vehicle, reader_.file());
    TourVehicle& vehicle = result_.vehicle;
    const YamlNode* kind = find(node, "kind");
    if (kind == nullptr) {
      reader_.fail(ErrorCode::missing_key, node, "tour.vehicle lacks the key 'kind'",
                   "write 'kind: multirotor' or 'kind: fixed_wing'");
    }
    const std::string word = reader_.text(*kind, "tour.vehicle.kind");
    if (word != "multirotor" && word != "fixed_wing") {
      reader_.fail(ErrorCode::unknown_choice, *kind, "there is no kind of vehicle " + in_quotes(word),
                   "write 'kind: multirotor' or 'kind: fixed_wing'");
    }
    const bool is_fixed_wing = word == "fixed_wing";
    vehicle.kind = is_fixed_wing ? TourVehicle::Kind::fixed_wing : TourVehicle::Kind::multirotor;
    for (const char* key : is_fixed_wing ? kOfMultirotor : kOfFixedWing) {
      if (const YamlNode* other = key == nullptr ? nullptr : find(node, key)) {
        reader_.fail(ErrorCode::not_applicable, *other,
                     std::string("tour.vehicle.") + key + " is not of a " + name_of(vehicle.kind), "leave it out");
      }
    }
    take_number(node, "speed", "tour.vehicle.speed", vehicle.speed_m_s);
    take_number(node, "acceleration", "tour.vehicle.acceleration", vehicle.acceleration_m_s2);
    take_length(node, "turn_radius", "tour.vehicle.turn_radius", vehicle.turn_radius_m);
    take(node, "climb", [&](const YamlNode& climb) {
      const char* const form = "write the steepest descent and the steepest climb, degrees: [-15, 20]";
      if (reader_.list(climb, "tour.vehicle.climb", form).size() != 2) {
        reader_.fail(ErrorCode::wrong_type, climb, "tour.vehicle.climb must be two numbers, not " + describe(climb),
                     form);
      }
      vehicle.min_climb_deg = reader_.angle(climb.items[0], "tour.vehicle.climb[0]");
      vehicle.max_climb_deg = reader_.angle(climb.items[1], "tour.vehicle.climb[1]");
    });
  }

  TourHome home(const YamlNode& node) const {
    const char* const form = "write [latitude, longitude] in degrees, for a place on the ground, or [x, y, z]";
    if (reader_.list(node, "tour.home", form).size() == 2) {
      return {std::array{reader_.angle(node.items[0], "tour.home[0]"), reader_.angle(node.items[1], "tour.home[1]")},
              {}};
    }
    return {{}, reader_.vector(node, "tour.home", form)};
  }

  void parse_view(const YamlNode& node) {
    check_keys(node, Section::tour_view, reader_.file());
    take_number(node, "dwell", "tour.view.dwell", result_.dwell_s);
    take_length(node, "margin", "tour.view.margin", result_.margin_m);
    take(node, "simultaneous",
         [&](const YamlNode& value) { result_.simultaneous = yes_or_no(value, "tour.view.simultaneous"); });
  }

  static constexpr std::array<const char*, 2> kOfMultirotor = {"acceleration", nullptr};
  static constexpr std::array<const char*, 2> kOfFixedWing = {"turn_radius", "climb"};

  const ValueReader& reader_;
  TourSettings result_;
};

}  // namespace

TourSettings parse_tour(const YamlNode& node, const ValueReader& reader) { return TourParser(reader).parse(node); }

std::string tour_section_text(const TourSettings& tour) {
  const TourVehicle& vehicle = tour.vehicle;
  std::string moves = vehicle.kind == TourVehicle::Kind::multirotor
                          ? core::format("acceleration: {}", shortest(vehicle.acceleration_m_s2))
                          : core::format("turn_radius: {}, climb: [{}, {}]", shortest(vehicle.turn_radius_m),
                                         shortest(vehicle.min_climb_deg), shortest(vehicle.max_climb_deg));
  std::string text = core::format("tour:\n  vehicle: {{kind: {}, speed: {}, {}}}\n", name_of(vehicle.kind),
                                  shortest(vehicle.speed_m_s), moves);
  if (tour.home && tour.home->at_deg) {
    text += core::format("  home: [{}, {}]\n", shortest((*tour.home->at_deg)[0]), shortest((*tour.home->at_deg)[1]));
  } else if (tour.home && tour.home->position) {
    const Vec3& home = *tour.home->position;
    text += core::format("  home: [{}, {}, {}]\n", shortest(home.x()), shortest(home.y()), shortest(home.z()));
  }
  text += core::format("  closed: {}\n  view: {{dwell: {}, margin: {}, simultaneous: {}}}\n", tour.closed,
                       shortest(tour.dwell_s), shortest(tour.margin_m), tour.simultaneous);
  text += core::format("  gimbal: {{rate: {}}}\n  clearance: {}\n  gap: {}\n  time_limit: {}\n",
                       shortest(tour.gimbal_rate_deg_s), shortest(tour.clearance_m), shortest(tour.gap),
                       shortest(tour.time_limit_s));
  return text;
}

}  // namespace vantage::internal::app
