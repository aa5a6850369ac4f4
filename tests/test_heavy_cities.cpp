// Random targets in real cities, proved and checked by shadow rays. The run in ctest is short; full ones are
//
//     VANTAGE_HEAVY_TARGETS=200 VANTAGE_HEAVY_POINTS=10000 build/bin/vantage_tests --gtest_filter='*HeavyCities*'
//     VANTAGE_HEAVY_TARGETS=10000 VANTAGE_HEAVY_POINTS=0 build/bin/vantage_tests --gtest_filter='*HeavyCities*'
//
// They print a line per target; without points there are proofs alone. VANTAGE_SEED draws others.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "support/aimed_check.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/scene.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Random;
using testing::random_target;
using testing::shared_data;

struct City {
  std::size_t index;
  const char* name;
  const char* file;
  UpAxis up;
  std::size_t targets;  ///< of the short run
};

void PrintTo(const City& city, std::ostream* out) { *out << city.name; }

constexpr City kCities[] = {
    {0, "charlotte", "charlotte/uptownCharlotte.obj", UpAxis::y, 6},
    {1, "munich", "mesh/munich_merged.ply", UpAxis::z, 6},
    {2, "florence", "mesh/florence_merged.ply", UpAxis::z, 6},
    {3, "etoile", "mesh/etoile_merged.ply", UpAxis::z, 6},
    {4, "battcave", "battcave/battcave.obj", UpAxis::y, 6},
    {5, "openfoam_buildings", "mesh/openfoam-buildings.obj.gz", UpAxis::z, 2},
    {6, "delft_3dfier", "mesh/delft-3dfier.obj.gz", UpAxis::z, 3},
};
// Of the surface, with a reason why the volume ends there: of one volume, and of all of a city. Faces beside a target
// on a wall that is not quite plane have none: docs/proof.md.
constexpr double kLeastMaximal = 0.9, kLeastMaximalOfAll = 0.999;
constexpr std::size_t kCityCount = std::size(kCities);

std::size_t from_environment(const char* name, std::size_t otherwise) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

/// Draws targets on the ground, on roofs and on facades of a scene.
class TargetDraw {
 public:
  TargetDraw(const Scene& scene, Random& random) : scene_(scene), random_(random), bounds_(bounding_box(scene.mesh)) {}

  enum Kind { ground, roof, facade };

  Target draw(Kind kind) {
    const int corners = random_.integer(3, 12);
    const double radius = 0.5 * log_uniform(random_, 5, 80);
    if (kind == ground) return random_target(random_, corners, radius, ground_point(), Vec3::UnitZ());
    const auto [centre, normal] = surface_point(kind);
    Target target = random_target(random_, corners, radius, centre, normal);
    if (kind == facade) {  // mostly the street side
      const bool turn = is_open(centre + normal) ? random_.chance(0.1) : !random_.chance(0.1);
      target.front = turn ? Vec3(-normal) : normal;
    }
    return target;
  }

 private:
  /// Heights of the scene over and under a point, relative to it.
  std::vector<double> heights_at(const Vec3& p) const {
    std::vector<double> heights;
    for (const Triangle& t : scene_.mesh.triangles) {
      const Vec3 a = scene_.mesh.vertices[t[0]] - p, b = scene_.mesh.vertices[t[1]] - p,
                 c = scene_.mesh.vertices[t[2]] - p;
      const double u = b.x() * c.y() - b.y() * c.x(), v = c.x() * a.y() - c.y() * a.x(),
                   w = a.x() * b.y() - a.y() * b.x();
      const bool meets = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
      if (meets) heights.push_back((u * a.z() + v * b.z() + w * c.z()) / (u + v + w));
    }
    std::sort(heights.begin(), heights.end());
    return heights;
  }

  /// On the lowest surface at a random place; where there is none, on the lowest height of the scene. In the open, but
  /// for one in ten, which may be under a roof.
  Vec3 ground_point() {
    for (;;) {
      const Vec3 p = random_.in_box(bounds_);
      const std::vector<double> heights = heights_at(p);
      if (heights.size() > 1 && !random_.chance(0.1)) continue;
      return {p.x(), p.y(), heights.empty() ? bounds_.min.z() : p.z() + heights.front()};
    }
  }

  bool is_open(const Vec3& p) const {
    const std::vector<double> heights = heights_at(p);
    return heights.empty() || heights.back() < 0;
  }

  /// The middle of a random triangle, large ones more often, that is upright enough for a facade or level enough for a
  /// roof; its normal, upward for a roof.
  std::pair<Vec3, Vec3> surface_point(Kind kind) {
    for (;;) {
      const std::size_t i =
          static_cast<std::size_t>(random_.integer(0, static_cast<int>(scene_.mesh.triangles.size()) - 1));
      const Triangle& t = scene_.mesh.triangles[i];
      const auto& v = scene_.mesh.vertices;
      const Vec3 area = 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
      if (!(area.norm() > 1e-3) || random_.chance(1 / (1 + area.norm()))) continue;
      const Vec3 normal = area.normalized(), centre = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
      if (kind == facade && std::abs(normal.z()) < 0.02) return {centre, normal};
      const bool high = centre.z() > bounds_.min.z() + 0.1 * (bounds_.max.z() - bounds_.min.z());
      if (kind == roof && std::abs(normal.z()) > 0.5 && high) return {centre, normal.z() > 0 ? normal : Vec3(-normal)};
    }
  }

  const Scene& scene_;
  Random& random_;
  Box bounds_;
};

/// The smallest offset that an error gives as the way out; nothing if it is another error or too far up.
std::optional<double> offset_that_clears(const Error& error, double most) {
  const auto at = error.fix().find("offset: ");
  if (at == std::string::npos) return {};
  const double offset = std::stod(error.fix().substr(at + 8));
  return offset <= most ? std::optional(offset) : std::nullopt;
}

/// As in a mission file.
std::string describe(const Target& target, const Sensor& sensor) {
  std::ostringstream out;
  out.precision(17);
  const auto put = [&](const Vec3& v) { out << "[" << v.x() << ", " << v.y() << ", " << v.z() << "]"; };
  out << "\ntarget: {vertices: [";
  for (const Vec3& v : target.parts[0]) {
    put(v);
    out << (&v == &target.parts[0].back() ? "]" : ", ");
  }
  if (target.front) {
    out << ", front: ";
    put(*target.front);
  }
  out << ", offset: " << target.offset_m << "}\nsensor: {max_range: " << sensor.max_range_m << "}\n";
  return out.str();
}

struct Totals {
  std::size_t targets = 0, points = 0, inside = 0, over = 0, under = 0, rays = 0;
  std::size_t tested_facets = 0;
  std::size_t refuted = 0, open = 0, clear = 0;  ///< volumes that are made larger, by what becomes of their sight
  double least_maximal = 1, area = 0, maximal_area = 0;  ///< a share of the surface; square metres
  double worst_over = 0, worst_under = 0, worst_aimed = 0, engine_seconds = 0, proof_seconds = 0;
};

class HeavyCities : public ::testing::TestWithParam<City> {
 protected:
  /// A volume of a random target that is not pierced.
  Volume draw_volume(const PreparedScene& prepared, TargetDraw& draw, TargetDraw::Kind kind, Random& random,
                     Target& target, Sensor& sensor) {
    for (int attempt = 0; attempt < 5000; ++attempt) {
      target = draw.draw(kind);
      sensor.max_range_m = log_uniform(random, 50, 800);
      for (int again = 0; again < 2; ++again) {
        try {
          Volume volume = compute_visibility(PreparedTarget(prepared, target, sensor), {tolerance_, 0});
          if (volume.outcome == Outcome::computed) return volume;
          break;
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::input) << error.what() << describe(target, sensor);
          const auto offset = offset_that_clears(error, 6);  // up from rough ground, past a balcony
          if (!offset) break;
          EXPECT_EQ(again, 0) << "the offset that the error gave does not clear: " << error.what();
          target.offset_m = *offset;
        }
      }
    }
    ADD_FAILURE() << "no target found";
    return {};
  }

  /// What is proved of the volume is not proved of one that is larger by twice the part which proofs leave out.
  void prove(const Scene& scene, const Target& target, const Sensor& sensor, const Volume& volume,
             const std::string& what) {
    ProveOptions options{.lift_m = volume.lift_m, .maximal = true, .tolerance_m = volume.tolerance_m};
    const ProofReport proof = prove_volume(scene, target, sensor, {}, volume.mesh, options);
    EXPECT_EQ(proof.verdict(), ProofVerdict::proved)
        << what << ": " << proof.unproved.size() << " of " << proof.tested_facets << " facets, "
        << (proof.witness ? "wrong" : "open") << describe(target, sensor);
    EXPECT_GE(proof.maximal->proved_share, kLeastMaximal) << what << describe(target, sensor);
    EXPECT_TRUE(proof.maximal->conditions_hold()) << what;
    totals_.least_maximal = std::min(totals_.least_maximal, proof.maximal->proved_share);
    const double area = surface_area(volume.mesh);
    totals_.area += area;
    totals_.maximal_area += proof.maximal->proved_share * area;
    options.maximal = false;
    Mesh larger = volume.mesh;
    for (Vec3& vertex : larger.vertices) vertex += 2e-6 * (vertex - volume.frame.origin);
    const ProofReport refuted = prove_volume(scene, target, sensor, {}, larger, options);
    EXPECT_EQ(refuted.verdict(), ProofVerdict::wrong) << what << describe(target, sensor);
    const ProofVerdict sight = refuted.claims[0].verdict;
    ++(sight == ProofVerdict::wrong ? totals_.refuted : sight == ProofVerdict::proved ? totals_.clear : totals_.open);
    totals_.tested_facets += proof.tested_facets;
    totals_.proof_seconds += proof.seconds;
  }

  void check(const Scene& scene, Target target, const Sensor& sensor, const Volume& volume, const std::string& what) {
    prove(scene, target, sensor, volume, what);
    if (points_ == 0) {
      ++totals_.targets;
      totals_.engine_seconds += volume.seconds.engine;
      return;
    }
    const MeshMeasures m = measure(volume.mesh);
    EXPECT_TRUE(m.closed && m.oriented) << what;
    EXPECT_EQ(m.euler, 2) << what;
    EXPECT_EQ(m.pieces, 1u) << what;
    VerifyOptions options;
    options.points = points_;
    options.target_samples = 32;
    options.seed = totals_.targets + 1;
    options.tolerance_m = volume.tolerance_m;
    target.offset_m +=
        volume.lift_m.at(0);  // raised to clear its surface: the check looks at it where it was looked at
    const VerifyReport report = verify_volume(scene, target, sensor, {}, volume.mesh, options);
    EXPECT_EQ(report.over_claimed, 0u) << what << ": " << report.worst_over_depth_m << " m inside at "
                                       << report.worst_over_point.transpose() << ", " << report.worst_over_cause;
    Random random(options.seed);
    const testing::AimedReport aimed = testing::look_beside_edges(scene, volume, sensor.max_range_m, aimed_, random);
    EXPECT_LE(aimed.worst_share, 1e-6) << what << ": " << aimed.worst_depth << " m inside at "
                                       << aimed.worst_place.transpose() << ", beside an edge";
    totals_.worst_aimed = std::max(totals_.worst_aimed, aimed.worst_share);
    ++totals_.targets;
    totals_.points += report.points;
    totals_.inside += report.inside;
    totals_.rays += report.rays;
    totals_.over += report.over_claimed;
    totals_.under += report.under_claimed;
    totals_.worst_over = std::max(totals_.worst_over, report.worst_over_depth_m);
    totals_.worst_under = std::max(totals_.worst_under, report.worst_under_depth_m);
    totals_.engine_seconds += volume.seconds.engine;
    std::printf(
        "%s: %zu facets, %.1f ms, %zu points, %zu inside, over-claimed %zu (%.2g m), under-claimed %zu (%.2g m)\n",
        what.c_str(), m.facets, 1e3 * volume.seconds.engine, report.points, report.inside, report.over_claimed,
        report.worst_over_depth_m, report.under_claimed, report.worst_under_depth_m);
    std::fflush(stdout);
  }

  std::size_t all_targets_ = from_environment("VANTAGE_HEAVY_TARGETS", 0);  // 0: the short run
  std::size_t points_ = from_environment("VANTAGE_HEAVY_POINTS", 2000);
  std::size_t aimed_ = from_environment("VANTAGE_HEAVY_AIMED", 400);  // directions from each vertex, past scene edges
  double tolerance_ = all_targets_ ? ExactOptions().tolerance_m : 0.1;
  Totals totals_;
};

TEST_P(HeavyCities, NothingIsOverClaimed) {
  const City& city = GetParam();
  VANTAGE_REQUIRE_SHARED(city.file);
  const core::Stopwatch stopwatch;
  const Scene scene = read_scene(shared_data(city.file), {.up = city.up});
  const PreparedScene prepared(scene);
  Random random(1000 + city.index);
  TargetDraw draw(scene, random);
  const std::size_t share = all_targets_ / kCityCount + (city.index < all_targets_ % kCityCount);
  const std::size_t count = all_targets_ ? share : city.targets;
  for (std::size_t k = 0; k < count; ++k) {
    const auto kind = static_cast<TargetDraw::Kind>(k % 3);
    Target target;
    Sensor sensor;
    const Volume volume = draw_volume(prepared, draw, kind, random, target, sensor);
    if (volume.mesh.empty()) continue;
    char what[160];
    std::snprintf(what, sizeof what, "%s %zu %s, %zu vertices, %.1f m across, range %.0f m", city.name, k,
                  kind == TargetDraw::ground ? "ground"
                  : kind == TargetDraw::roof ? "roof"
                                             : "facade",
                  target.parts[0].size(), 2 * volume.frame.enclosing_radius_m, sensor.max_range_m);
    check(scene, target, sensor, volume, what);
  }
  EXPECT_GE(totals_.maximal_area, kLeastMaximalOfAll * totals_.area);
  const double seconds = stopwatch.seconds();
  std::printf(
      "%s: %zu targets, %zu points, %zu inside, %zu rays; over-claimed %zu (worst %.3g m), under-claimed %zu (worst "
      "%.3g "
      "m), beside edges worst %.3g of the distance; engine %.1f ms a target; %.1f s in all\n",
      city.name, totals_.targets, totals_.points, totals_.inside, totals_.rays, totals_.over, totals_.worst_over,
      totals_.under, totals_.worst_under, totals_.worst_aimed,
      1e3 * totals_.engine_seconds / static_cast<double>(totals_.targets), seconds);
  std::printf("%s: %zu far facets proved, maximal %.6f %% (least %.6f %%), %.1f times the engine\n", city.name,
              totals_.tested_facets, 100 * totals_.maximal_area / totals_.area, 100 * totals_.least_maximal,
              totals_.proof_seconds / totals_.engine_seconds);
  std::printf("%s: made larger, sight is refuted %zu, open %zu, right %zu times\n", city.name, totals_.refuted,
              totals_.open, totals_.clear);
}

INSTANTIATE_TEST_SUITE_P(All, HeavyCities, ::testing::ValuesIn(kCities),
                         [](const auto& city) { return std::string(city.param.name); });

}  // namespace
}  // namespace vantage
