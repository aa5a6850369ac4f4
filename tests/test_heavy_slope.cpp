// Monaco on its terrain: no building floats or sinks. The ground is worked out from the samples of the SRTM file, which
// is unpacked and read here, and from the corners that osmium-tool prints.
#include <gtest/gtest.h>
#include <proj.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/osm_maps.h"
#include "support/osmium_map.h"
#include "support/plane_area.h"
#include "support/shared_data.h"
#include "support/tag_oracle.h"
#include "support/temporary_directory.h"
#include "vantage/city.h"

namespace vantage::testing {
namespace {

constexpr double kError = 0.5;  // metres: how far the ground may be from the posts

/// The first file of a zip archive: its local header, then a deflate stream.
std::string first_of_zip(const std::string& bytes) {
  const auto number = [&](std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + i))) << (8 * i);
    return value;
  };
  const std::size_t start = 30 + number(26, 2) + number(28, 2);
  std::string result(1201 * 1201 * 2, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + start));
  stream.avail_in = static_cast<uInt>(bytes.size() - start);
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::runtime_error("zlib");
  const int outcome = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (outcome != Z_STREAM_END || stream.avail_out != 0) throw std::runtime_error("not a tile of 1201 posts");
  return result;
}

/// A tile of SRTM at 3 seconds of arc: heights of whole metres, row by row from the north.
class Tile {
 public:
  explicit Tile(std::string bytes) : bytes_(std::move(bytes)) {}

  double post(long row, long column) const {
    const std::size_t at = 2 * (static_cast<std::size_t>(row) * 1201 + static_cast<std::size_t>(column));
    const auto high = static_cast<unsigned char>(bytes_.at(at)), low = static_cast<unsigned char>(bytes_.at(at + 1));
    return static_cast<std::int16_t>(high << 8 | low);
  }

 private:
  std::string bytes_;
};

/// Degrees to the scene's metres, by PROJ and the words that the scene has for its frame.
class Projection {
 public:
  explicit Projection(const Georeference& place) {
    PJ* const rough = proj_create_crs_to_crs(context_, "EPSG:4326", projection_text(place).c_str(), nullptr);
    transform_ = proj_normalize_for_visualization(context_, rough);
    proj_destroy(rough);
  }
  Projection(const Projection&) = delete;
  Projection& operator=(const Projection&) = delete;
  ~Projection() {
    proj_destroy(transform_);
    proj_context_destroy(context_);
  }

  std::array<double, 2> operator()(const std::array<double, 2>& lonlat) const {
    const PJ_COORD result = proj_trans(transform_, PJ_FWD, proj_coord(lonlat[0], lonlat[1], 0, 0));
    return {result.xy.x, result.xy.y};
  }

 private:
  PJ_CONTEXT* context_ = proj_context_create();
  PJ* transform_ = nullptr;
};

using Corners = std::array<Vec3, 3>;

/// Twice the area of a triangle in the plane, counter-clockwise.
double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// z of the plane through three corners.
double height_in(const Corners& t, double x, double y) {
  const Vec3 p(x, y, 0);
  const double whole = turn(t[0], t[1], t[2]);
  return (turn(p, t[1], t[2]) * t[0].z() + turn(t[0], p, t[2]) * t[1].z() + turn(t[0], t[1], p) * t[2].z()) / whole;
}

std::vector<Corners> ground_triangles(const Scene& scene) {
  std::vector<Corners> triangles;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    if (display_name(scene.objects[scene.object_of[t]]) != "ground") continue;
    const Triangle& corners = scene.mesh.triangles[t];
    triangles.push_back(
        {scene.mesh.vertices[corners[0]], scene.mesh.vertices[corners[1]], scene.mesh.vertices[corners[2]]});
  }
  return triangles;
}

/// Lowest and highest of what is added.
struct Extent {
  double lowest = INFINITY, highest = -INFINITY;
  void add(double z) {
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
};

/// Of a triangle, where a side of an outline runs over it: at the ends of the common piece.
void add_side(const Corners& t, const std::array<double, 2>& a, const std::array<double, 2>& b, Extent& extent) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &p = t[i], &q = t[(i + 1) % 3];
    const double at_a = turn(p, q, Vec3(a[0], a[1], 0)), at_b = turn(p, q, Vec3(b[0], b[1], 0));
    if (at_a < 0 && at_b < 0) return;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  if (from > to) return;
  for (const double s : {from, to}) extent.add(height_in(t, a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])));
}

bool is_inside(const PlainRing& ring, const Vec3& p) {
  bool inside = false;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[i + 1];
    if ((a[1] > p.y()) == (b[1] > p.y())) continue;
    if (p.x() < a[0] + (b[0] - a[0]) * (p.y() - a[1]) / (b[1] - a[1])) inside = !inside;
  }
  return inside;
}

/// The ground under an outline: flat in each triangle, so lowest and highest where sides cross edges, at the outline's
/// corners, and at corners of triangles inside.
Extent ground_under(const PlainRing& ring, const std::vector<Corners>& triangles) {
  Extent x, y, extent;
  for (const auto& point : ring) {
    x.add(point[0]);
    y.add(point[1]);
  }
  for (const Corners& t : triangles) {
    Extent tx, ty;
    for (const Vec3& corner : t) {
      tx.add(corner.x());
      ty.add(corner.y());
    }
    if (tx.lowest > x.highest || tx.highest < x.lowest || ty.lowest > y.highest || ty.highest < y.lowest) continue;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) add_side(t, ring[i], ring[i + 1], extent);
    for (const Vec3& corner : t) {
      if (is_inside(ring, corner)) extent.add(corner.z());
    }
  }
  return extent;
}

/// Lowest and highest corner of each object.
std::map<std::string, Extent> extents(const Scene& scene) {
  std::map<std::string, Extent> result;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    Extent& extent = result[scene.objects[scene.object_of[t]].source_id];
    for (const std::uint32_t v : scene.mesh.triangles[t]) extent.add(scene.mesh.vertices[v].z());
  }
  return result;
}

class HeavySlope : public ::testing::Test {
 protected:
  void SetUp() override {
    VANTAGE_REQUIRE_OSMIUM();
    VANTAGE_REQUIRE_SHARED("osm/monaco.osm.pbf");
    VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
    CityOptions options;
    options.terrain = shared_data("osm-terrain/N43E007.hgt.zip");
    options.terrain_error_m = kError;
    city_ = build_city(shared_data("osm/monaco.osm.pbf"), options);
    ground_ = ground_triangles(city_.scene);
  }

  City city_;
  std::vector<Corners> ground_;
};

TEST_F(HeavySlope, TheGroundOfMonacoKeepsToThePosts) {
  const Tile tile(first_of_zip(read_bytes(shared_data("osm-terrain/N43E007.hgt.zip"))));
  const Projection to_metres(*city_.scene.georeference);
  std::size_t posts = 0;
  double worst = 0, highest = 0;
  for (long row = 0; row <= 1200; ++row) {
    for (long column = 0; column <= 1200; ++column) {
      const std::array<double, 2> at = {7 + static_cast<double>(column) / 1200, 44 - static_cast<double>(row) / 1200};
      if (at[0] < 7.40 || at[0] > 7.45 || at[1] < 43.71 || at[1] > 43.76) continue;
      const auto [x, y] = to_metres(at);
      for (const Corners& t : ground_) {
        const Vec3 p(x, y, 0);
        if (turn(t[0], t[1], p) < 0 || turn(t[1], t[2], p) < 0 || turn(t[2], t[0], p) < 0) continue;
        ++posts;
        worst = std::max(worst, std::abs(height_in(t, x, y) - tile.post(row, column)));
        highest = std::max(highest, tile.post(row, column));
        break;
      }
    }
  }
  std::cout << posts << " posts up to " << highest << " m, " << ground_.size() << " triangles, worst " << worst
            << " m\n";
  EXPECT_GT(posts, 500u);
  EXPECT_LE(worst, kError + 1e-3);
}

TEST_F(HeavySlope, NoBuildingOfMonacoFloatsOrSinks) {
  const OsmiumMap map = read_with_osmium(shared_data("osm/monaco.osm.pbf"));
  const Projection to_metres(*city_.scene.georeference);
  std::map<std::string, Extent> extent = extents(city_.scene);
  std::size_t compared = 0, standing = 0, parts = 0, other = 0, roofs_below = 0;
  double worst = 0, steepest = 0;
  for (const CityRecord& record : city_.report.records) {
    if (record.object.kind != ObjectKind::building && record.object.kind != ObjectKind::building_part) continue;
    const auto found = map.areas.find(record.object.source_id);
    if (found == map.areas.end() || record.object.kind == ObjectKind::building_part) {
      // A part stands on the ground of its building.
      ++(record.object.kind == ObjectKind::building_part ? parts : other);
      continue;
    }
    Extent ground;
    for (const LonLatPolygon& polygon : found->second.polygons) {
      PlainRing ring;
      for (const auto& position : polygon.at(0)) ring.push_back(to_metres(position));
      const Extent one = ground_under(ring, ground_);
      ground.add(one.lowest);
      ground.add(one.highest);
    }
    ++compared;
    EXPECT_NEAR(record.ground_m, ground.lowest, 0.01) << record.object.source_id;
    EXPECT_EQ(extent[record.object.source_id].lowest, record.base_m) << record.object.source_id;
    EXPECT_GE(record.base_m, record.ground_m - 0.01) << record.object.source_id;
    const bool stands = expected_heights(found->second.tags, nullptr).stands;
    EXPECT_TRUE(!stands || record.base_m < record.ground_m + 0.01) << record.object.source_id << " floats";
    standing += stands;
    worst = std::max(worst, std::abs(record.ground_m - ground.lowest));
    steepest = std::max(steepest, ground.highest - ground.lowest);
    roofs_below += record.top_m < ground.highest;
  }
  std::cout << compared << " buildings compared (" << parts << " parts, " << other
            << " skipped or without an outline), " << standing << " stand on the ground, to " << worst
            << " m; under one it rises by up to " << steepest << " m; " << roofs_below
            << " have ground above their roof on the upper side\n";
  EXPECT_GT(standing, 1200u);
  EXPECT_GT(steepest, 5);
}

}  // namespace
}  // namespace vantage::testing
