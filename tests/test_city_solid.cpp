#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "core/solid_check.h"
#include "core/weld.h"
#include "maps/city/building_solid.h"
#include "maps/city/roof_profile.h"
#include "support/random.h"
#include "support/rings.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

using testing::inside;
using testing::rectangle;

using vantage::testing::Random;

Ring regular(int corners, double radius, const Vec2& centre = Vec2::Zero(), double turn = 0) {
  Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / corners;
    ring.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

Ring moved(Ring ring, double angle, const Vec2& offset) {
  const Eigen::Rotation2Dd rotation(angle);
  for (Vec2& p : ring) p = rotation * p + offset;
  return ring;
}

std::vector<Footprint> cleaned(const Footprint& rough) {
  Repairs repairs;
  return clean({rough}, repairs);
}

BuildingForm form_of(RoofShape shape, double bottom, double top, double roof) {
  BuildingForm form;
  form.bottom_m = bottom;
  form.top_m = top;
  form.roof_m = roof;
  form.roof = shape;
  return form;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to(const Vec2& p, const Footprint& footprint) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], along = ring[(i + 1) % ring.size()] - a;
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (a + t * along - p).norm());
    }
  };
  look(footprint.outer);
  for (const Ring& hole : footprint.holes) look(hole);
  return least;
}

/// Lowest and highest z at which the mesh is met by the upright line through `p`; nothing when it is missed.
std::optional<std::pair<double, double>> span_at(const Mesh& mesh, const Vec2& p) {
  std::optional<std::pair<double, double>> span;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec2 pa = a.head<2>() - p, pb = b.head<2>() - p, pc = c.head<2>() - p;
    const double u = cross(pb, pc), v = cross(pc, pa), w = cross(pa, pb), sum = u + v + w;
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || std::abs(sum) < 1e-12) continue;
    const double z = (u * a.z() + v * b.z() + w * c.z()) / sum;
    span = span ? std::pair(std::min(span->first, z), std::max(span->second, z)) : std::pair(z, z);
  }
  return span;
}

/// Every edge has exactly two facets, also when equal positions are one; closed, outward, free of self-intersections.
void expect_sound(const CitySolid& solid, const std::string& what) {
  for (const Mesh& mesh : {solid.mesh, core::welded(solid.mesh)}) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle& t : mesh.triangles) {
      for (int e = 0; e < 3; ++e) ++uses[{t[e], t[(e + 1) % 3]}];
    }
    for (const auto& [edge, count] : uses) {
      const auto back = uses.find({edge.second, edge.first});
      ASSERT_TRUE(count == 1 && back != uses.end() && back->second == 1) << what;
    }
  }
  EXPECT_GT(enclosed_volume(solid.mesh), 0) << what;
  try {
    EXPECT_EQ(core::checked_solid(solid.mesh, "solid").triangles.size(), solid.mesh.triangles.size()) << what;
  } catch (const Error& error) {
    ADD_FAILURE() << what << ": " << error.what();
  }
}

/// What the table in roof_profile.h says, written down once more: the height at (u, v) above the eaves.
double profile(RoofShape shape, double u, double v, double L, double W, double R) {
  const double m = std::min(L, W), eaves = W - std::abs(v), ends = L - std::abs(u), nearest = std::min(eaves, ends);
  const auto bent = [&](double d, double all) {
    return d < all / 2 ? R * 4 / 3 * d / all : R / 3 + R * 2 / 3 * d / all;
  };
  switch (shape) {
    case RoofShape::flat:
      return 0;
    case RoofShape::gabled:
      return R * eaves / W;
    case RoofShape::hipped:
      return R * nearest / m;
    case RoofShape::half_hipped:
      return std::min(R * eaves / W, R / 2 + std::max(R / W, R / 2 / L) * ends);
    case RoofShape::pyramidal:
      return R * std::min(eaves / W, ends / L);
    case RoofShape::skillion:
      return R * (W - v) / (2 * W);
    case RoofShape::gambrel:
      return bent(eaves, W);
    case RoofShape::mansard:
      return bent(nearest, m);
    case RoofShape::round: {
      if (R > W) return R * std::sqrt(std::max(0.0, 1 - v * v / (W * W)));
      const double radius = (W * W + R * R) / (2 * R);
      return R - radius + std::sqrt(std::max(0.0, radius * radius - v * v));
    }
    case RoofShape::saltbox:
      return v > -W / 3 ? R * (W - v) / (W * 4 / 3) : R * (W + v) / (W * 2 / 3);
    default:
      return 0;
  }
}

const std::vector<RoofShape> kRidged = {RoofShape::flat,        RoofShape::gabled,   RoofShape::hipped,
                                        RoofShape::half_hipped, RoofShape::skillion, RoofShape::gambrel,
                                        RoofShape::mansard,     RoofShape::round,    RoofShape::saltbox};

/// Heights at random places, and the volume, against the profile. The highest place counts as `roof_m`.
void expect_profile(const Footprint& footprint, const BuildingForm& form, const CitySolid& solid, Random& random,
                    const std::string& what) {
  const RoofFrame frame = roof_frame(footprint, form);
  const double L = frame.half_length, W = frame.half_width, R = form.roof_m;
  const auto height = [&](const Vec2& p) {
    const Vec2 local = frame.local(p);
    return profile(form.roof, local.x(), local.y(), L, W, R);
  };
  // Where the outline leaves out the ridge, the roof is stretched: its highest corner tells how much.
  double highest = 0;
  for (const Vec3& v : solid.mesh.vertices) highest = std::max(highest, height(v.head<2>()));
  const double stretch = form.roof == RoofShape::flat ? 1 : R / highest;
  const double eaves = form.top_m - R;
  const double chord = form.roof == RoofShape::round ? 0.06 + 0.01 * (R + W) : 0;  // inside the arc; at most 16
  const Vec2 size = Vec2(L, W);
  double sum = 0;
  int hits = 0, looked = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 local = Vec2((i + random.uniform(0, 1)) / kSteps * 2 - 1, (j + random.uniform(0, 1)) / kSteps * 2 - 1);
      const Vec2 p = frame.centre + frame.along * (local.x() * L) + frame.across * (local.y() * W);
      if (!inside(p, footprint)) continue;
      ++hits;
      sum += eaves - form.bottom_m + stretch * height(p);
      if (looked >= 25 || !random.chance(0.05) || distance_to(p, footprint) < 0.01) continue;
      ++looked;
      const auto span = span_at(solid.mesh, p);
      ASSERT_TRUE(span) << what;
      EXPECT_NEAR(span->first, form.bottom_m, 1e-9) << what;
      const double wanted = eaves + stretch * height(p);
      EXPECT_LE(span->second, wanted + 2e-3 * stretch) << what;
      // An arc may be upright at the eaves, where chords inside it are far below.
      if (form.roof == RoofShape::round && std::abs(frame.local(p).y()) > 0.8 * W) continue;
      EXPECT_GE(span->second, wanted - 2e-3 * stretch - stretch * chord) << what;
    }
  }
  const double cell = 4 * size.prod() / (kSteps * kSteps);
  const double error =
      0.02 * sum * cell + 6 * std::sqrt(static_cast<double>(hits)) * cell * (form.top_m - form.bottom_m) / 4;
  EXPECT_NEAR(enclosed_volume(solid.mesh), sum * cell, error + chord * stretch * area_m2(footprint)) << what;
}

TEST(CitySolid, ExactVolumesOverARectangle) {
  // 20 x 10, walls of 6 m, roofs of 3 m: L = 10, W = 5.
  const Footprint footprint{rectangle(0, 0, 20, 10), {}};
  const auto roof_volume = [&](RoofShape shape) {
    const CitySolid solid = make_solid(footprint, form_of(shape, 1, 10, 3), 50);
    expect_sound(solid, std::string(text(shape)));
    EXPECT_EQ(solid.repair, "");
    EXPECT_EQ(bounding_box(solid.mesh).min.z(), 51);
    EXPECT_EQ(bounding_box(solid.mesh).max.z(), 60);
    return enclosed_volume(solid.mesh) - 200 * 6;
  };
  EXPECT_NEAR(roof_volume(RoofShape::flat), 600, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::gabled), 300, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::skillion), 300, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::saltbox), 300, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::hipped), 300 - 2 * 25, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::half_hipped), 300 - 2 * 25.0 / 8, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::pyramidal), 200, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::cone), 200, 1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::gambrel), 20 * 10 * (1.0 + 2.5) / 2, 1e-6);
  // Frusta: from 20 x 10 to 15 x 5 and a hipped roof of 1 m on that.
  EXPECT_NEAR(roof_volume(RoofShape::mansard), 2 * (200 + 75 + 4 * 17.5 * 7.5) / 6 + 0.5 * 75 - 2 * 2.5 * 2.5 / 3,
              1e-6);
  EXPECT_NEAR(roof_volume(RoofShape::dome), 200 * 3 * 2.0 / 3, 10);
  const double radius = (25 + 9) / 6.0, angle = 2 * std::atan2(5, radius - 3);
  EXPECT_NEAR(roof_volume(RoofShape::round), 20 * radius * radius * (angle - std::sin(angle)) / 2, 6);
  EXPECT_GT(roof_volume(RoofShape::onion), 200);
}

TEST(CitySolid, RidgesAndDirections) {
  const Footprint footprint{rectangle(0, 0, 20, 10), {}};
  const auto height = [&](const BuildingForm& form, double x, double y) {
    const CitySolid solid = make_solid(footprint, form, 0);
    expect_sound(solid, "");
    return span_at(solid.mesh, {x, y})->second;
  };
  BuildingForm form = form_of(RoofShape::gabled, 0, 10, 4);
  EXPECT_NEAR(height(form, 3, 5.00001), 10, 1e-3) << "along the longer side";
  form.roof_across = true;
  EXPECT_NEAR(height(form, 10.00001, 2), 10, 1e-3);
  form = form_of(RoofShape::skillion, 0, 10, 4);
  for (const auto& [degrees, x, y] :
       std::vector<std::array<double, 3>>{{90, 1, 5}, {270, 19, 5}, {0, 10, 0.5}, {180, 10, 9.5}}) {
    form.roof_direction_deg = degrees;  // falls there, so it is high on the other side
    EXPECT_NEAR(height(form, x, y), 10 - 4 * 0.05, 1e-3) << degrees;
    form.roof_direction_deg = degrees + 25;  // means the same side
    EXPECT_NEAR(height(form, x, y), 10 - 4 * 0.05, 1e-3) << degrees;
  }
  form.roof_direction_deg = 45;  // falls to the north-east corner
  EXPECT_NEAR(height(form, 0.01, 0.01), 10, 1e-2);
  EXPECT_NEAR(height(form, 19.99, 9.99), 6, 1e-2);
  form.roof_direction_deg.reset();
  EXPECT_GT(height(form, 10, 9), height(form, 10, 1)) << "to the south when nothing is said";
}

TEST(CitySolid, PitchesAndDecks) {
  const Footprint footprint{rectangle(0, 0, 20, 10), {}};
  BuildingForm form = form_of(RoofShape::gabled, 0, 30, 0);
  form.pitch = BuildingForm::Pitch{45, true, 1};
  EXPECT_NEAR(bounding_box(make_solid(footprint, form, 0).mesh).max.z(), 35, 1e-9);
  form.is_box = true;
  EXPECT_NEAR(enclosed_volume(make_solid(footprint, form, 0).mesh), 20 * 10 * 35, 1e-6) << "what stands in for it";
  form.is_box = false;
  form.pitch = BuildingForm::Pitch{60, false, 1.0 / 3};
  EXPECT_NEAR(bounding_box(make_solid(footprint, form, 0).mesh).max.z(), 30, 1e-9);
  EXPECT_NEAR(settled(form, roof_frame(footprint, form)).roof_m, std::tan(std::numbers::pi / 3) * 5, 1e-9);
  form.top_m = 9;
  EXPECT_NEAR(settled(form, roof_frame(footprint, form)).roof_m, 3, 1e-9);
  form.pitch->on_top = true;
  EXPECT_NEAR(settled(form, roof_frame(footprint, form)).top_m, 13.5, 1e-9);
  form = form_of(RoofShape::flat, 0, 5, 0);
  form.deck_m = 0.5;
  EXPECT_EQ(bounding_box(make_solid(footprint, form, 0).mesh).min.z(), 4.5);
}

TEST(CitySolid, CourtyardsStayOpenUnderEveryRoof) {
  const Footprint footprint = cleaned({rectangle(0, 0, 30, 20), {rectangle(8, 6, 20, 14)}})[0];
  for (int k = 0; k < kRoofShapes; ++k) {
    const auto shape = static_cast<RoofShape>(k);
    const CitySolid solid = make_solid(footprint, form_of(shape, 0, 12, 5), 0);
    expect_sound(solid, std::string(text(shape)));
    EXPECT_FALSE(span_at(solid.mesh, {14, 10})) << text(shape);
    EXPECT_TRUE(span_at(solid.mesh, {4, 10})) << text(shape);
    EXPECT_NEAR(bounding_box(solid.mesh).max.z(), 12, 1e-9) << text(shape);
    EXPECT_EQ(solid.repair.empty(), shape != RoofShape::onion) << solid.repair;
  }
}

TEST(CitySolid, WhatIsNotStarShapedIsNamed) {
  const Ring horseshoe = {{0, 0}, {20, 0}, {20, 20}, {15, 20}, {15, 5}, {5, 5}, {5, 20}, {0, 20}};
  for (const RoofShape shape : {RoofShape::dome, RoofShape::cone, RoofShape::onion}) {
    const CitySolid solid = make_solid({horseshoe, {}}, form_of(shape, 0, 12, 5), 0);
    expect_sound(solid, std::string(text(shape)));
    vantage::testing::expect_wording(solid.repair);
    EXPECT_NEAR(enclosed_volume(solid.mesh), 250 * 12, 0.1) << "a box holds whatever it is";
  }
  EXPECT_EQ(make_solid({horseshoe, {}}, form_of(RoofShape::pyramidal, 0, 12, 5), 0).repair, "");
}

TEST(CitySolid, ManyCornersTakeNoTime) {
  const Footprint ring = cleaned({regular(4000, 200), {regular(3, 20)}})[0];
  const CitySolid dome = make_solid(ring, form_of(RoofShape::dome, 0, 50, 30), 0);
  vantage::testing::expect_wording(dome.repair);
  EXPECT_GT(make_solid({ring.outer, {}}, form_of(RoofShape::dome, 0, 50, 30), 0).mesh.triangles.size(), 8000u);
  EXPECT_GT(make_solid(ring, form_of(RoofShape::mansard, 0, 50, 30), 0).mesh.triangles.size(), 8000u);
}

TEST(CitySolid, TouchingRingsAreDrawnApart) {
  const std::vector<Footprint> touching = {
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{0, 0}, {3, 6}, {6, 3}}}},                            // hole at a corner
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{5, 0}, {3, 4}, {7, 4}}}},                            // hole on a side
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{2, 2}, {2, 5}, {5, 5}}, {{5, 5}, {8, 8}, {8, 5}}}},  // hole at hole
      {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{5, 0}, {0, 5}, {5, 10}, {10, 5}}}},                  // four triangles
      {{{0, 0}, {4, 0}, {2, 3}, {4, 6}, {0, 6}, {2, 3}}, {}},                                        // a waist
      {{{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}}, {}},  // a corner on a side
  };
  for (std::size_t k = 0; k < touching.size(); ++k) {
    double area = 0;
    for (const Footprint& footprint : cleaned(touching[k])) {
      area += area_m2(footprint);
      for (int shape = 0; shape < kRoofShapes; ++shape) {
        const CitySolid solid = make_solid(footprint, form_of(static_cast<RoofShape>(shape), 2, 9, 3), 0);
        expect_sound(solid, "case " + std::to_string(k) + " roof " + std::to_string(shape));
      }
      const CitySolid flat = make_solid(footprint, form_of(RoofShape::flat, 0, 1, 0), 0);
      EXPECT_NEAR(enclosed_volume(flat.mesh), area_m2(footprint), 0.05);
    }
    EXPECT_GT(area, 10) << k;
  }
}

/// A footprint of one of many kinds.
Footprint draw_footprint(Random& random) {
  const double a = random.uniform(3, 40), b = random.uniform(3, 40);
  Footprint rough;
  switch (random.integer(0, 6)) {
    case 0:
      rough.outer = rectangle(0, 0, a, b);
      break;
    case 1:
      rough.outer = {{0, 0}, {a, 0}, {a, b / 3}, {a / 3, b / 3}, {a / 3, b}, {0, b}};
      break;
    case 2:
      rough.outer = {{0, 0}, {a, 0}, {a, b}, {a * 2 / 3, b}, {a * 2 / 3, b / 4}, {a / 3, b / 4}, {a / 3, b}, {0, b}};
      break;
    case 3:
      rough.outer = regular(random.integer(3, 24), a);
      break;
    case 4: {  // star-shaped
      const int corners = random.integer(4, 14);
      for (const Vec2& p : regular(corners, 1)) rough.outer.push_back(p * random.uniform(3, 20));
      break;
    }
    case 5: {  // with courtyards
      rough.outer = rectangle(0, 0, 2 * a, 2 * b);
      rough.holes.push_back(rectangle(a * 0.2, b * 0.2, a * 0.9, b * 1.5));
      if (random.chance(0.5)) rough.holes.push_back(regular(7, std::min(a, b) * 0.3, Vec2(a * 1.5, b)));
      break;
    }
    default: {  // a tangle
      const int corners = random.integer(5, 9);
      for (int i = 0; i < corners; ++i) rough.outer.emplace_back(random.uniform(0, 20), random.uniform(0, 20));
    }
  }
  if (random.chance(0.3)) {  // corners in the middle of sides
    Ring ring;
    for (std::size_t i = 0; i < rough.outer.size(); ++i) {
      ring.push_back(rough.outer[i]);
      ring.push_back((rough.outer[i] + rough.outer[(i + 1) % rough.outer.size()]) / 2 + Vec2(1e-3, 0));
    }
    rough.outer = ring;
  }
  const double angle = random.chance(0.3) ? 0 : random.uniform(0, 2 * std::numbers::pi);
  const Vec2 offset = random.chance(0.2) ? Vec2(1.2e6, -3.4e6) : Vec2(random.uniform(-900, 900), 17);
  rough.outer = moved(rough.outer, angle, offset);
  for (Ring& hole : rough.holes) hole = moved(hole, angle, offset);
  std::vector<Footprint> footprints = cleaned(rough);
  if (footprints.empty()) return draw_footprint(random);
  return footprints[random.integer(0, static_cast<int>(footprints.size()) - 1)];
}

BuildingForm draw_form(Random& random, RoofShape shape) {
  const double bottom = random.chance(0.5) ? 0 : random.uniform(0, 30), body = random.uniform(2, 30);
  const double share = random.chance(0.3) ? 1 : random.uniform(0.05, 0.95);
  BuildingForm form = form_of(shape, bottom, bottom + body, shape == RoofShape::flat ? 0 : body * share);
  if (random.chance(0.1)) form = form_of(shape, bottom, bottom + 0.01, shape == RoofShape::flat ? 0 : 0.01);
  if (random.chance(0.4))
    form.roof_direction_deg = random.chance(0.5) ? random.integer(0, 15) * 22.5 : random.uniform(0, 360);
  form.roof_across = random.chance(0.3);
  return form;
}

TEST(CitySolid, RandomFootprintsUnderEveryRoof) {
  Random random(47);
  for (int round = 0; round < 50; ++round) {
    const Footprint footprint = draw_footprint(random);
    for (int k = 0; k < kRoofShapes; ++k) {
      const auto shape = static_cast<RoofShape>(k);
      const BuildingForm form = draw_form(random, shape);
      const std::string what = "round " + std::to_string(round) + ", " + std::string(text(shape));
      const double ground = random.chance(0.5) ? 0 : random.uniform(-50, 900);
      const CitySolid solid = make_solid(footprint, form, ground);
      expect_sound(solid, what);
      const Box box = bounding_box(solid.mesh);
      EXPECT_NEAR(box.min.z(), ground + form.bottom_m, 1e-9) << what;
      EXPECT_NEAR(box.max.z(), ground + form.top_m, 1e-9) << what;
      if (HasFatalFailure()) return;
    }
  }
}

TEST(CitySolid, RoofsFollowTheirProfile) {
  Random random(53);
  for (int round = 0; round < 25; ++round) {
    const Footprint footprint = draw_footprint(random);
    for (const RoofShape shape : kRidged) {
      const BuildingForm form = draw_form(random, shape);
      if (form.top_m - form.bottom_m < 0.02) continue;
      const std::string what = "round " + std::to_string(round) + ", " + std::string(text(shape));
      expect_profile(footprint, form, make_solid(footprint, form, 0), random, what);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(CitySolid, NearlyDegenerateOutlines) {
  Random random(59);
  std::vector<Ring> rings = {
      rectangle(0, 0, 1000, 0.02),                                               // as thin as is built
      rectangle(0, 0, 0.15, 0.15),                                               // as small
      {{0, 0}, {20, 0}, {20, 5}, {20, 10}, {0, 10}, {0, 5}},                     // the ridge meets corners
      {{0, 0}, {20, 0}, {20, 10}, {12, 10}, {12, 5}, {8, 5}, {8, 10}, {0, 10}},  // the ridge runs along a side
      {{0, 0}, {20, 0}, {20, 10}, {10, 5 + kGrid}, {0, 10}},                     // a unit off the ridge
      {{0, 0}, {10, kGrid}, {20, 0}, {20, 10}, {10, 10 - kGrid}, {0, 10}},       // sides a unit off straight
      {{0, 0}, {10, 2 * kGrid}, {20, 0}, {20, 10}, {10, 10 + 2 * kGrid}, {0, 10}},
      {{0, 0}, {1e4, 0}, {1e4, 1e4}, {0, 1e4}},                      // 10 km
      {{0, 0}, {50, 0}, {50, 0.5}, {0.5, 0.5}, {0.5, 50}, {0, 50}},  // a thin L
      {{0, 0}, {100, 1}, {0, 2}},                                    // a needle
      regular(200, 30),
  };
  for (int extra = 0; extra < 40; ++extra) {  // on a coarse lattice: many creases through corners
    Ring ring;
    for (int i = random.integer(3, 8); i > 0; --i)
      ring.emplace_back(random.integer(0, 4) * 5, random.integer(0, 4) * 5);
    rings.push_back(ring);
  }
  for (std::size_t k = 0; k < rings.size(); ++k) {
    for (const Footprint& footprint : cleaned({rings[k], {}})) {
      for (int s = 0; s < kRoofShapes; ++s) {
        const auto shape = static_cast<RoofShape>(s);
        const std::string what = "outline " + std::to_string(k) + ", " + std::string(text(shape));
        for (const double roof : {3.0, 10.0, 0.001}) {
          expect_sound(make_solid(footprint, form_of(shape, 0, 10, shape == RoofShape::flat ? 0 : roof), 0), what);
        }
        if (HasFatalFailure()) return;
      }
    }
  }
}

}  // namespace
}  // namespace vantage::internal::city
