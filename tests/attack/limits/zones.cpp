// Limit::keep_in and Limit::keep_out.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limit_attack.h"
#include "over_ground.h"

namespace attack {

using vantage::Box;
using vantage::Vec3;
using vantage::Zone;
using Zones = std::vector<Zone>;

// ---- draws ----

namespace {

Box box_in_case(Random& random, const Pose& pose, double reach) {
  const Vec3 middle = pose(random.point(-1, 1) * (0.5 * reach / pose.scale));
  const Vec3 half = random.point(0.1, 0.8) * reach;
  Box box;
  box.extend(Vec3(middle - half));
  box.extend(Vec3(middle + half));
  return box;
}

/// Round a middle in equal steps, with corners near and far: not convex, as a rule.
Zone zone_in_case(Random& random, const Pose& pose, double reach) {
  const Box box = box_in_case(random, pose, reach);
  const Vec3 middle = (box.min + box.max) / 2, half = (box.max - box.min) / 2;
  const int count = 3 + static_cast<int>(random.uniform(0, 6));
  const double begin = random.uniform(0, 2 * std::numbers::pi);
  Zone zone;
  for (int i = 0; i < count; ++i) {
    const double angle = begin + 2 * std::numbers::pi * i / count;
    const double share = random.uniform(0.3, 1.5);
    zone.outer.emplace_back(middle.x() + share * half.x() * std::cos(angle),
                            middle.y() + share * half.y() * std::sin(angle));
  }
  zone.min_z_m = box.min.z();
  zone.max_z_m = box.max.z();
  zone.name = "drawn";
  return zone;
}

Zone::Ring ring_about(Random& random, const Vec3& middle, double size, double least) {
  Zone::Ring ring;
  const int count = random.integer(3, 6);
  const double begin = random.uniform(0, 2 * std::numbers::pi);
  for (int i = 0; i < count; ++i) {
    const double turn = begin + 2 * std::numbers::pi * i / count, radius = size * random.uniform(least, 1);
    ring.emplace_back(middle.x() + radius * std::cos(turn), middle.y() + radius * std::sin(turn));
  }
  return ring;
}

Zone zone_about(Random& random, const MeshCase& c, const Vec3& middle, double size) {
  Zone zone;
  zone.name = "drawn";
  zone.outer = ring_about(random, middle, size, random.pick({0.5, 0.5, 0.02}));  // or with narrow places
  if (random.chance(0.25)) zone.holes.push_back(ring_about(random, middle, 0.2 * size, 0.5));
  if (random.chance(0.7)) {
    zone.min_z_m = middle.z() - random.uniform(0.2, 1) * size;
    zone.max_z_m = middle.z() + random.uniform(0.2, 1) * size;
  }
  if (random.chance(0.25)) {
    zone.above_ground = vantage::AboveGround{random.uniform(-2, 6), random.uniform(10, 40), vantage::Ground{}};
    if (c.ground) zone.above_ground->ground = vantage::ground_of(c.scene, *c.ground);
  }
  return zone;
}

void claim_one_box(Random& random, MeshCase& c) {
  c.navigation.keep_in = {box_about(random, draw_place(c, random), 4, 25)};
}

void claim_boxes(Random& random, MeshCase& c) {
  for (int count = random.integer(2, 4); count > 0; --count) {
    const Vec3 middle = c.navigation.keep_in.empty() || random.chance(0.3)
                            ? draw_place(c, random)
                            : Vec3((c.navigation.keep_in.back().box().min + c.navigation.keep_in.back().box().max) / 2 +
                                   random.point(-9, 9));
    c.navigation.keep_in.push_back(box_about(random, middle, 3, 15));
  }
  if (random.chance(0.5)) c.navigation.keep_in.push_back(zone_about(random, c, draw_place(c, random), 15));
}

void claim_out_boxes(Random& random, MeshCase& c) {
  for (int count = random.integer(1, 2); count > 0; --count) {
    c.navigation.keep_out.push_back(box_about(random, draw_place(c, random), 0.5, 8));
  }
}

void claim_zone(Random& random, MeshCase& c) {
  c.navigation.keep_in = {zone_about(random, c, draw_place(c, random), random.uniform(8, 40))};
}

void claim_out_zones(Random& random, MeshCase& c) {
  for (int count = random.integer(1, 2); count > 0; --count) {
    c.navigation.keep_out.push_back(zone_about(random, c, draw_place(c, random), random.uniform(2, 15)));
    c.navigation.keep_out.back().name += std::to_string(count);
  }
}

std::string zone_in_mission(const MissionDraws& draws) {
  Random& random_ = draws.random;
  const Vec3 middle = random_.point(-0.5, 0.5) * draws.range, half = random_.point(0.15, 0.9) * draws.range;
  const Vec3 low = draws.placed(middle - half), high = draws.placed(middle + half);
  if (random_.chance(0.5)) return "{min: " + exact_text(low) + ", max: " + exact_text(high) + "}";
  const int count = random_.integer(3, 8);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, share = random_.uniform(0.4, 1.4);
    const Vec3 at = draws.placed(middle + share * Vec3(half.x() * std::cos(angle), half.y() * std::sin(angle), 0));
    text += (text.empty() ? "{polygon: [" : ", ") + exact_pair(at.x(), at.y());
  }
  if (draws.has_ground && random_.chance(0.3)) {
    return text + "], agl: " + exact_pair(draws.scale * random_.uniform(0, 5), draws.scale * random_.uniform(6, 30)) +
           "}";
  }
  return text + "], z: " + exact_pair(low.z(), high.z()) + "}";
}

}  // namespace

template <>
LimitFacts facts_of<Limit::keep_in>() {
  return {"keep_in",
          {"keep_in"},
          {"keep_in:"},
          true,
          {{1, "keep_in", claim_one_box}, {2, "several boxes", claim_boxes}, {4, "zone", claim_zone}}};
}

template <>
LimitFacts facts_of<Limit::keep_out>() {
  return {"keep_out",
          {"keep_out"},
          {"keep_out:"},
          true,
          {{3, "keep_out", claim_out_boxes}, {5, "keep_out zones", claim_out_zones}}};
}

template <>
void draw_in_case<Limit::keep_in>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  if (random.chance(0.4)) {
    c.navigation.keep_in = {box_in_case(random, pose, c.range), box_in_case(random, pose, c.range)};
  }
}

/// And zones of both lists, after the boxes.
template <>
void draw_in_case<Limit::keep_out>(CaseDraws& draws) {
  auto& [random, pose, c] = draws;
  if (random.chance(0.4)) c.navigation.keep_out = {box_in_case(random, pose, 0.5 * c.range)};
  if (random.chance(0.3)) c.navigation.keep_in.push_back(zone_in_case(random, pose, c.range));
  if (random.chance(0.3)) c.navigation.keep_out.push_back(zone_in_case(random, pose, 0.5 * c.range));
}

template <>
void draw_in_flight<Limit::keep_in>(FlightDraws& /*draws*/) {}

template <>
void draw_in_flight<Limit::keep_out>(FlightDraws& /*draws*/) {}

template <>
void draw_in_mission<Limit::keep_in>(MissionDraws& draws) {
  const auto zone = [&] { return zone_in_mission(draws); };
  if (draws.random.chance(0.15))
    draws.add_navigation("keep_in: [" + zone() + (draws.random.chance(0.5) ? ", " + zone() : "") + "]");
}

template <>
void draw_in_mission<Limit::keep_out>(MissionDraws& draws) {
  const auto zone = [&] { return zone_in_mission(draws); };
  if (draws.random.chance(0.2))
    draws.add_navigation("keep_out: [" + zone() + (draws.random.chance(0.3) ? ", " + zone() : "") + "]");
}

template <>
void draw_in_tour<Limit::keep_in>(TourDraws& draws) {
  Random& random = draws.random;
  if (!random.chance(0.3)) return;
  const double far = draws.size * random.uniform(1, 1.6);
  draws.navigation.keep_in.push_back(Box{Vec3(-far, -far, -1), Vec3(far, far, random.uniform(40, 120))});
}

template <>
void draw_in_tour<Limit::keep_out>(TourDraws& draws) {
  Random& random = draws.random;
  for (int i = random.integer(0, 2); i > 0; --i) {
    Zone zone;
    const Vec3 middle = random.point(-draws.size, draws.size);
    const double radius = random.uniform(4, 0.35 * draws.size);
    const int corners = random.integer(3, 6);
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners, reach = radius * random.uniform(0.6, 1);
      zone.outer.emplace_back(middle.x() + reach * std::cos(angle), middle.y() + reach * std::sin(angle));
    }
    if (random.chance(0.5)) zone.max_z_m = random.uniform(15, 60);
    zone.name = "zone " + std::to_string(i);
    draws.navigation.keep_out.push_back(zone);
  }
}

// ---- places ----

namespace {

void add_zone_anchors(const Zones& zones, const Vec3& middle, std::vector<Vec3>& anchors) {
  for (const Zone& zone : zones) {
    if (zone.is_box) {
      const Box box = zone.box();
      for (int k = 0; k < 8; ++k) {
        anchors.emplace_back((k & 1 ? box.max : box.min).x(), (k & 2 ? box.max : box.min).y(),
                             (k & 4 ? box.max : box.min).z());
      }
      continue;
    }
    for (const Plan& p : zone.outer) {
      for (const double z : {zone.min_z_m, zone.max_z_m})
        anchors.emplace_back(p.x(), p.y(), std::isfinite(z) ? z : middle.z());
    }
  }
}

void add_zone_places(const Zones& zones, MeshPlaces& places) {
  for (const Zone& zone : zones) {
    if (zone.is_box) {
      const Box box = zone.box();
      places.about((box.min + box.max) / 2, (box.max - box.min).norm());
      continue;
    }
    Plan middle = Plan::Zero();
    for (const Plan& corner : zone.outer) middle += corner / static_cast<double>(zone.outer.size());
    const double z = std::isfinite(zone.min_z_m) ? (zone.min_z_m + zone.max_z_m) / 2 : places.centre.z();
    places.about({middle.x(), middle.y(), z}, 10 * places.c.unit);
  }
}

}  // namespace

template <>
void add_anchors<Limit::keep_in>(const Zones& limit, const Vec3& middle, std::vector<Vec3>& anchors) {
  add_zone_anchors(limit, middle, anchors);
}

template <>
void add_anchors<Limit::keep_out>(const Zones& limit, const Vec3& middle, std::vector<Vec3>& anchors) {
  add_zone_anchors(limit, middle, anchors);
}

template <>
void add_places<Limit::keep_in>(const Zones& limit, MeshPlaces& places) {
  add_zone_places(limit, places);
}

template <>
void add_places<Limit::keep_out>(const Zones& limit, MeshPlaces& places) {
  add_zone_places(limit, places);
}

// ---- the oracle ----

namespace {

/// Above 0 inside of the box: how far from its border.
double margin_in_box(const Box& box, const Vec3& p) {
  const Vec3 inside = (p - box.min).cwiseMin(box.max - p);
  const double least = inside.minCoeff();
  return least >= 0 ? least : -inside.cwiseMin(0).norm();
}

/// Above 0 inside of the polygon with its holes: the distance from the nearest side.
double room_in_plan(const Zone& zone, const Plan& p) {
  double nearest = kNoLimit;
  bool is_inside = false;
  const auto add = [&](const Zone::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Plan a = ring[i] - p, b = ring[(i + 1) % ring.size()] - p;
      nearest = std::min(nearest, distance_to_side(Plan::Zero(), a, b));
      if ((a.y() > 0) == (b.y() > 0)) continue;
      const double cross = a.x() * b.y() - a.y() * b.x();
      if ((cross > 0) == (b.y() > a.y())) is_inside = !is_inside;
    }
  };
  add(zone.outer);
  for (const Zone::Ring& hole : zone.holes) add(hole);
  return is_inside ? nearest : -nearest;
}

/// Above 0 inside of what the zone holds. `to_leave`: over ground in pieces a zone to leave reaches from above the
/// lowest to above the highest one, and a place without ground is in it.
Margin margin_in_zone(const Zone& zone, const Vec3& p, bool to_leave) {
  if (zone.is_box) {
    const double margin = margin_in_box(zone.box(), p);
    return {"", margin, margin};
  }
  const double in_heights = std::min(p.z() - zone.min_z_m, zone.max_z_m - p.z());
  const auto joined = [](double plan, double heights) {
    if (plan >= 0 || heights >= 0) return std::min(plan, heights);
    return -std::hypot(plan, heights);
  };
  const double plain = joined(room_in_plan(zone, p.head<2>()), in_heights);
  if (!zone.above_ground) return {"", plain, plain};
  const auto& [low, high, ground] = *zone.above_ground;
  return between("", near_places(ground, p), [&, low = low, high = high, &over = ground](const Plan& place) {
    const Pieces pieces = pieces_at(over, place);
    if (!pieces.is_there()) return to_leave ? plain : std::min(plain, -pieces.beside);
    const double from = to_leave ? pieces.lowest : pieces.highest, to = to_leave ? pieces.highest : pieces.lowest;
    return std::min({plain, p.z() - from - low, to + high - p.z()});
  });
}

}  // namespace

template <>
AddMargins margins_of<Limit::keep_in>(const Zones& limit, const SeenBy& /*by*/) {
  return [&limit](const Vec3& p, std::vector<Margin>& margins) {
    Margin best{"keep_in", -kNoLimit, -kNoLimit};
    for (const Zone& zone : limit) {
      const Margin margin = margin_in_zone(zone, p, false);
      best.low = std::max(best.low, margin.low);
      best.high = std::max(best.high, margin.high);
      best.is_measured = best.is_measured && margin.is_measured;
    }
    add_margin(margins, best);
  };
}

template <>
AddMargins margins_of<Limit::keep_out>(const Zones& limit, const SeenBy& /*by*/) {
  return [&limit](const Vec3& p, std::vector<Margin>& margins) {
    for (std::size_t i = 0; i < limit.size(); ++i) {
      const Margin margin = margin_in_zone(limit[i], p, true);
      add_margin(margins, {"keep_out " + vantage::zone_name(limit, i), -margin.high, -margin.low, margin.is_measured});
    }
  };
}

template <>
bool is_exact<Limit::keep_in>(const Zones& limit) {
  return limit.size() == 1 && limit[0].is_box;
}

template <>
bool is_exact<Limit::keep_out>(const Zones& /*limit*/) {
  return false;
}

// ---- changes and texts ----

namespace {

void move_zones(Zones& zones, const Placement& pose) {
  for (Zone& zone : zones) {
    if (zone.is_box) {
      Box box = zone.box();
      pose.move(box.min);
      pose.move(box.max);
      zone = box;
      continue;
    }
    const auto move_ring = [&](Zone::Ring& ring) {
      for (Plan& corner : ring) corner = pose.unit * corner + pose.shift.head<2>();
    };
    move_ring(zone.outer);
    for (Zone::Ring& hole : zone.holes) move_ring(hole);
    pose.move(zone.min_z_m);
    pose.move(zone.max_z_m);
    if (zone.above_ground) pose.move(*zone.above_ground);
  }
}

std::string ring_text(const Zone::Ring& ring) {
  std::string text;
  for (const Plan& p : ring) text += (text.empty() ? "[" : ", ") + exact_pair(p.x(), p.y());
  return text + "]";
}

std::string zone_text(const Zone& zone) {
  if (zone.is_box) return "{min: " + exact_text(zone.box().min) + ", max: " + exact_text(zone.box().max) + "}";
  std::string text = "{polygon: " + ring_text(zone.outer), holes;
  for (const Zone::Ring& hole : zone.holes) holes += (holes.empty() ? "" : ", ") + ring_text(hole);
  if (!holes.empty()) text += ", holes: [" + holes + "]";
  const bool has_heights = std::isfinite(zone.min_z_m) || std::isfinite(zone.max_z_m);
  if (has_heights) text += ", z: " + exact_pair(zone.min_z_m, zone.max_z_m);
  if (zone.above_ground) text += ", agl: " + exact_pair(zone.above_ground->min_m, zone.above_ground->max_m);
  if (!has_heights && !zone.above_ground) text += ", heights: any";
  return text + "}";
}

std::string zones_text(const std::string& key, const Zones& zones) {
  std::string text = "  " + key + ":\n";
  for (const Zone& zone : zones) text += "    - " + zone_text(zone) + "\n";
  return text;
}

void note_ground(const Zones& zones, WrittenClaim& claim) {
  for (const Zone& zone : zones) {
    if (zone.above_ground) claim.ground = zone.above_ground->ground;
  }
}

}  // namespace

template <>
void move<Limit::keep_in>(Zones& limit, const Placement& pose) {
  move_zones(limit, pose);
}

template <>
void move<Limit::keep_out>(Zones& limit, const Placement& pose) {
  move_zones(limit, pose);
}

template <>
void leave_out<Limit::keep_in>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.keep_in.clear();
}

template <>
void leave_out<Limit::keep_out>(vantage::Navigation& navigation, vantage::Sensor& /*sensor*/) {
  navigation.keep_out.clear();
}

template <>
void add_text<Limit::keep_in>(const Zones& limit, MissionLines& lines) {
  lines.navigation += zones_text("keep_in", limit);
}

template <>
void add_text<Limit::keep_out>(const Zones& limit, MissionLines& lines) {
  lines.navigation += zones_text("keep_out", limit);
}

template <>
void write_beside<Limit::keep_in>(const Zones& limit, WrittenClaim& claim) {
  note_ground(limit, claim);
}

template <>
void write_beside<Limit::keep_out>(const Zones& limit, WrittenClaim& claim) {
  note_ground(limit, claim);
}

}  // namespace attack
