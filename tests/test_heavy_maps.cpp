// Every real map, end to end: no building lost, all solid, and as high and as large as their tags and corners say. What
// is expected is worked out from what osmium-tool prints, with none of the library's code.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "support/osm_maps.h"
#include "support/osmium_map.h"
#include "support/plane_area.h"
#include "support/shared_data.h"
#include "support/tag_oracle.h"
#include "vantage/city.h"

namespace vantage::testing {
namespace {

bool is_building(const CityRecord& record) {
  return record.object.kind == ObjectKind::building || record.object.kind == ObjectKind::building_part;
}

using Counts = std::map<std::string, std::size_t>;

std::string text(const Counts& counts) {
  std::string result;
  for (const auto& [what, count] : counts) {
    result += (result.empty() ? "" : "; ") + what + ": " + std::to_string(count);
  }
  return result;
}

class HeavyMaps : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    VANTAGE_REQUIRE_OSMIUM();
    VANTAGE_REQUIRE_SHARED(GetParam());
    map_ = read_with_osmium(shared_data(GetParam()));
    city_ = build_city(shared_data(GetParam()));
  }

  OsmiumMap map_;
  City city_;
};

// ---- every building accounted for ----

/// Ways that an untagged multipolygon relation is made of: it has their tags, and stands for them.
std::map<std::string, std::string> ways_of_untagged_relations(const OsmiumMap& map) {
  std::map<std::string, std::string> relation_of;
  for (const auto& [id, relation] : map.relations) {
    const bool is_multipolygon =
        tag(relation.tags, "type") == "multipolygon" || tag(relation.tags, "type") == "boundary";
    if (!is_multipolygon || says_building(relation.tags) || says_part(relation.tags)) continue;
    for (const ListedObject::Member& member : relation.members) relation_of[member.id] = id;
  }
  return relation_of;
}

/// Buildings, and what stands in, that are built, passed over or lost; each building once.
std::map<std::string, ObjectKind> told_of(const City& city) {
  std::map<std::string, ObjectKind> told;
  const auto tell = [&](const SceneObject& object) {
    const bool is_one = object.kind == ObjectKind::building || object.kind == ObjectKind::building_part;
    if (!is_one && object.kind != ObjectKind::stand_in) return;
    const bool is_new = told.emplace(object.source_id, object.kind).second;
    EXPECT_TRUE(is_new || !is_one) << object.source_id << " is told of twice";
  };
  for (const CityRecord& record : city.report.records) tell(record.object);
  for (const CityPassedOver& one : city.report.passed_over) tell(one.object);
  for (const LedgerEntry& entry : city.scene.ledger) {
    // Of a building relation the parts may be built, and its outline at fault.
    const bool is_group = entry.reason.find("outlines and parts") != std::string::npos || entry.what == "type=building";
    if (!entry.stand_in && !is_group) tell(entry.object);
  }
  return told;
}

TEST_P(HeavyMaps, EveryBuildingIsAccountedFor) {
  std::map<std::string, ObjectKind> records = told_of(city_);
  const std::map<std::string, std::string> untagged = ways_of_untagged_relations(map_);
  std::set<std::string> stood_for;  // relations
  Counts counts;
  for (const ListedObject& object : map_.tagged) {
    if (!says_building(object.tags) && !says_part(object.tags)) {
      ++counts["of these tagged 'no'"];
      EXPECT_FALSE(records.contains(object.id)) << object.id;
      continue;
    }
    const auto found = records.find(object.id);
    if (found != records.end()) {
      const ObjectKind kind = says_part(object.tags) ? ObjectKind::building_part : ObjectKind::building;
      EXPECT_TRUE(found->second == kind || found->second == ObjectKind::stand_in) << object.id;
      records.erase(found);
      ++counts["told of"];
      continue;
    }
    const auto relation = untagged.find(object.id);
    if (relation == untagged.end()) {
      ADD_FAILURE() << object.id << " is lost";
      continue;
    }
    stood_for.insert(relation->second);
    ++counts["ways that untagged multipolygons stand for"];
  }
  std::erase_if(records, [](const auto& entry) { return entry.second == ObjectKind::stand_in; });  // of other things
  for (const auto& [id, kind] : records) {
    EXPECT_TRUE(stood_for.contains(id)) << id << " is not a building that osmium-tool sees";
    ++counts["untagged multipolygons"];
  }
  std::cout << GetParam() << ": osmium-tool lists " << map_.tagged.size() << "; " << text(counts) << "\n";
}

// ---- heights and areas ----

/// Which buildings each part lies in: the one that a relation names, and all that hold at least half of it.
class PartsOfBuildings {
 public:
  explicit PartsOfBuildings(const OsmiumMap& map) : map_(map) {
    for (const auto& [id, area] : map.areas) {
      (says_part(area.tags) ? parts_ : buildings_).push_back(id);
      bounds_[id] = bounds_of(area.polygons);
    }
    for (const auto& [id, relation] : map.relations) {
      if (tag(relation.tags, "type") == "building") name(relation);
    }
    for (const std::string& part : parts_) find(part);
  }

  /// The one that is named, or the smallest. Empty: stands alone.
  std::string outline_of(const std::string& part) const {
    const auto found = outline_of_.find(part);
    return found == outline_of_.end() ? std::string() : found->second;
  }
  std::set<std::string> parts_of(const std::string& building) const {
    const auto found = parts_of_.find(building);
    return found == parts_of_.end() ? std::set<std::string>() : found->second;
  }

 private:
  void name(const ListedObject& relation) {
    std::string outline;
    for (const auto& member : relation.members) {
      const auto area = map_.areas.find(member.id);
      if (member.role == "outline" && area != map_.areas.end() && !says_part(area->second.tags)) outline = member.id;
    }
    if (outline.empty()) return;
    for (const auto& member : relation.members) {
      const auto area = map_.areas.find(member.id);
      const bool is_part = area != map_.areas.end() && says_part(area->second.tags);
      if (member.role != "part" || !is_part || outline_of_.contains(member.id)) continue;
      outline_of_[member.id] = outline;
      parts_of_[outline].insert(member.id);
    }
  }

  void find(const std::string& part) {
    const std::vector<LonLatPolygon>& polygons = map_.areas.at(part).polygons;
    const PlainFrame frame = frame_about(polygons);
    const PlainPolygons plain = in_metres(polygons, frame);
    const std::array<double, 4>& box = bounds_[part];
    const bool is_named = outline_of_.contains(part);
    double least = INFINITY;
    for (const std::string& building : buildings_) {
      const std::array<double, 4>& other = bounds_[building];
      if (other[0] > box[2] || other[2] < box[0] || other[1] > box[3] || other[3] < box[1]) continue;
      const PlainPolygons outline = in_metres(map_.areas.at(building).polygons, frame);
      if (covered_area(plain, {outline}) < 0.5 * plain_area(plain)) continue;
      parts_of_[building].insert(part);
      const double area = plain_area(outline);
      if (is_named || area >= least) continue;
      least = area;
      outline_of_[part] = building;
    }
  }

  const OsmiumMap& map_;
  std::vector<std::string> parts_, buildings_;
  std::map<std::string, std::array<double, 4>> bounds_;
  std::map<std::string, std::string> outline_of_;
  std::map<std::string, std::set<std::string>> parts_of_;
};

double longest_side(const PlainPolygons& polygons) {
  double longest = 0;
  for (const auto& polygon : polygons) {
    for (std::size_t i = 0; i + 1 < polygon.at(0).size(); ++i) {
      const auto &a = polygon[0][i], &b = polygon[0][i + 1];
      longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
    }
  }
  return longest;
}

bool is_underground(const ExportedArea& area) { return tag(area.tags, "location") == "underground"; }

/// What one record should say, and whether it does.
class Comparison {
 public:
  Comparison(const OsmiumMap& map, const City& city) : map_(map), parts_(map) {
    for (const LedgerEntry& entry : city.scene.ledger) entries_[entry.object.source_id] = &entry;
    for (const auto& [id, relation] : map.relations) {
      if (tag(relation.tags, "type") != "multipolygon") continue;
      if (!says_building(relation.tags) && !says_part(relation.tags)) continue;
      for (const ListedObject::Member& member : relation.members) of_relations_.insert(member.id);
    }
  }

  /// One that is not built.
  void compare(const CityPassedOver& one) {
    ++records_;
    ++excluded_["passed over, " + one.reason];
    const auto found = map_.areas.find(one.object.source_id);
    if (found == map_.areas.end()) return;  // a relation that osmium-tool makes no area of
    const PlainFrame frame = frame_about(found->second.polygons);
    EXPECT_TRUE(may_pass_over(one, found->second, in_metres(found->second.polygons, frame), frame))
        << one.object.source_id << " is passed over: " << one.reason;
  }

  void compare(const CityRecord& record) {
    ++records_;
    const auto found = map_.areas.find(record.object.source_id);
    if (found == map_.areas.end()) return exclude(record);
    const ExportedArea& area = found->second;
    const PlainFrame frame = frame_about(area.polygons);
    const PlainPolygons plain = in_metres(area.polygons, frame);
    EXPECT_FALSE(is_underground(area)) << record.object.source_id;
    ++compared_;
    EXPECT_TRUE(!area.is_mended || entries_.contains(record.object.source_id))
        << record.object.source_id << " lacks nodes, is not closed or crosses itself";
    compare_area(record, area, frame);
    const auto entry = entries_.find(record.object.source_id);
    if (entry != entries_.end() && entry->second->reason.find('=') != std::string::npos) {
      ++categories_["of tags that are no plain numbers or names"];  // the oracle takes them as untagged
      return;
    }
    const std::string outline = parts_.outline_of(record.object.source_id);
    compare_heights(record, expected_heights(area.tags, outline.empty() ? nullptr : &map_.areas.at(outline).tags));
  }

  void print(const std::string& name) const {
    std::cout << name << ": compared " << compared_ << " of " << records_ << "; "
              << (excluded_.empty() ? "none excluded" : "excluded by: " + text(excluded_))
              << "\n  of the compared: " << text(categories_) << "\n  largest difference of areas " << worst_area_ * 100
              << " %\n";
    std::size_t excluded = 0;
    for (const auto& [why, count] : excluded_) excluded += count;
    EXPECT_EQ(compared_ + excluded, records_);
  }

 private:
  /// osmium-tool makes no polygon of it: it is broken, untagged, or no area. Ours has to say so, or to have mended it.
  void exclude(const CityRecord& record) {
    const bool is_point = record.object.source_id.starts_with("node/");
    const auto relation = map_.relations.find(record.object.source_id);
    const bool is_untagged =
        relation != map_.relations.end() && !says_building(relation->second.tags) && !says_part(relation->second.tags);
    if (is_untagged) {
      ++excluded_["osmium-tool knows no untagged multipolygons"];
      return;
    }
    EXPECT_TRUE(entries_.contains(record.object.source_id))
        << record.object.source_id << ": osmium-tool makes no area of it";
    ++excluded_[is_point ? "a point" : "no area for osmium-tool"];
  }

  static bool says_height(const TagMap& tags) {
    return std::any_of(tags.begin(), tags.end(), [](const auto& tag) {
      return tag.first == "height" || tag.first == "est_height" || tag.first.ends_with("building:levels") ||
             tag.first == "building:height" || tag.first == "building:part:levels";
    });
  }

  /// How much of a building its parts cover: those on the ground, or all.
  double covered_by_parts(const std::string& building, const PlainPolygons& plain, const PlainFrame& frame,
                          bool grounded) const {
    std::vector<PlainPolygons> covering;
    const TagMap& tags = map_.areas.at(building).tags;
    for (const std::string& part : parts_.parts_of(building)) {
      const ExportedArea& area = map_.areas.at(part);
      if (is_underground(area) || area.is_mended) continue;  // what is guessed covers nothing
      const ExpectedHeights heights = expected_heights(area.tags, &tags), whole = expected_heights(tags, nullptr);
      const bool is_lower = heights.top.least < whole.top.least;  // and a guess, or of another building in this one
      if (is_lower && (!says_height(area.tags) || parts_.outline_of(part) != building)) continue;
      // A lift house stands on what is built, and a roof on posts covers another one alone.
      const bool is_on_posts = heights.because.find("stands on posts") != std::string::npos;
      if (is_on_posts && whole.because.find("stands on posts") == std::string::npos) continue;
      if (grounded && heights.bottom.least > 0 && !is_on_posts) continue;
      covering.push_back(in_metres(area.polygons, frame));
    }
    return covering.empty() ? 0 : covered_area(plain, covering);
  }

  bool may_pass_over(const CityPassedOver& one, const ExportedArea& area, const PlainPolygons& plain,
                     const PlainFrame& frame) const {
    // A ring that says what its multipolygon says as well.
    if (is_underground(area) || of_relations_.contains(one.object.source_id)) return true;
    if (one.reason.starts_with("it bounds ")) return true;  // of a relation that is untagged
    const double whole = area.is_mended ? covered_area(plain, {plain}) : plain_area(plain);
    const double width = whole / longest_side(plain);
    return whole < 0.05 || width < 0.01 || covered_by_parts(one.object.source_id, plain, frame, false) > 0.89 * whole;
  }

  void compare_area(const CityRecord& record, const ExportedArea& area, const PlainFrame& frame) {
    const PlainPolygons plain = in_metres(area.polygons, frame);
    // What crosses itself is filled where it is wound round an odd number of times, as the lines of a scan are.
    const double whole = area.is_mended ? covered_area(plain, {plain}) : plain_area(plain);
    double expected = whole, allowed = 0.05 + 0.01 * whole;
    if (!parts_.parts_of(record.object.source_id).empty()) {
      const double all = covered_by_parts(record.object.source_id, plain, frame, false);
      expected = whole - (all > 0.9 * whole ? all : covered_by_parts(record.object.source_id, plain, frame, true));
      // Left-overs below 1 m2 are not built.
      allowed += 1 + 0.02 * whole;
      ++categories_["area less its parts'"];
    } else {
      worst_area_ = std::max(worst_area_, std::abs(record.footprint_m2 - whole) / std::max(whole, 5.0));
      ++categories_[area.is_mended ? "area of an outline that lacks nodes, is not closed or crosses itself"
                                   : "area of the outline"];
    }
    EXPECT_GE(record.footprint_m2, expected - allowed) << record.object.source_id;
    // What stands in for an outline that is at fault may be larger.
    if (entries_.contains(record.object.source_id)) return;
    EXPECT_LE(record.footprint_m2, expected + allowed) << record.object.source_id;
  }

  void compare_heights(const CityRecord& record, const ExpectedHeights& expected) {
    const double base = record.base_m - record.ground_m, top = record.top_m - record.ground_m;
    EXPECT_TRUE(expected.top.holds(top)) << record.object.source_id << " is " << top << " m high, not "
                                         << expected.top.least << " to " << expected.top.most << " ("
                                         << expected.because << ")";
    EXPECT_TRUE(expected.bottom.holds(base))
        << record.object.source_id << " begins at " << base << " m, not " << expected.bottom.least << " to "
        << expected.bottom.most << " (" << expected.because << ")";
    EXPECT_GE(base, -0.01) << record.object.source_id << " lies below its ground";
    EXPECT_TRUE(!expected.stands || base < 0.01) << record.object.source_id << " floats";
    const bool is_range = expected.top.least < expected.top.most || expected.bottom.least < expected.bottom.most;
    ++categories_["heights " + std::string(is_range ? "within bounds" : "exact") +
                  (expected.because.empty() ? "" : ", " + expected.because)];
  }

  const OsmiumMap& map_;
  PartsOfBuildings parts_;
  std::size_t records_ = 0, compared_ = 0;
  double worst_area_ = 0;
  std::set<std::string> of_relations_;  // ways
  std::map<std::string, const LedgerEntry*> entries_;
  Counts excluded_, categories_;
};

TEST_P(HeavyMaps, HeightsAndAreasFollowFromTagsAndCorners) {
  Comparison comparison(map_, city_);
  for (const CityRecord& record : city_.report.records) {
    if (is_building(record)) comparison.compare(record);
  }
  for (const CityPassedOver& one : city_.report.passed_over) comparison.compare(one);
  comparison.print(GetParam());
}

// ---- closed solids ----

/// The triangles of one object, its corners numbered by position.
struct Piece {
  std::vector<Triangle> triangles;
  std::vector<Vec3> corners;
};

std::vector<Piece> pieces_of(const Scene& scene) {
  std::vector<Piece> pieces(scene.objects.size());
  std::vector<std::map<std::array<double, 3>, std::uint32_t>> numbers(scene.objects.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    Piece& piece = pieces[scene.object_of[t]];
    Triangle& triangle = piece.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& at = scene.mesh.vertices[scene.mesh.triangles[t][i]];
      const auto [found, is_new] = numbers[scene.object_of[t]].try_emplace(
          {at.x(), at.y(), at.z()}, static_cast<std::uint32_t>(piece.corners.size()));
      if (is_new) piece.corners.push_back(at);
      triangle[i] = found->second;
    }
  }
  return pieces;
}

/// Closed and turned the same way: each edge is run as often one way as the other.
bool is_closed(const Piece& piece) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : piece.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a != b) balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

/// The least volume of the parts that hang together.
double least_volume(const Piece& piece) {
  std::vector<std::uint32_t> root(piece.corners.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const Triangle& t : piece.triangles) {
    root[find(t[1])] = find(t[0]);
    root[find(t[2])] = find(t[0]);
  }
  std::map<std::uint32_t, double> volumes;
  for (const Triangle& t : piece.triangles) {
    const Vec3 &o = piece.corners[0], a = piece.corners[t[0]] - o, b = piece.corners[t[1]] - o,
               c = piece.corners[t[2]] - o;
    volumes[find(t[0])] += a.dot(b.cross(c)) / 6;
  }
  double least = INFINITY;
  for (const auto& [part, volume] : volumes) least = std::min(least, volume);
  return least;
}

struct Tally {
  std::size_t built = 0, solid = 0, open = 0;
};

/// Looks at every building of a city; tells of each that is not a solid.
Tally count_solids(const City& city, const std::string& map) {
  const std::vector<Piece> pieces = pieces_of(city.scene);
  // What is a building and a tower is two objects with one id.
  std::map<std::pair<std::string, ObjectKind>, std::size_t> object_of;
  for (std::size_t i = 0; i < city.scene.objects.size(); ++i) {
    object_of[{city.scene.objects[i].source_id, city.scene.objects[i].kind}] = i;
  }
  Tally tally;
  for (const CityRecord& record : city.report.records) {
    if (!is_building(record)) continue;
    ++tally.built;
    const auto found = object_of.find({record.object.source_id, record.object.kind});
    if (found == object_of.end()) {
      ADD_FAILURE() << record.object.source_id << " is not in the scene";
      continue;
    }
    const Piece& piece = pieces[found->second];
    const bool is_solid = is_closed(piece) && least_volume(piece) > 0;
    tally.solid += is_solid;
    const bool is_told =
        !is_solid && std::any_of(city.scene.ledger.begin(), city.scene.ledger.end(), [&](const LedgerEntry& entry) {
          return entry.object == record.object && entry.instead.find("open") != entry.instead.npos;
        });
    tally.open += is_told;
    EXPECT_TRUE(is_solid || is_told) << map << ": " << record.object.source_id << " is not a solid";
    double low = INFINITY, high = -INFINITY;
    for (const Vec3& corner : piece.corners) {
      low = std::min(low, corner.z());
      high = std::max(high, corner.z());
    }
    EXPECT_EQ(low, record.base_m) << record.object.source_id;
    EXPECT_EQ(high, record.top_m) << record.object.source_id;
  }
  return tally;
}

constexpr std::array<const char*, 13> kMaps = {"osm/bayfront_singapore.osm.pbf",
                                               "osm/berlin-siegessaeule.osm.gz",
                                               "osm/berlin.osm.gz",
                                               "osm/cote-dazur.osm.pbf",
                                               "osm/empire-state-600m.osm.pbf",
                                               "osm/erlangen.osm.gz",
                                               "osm/helsinki.osm.pbf",
                                               "osm/liechtenstein.osm.pbf",
                                               "osm/manhattan-midtown.osm.pbf",
                                               "osm/monaco.osm.pbf",
                                               "osm/new-york-les.osm.pbf",
                                               "osm/new-york-unsorted.osm.pbf",
                                               "osm/singapore-bayfront.osm.pbf"};

TEST(HeavyMapsTogether, AreClosedAndOriented) {
  VANTAGE_REQUIRE_SHARED("osm");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shared_data("osm"))) files += entry.is_regular_file();
  EXPECT_EQ(files, kMaps.size()) << "a file is left out";
  Tally all;
  for (const char* const map : kMaps) {
    const City city = build_city(shared_data(map));
    const Tally tally = count_solids(city, map);
    std::cout << map << ": " << tally.solid << " of " << tally.built << " built are closed and oriented\n";
    all = {all.built + tally.built, all.solid + tally.solid, all.open + tally.open};
  }
  std::cout << "all: " << all.solid << " of " << all.built << "; " << all.open << " open surfaces\n";
  EXPECT_GT(all.built, 50000u);
  EXPECT_GE(static_cast<double>(all.solid), 0.995 * static_cast<double>(all.built));
}

std::string test_name(const ::testing::TestParamInfo<const char*>& test) {
  std::string name = test.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, HeavyMaps, ::testing::ValuesIn(kMaps), test_name);

}  // namespace
}  // namespace vantage::testing
