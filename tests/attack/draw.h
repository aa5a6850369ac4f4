// Scenes that are degenerate on purpose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "case.h"
#include "random.h"

namespace attack {

using vantage::Vec3;

inline constexpr double kScales[] = {1e-3, 1e-1, 1, 1e2, 1e4};

/// The case `index` of the run `seed`, the same on every machine. Scales take turns.
Case draw_case(std::uint64_t seed, std::size_t index);

// ---- what the files of the drawing share ----

/// Where the drawing stands in the world.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();
  double scale = 1;

  Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + shift; }
};

/// Corners in the plane z = 0 round the origin, counter-clockwise, about one across. `kind` gets its name.
std::vector<Vec3> draw_outline(Random& random, double scale, std::string& kind);

/// A length that is next to nothing: 0, or 1e-12 to 1e-4 metres, or of the target's size; in units of `scale`, with a
/// sign at random when `either`.
double tiny(Random& random, double scale, bool either = true);

/// Builds a scene about a target in the plane z = 0, in units of the target's size. Each call that adds a thing begins
/// an object.
class SceneDrawing {
 public:
  SceneDrawing(Random& random, double scale, std::vector<Vec3> outline)
      : random_(random), scale_(scale), outline_(std::move(outline)) {}

  /// Adds things of one kind, and says which.
  std::string add_things();

  vantage::Scene finish();

 private:
  using Kind = void (SceneDrawing::*)();
  struct Named {
    const char* name;
    Kind draw;
  };

  // The kinds: draw_things.cpp, draw_buildings.cpp.
  void walls();
  void parapets();
  void planes_through_edges();
  void touching();
  void low_slopes();
  void ground();
  void canopy();
  void fan();
  void poles();
  void slivers();
  void soup();
  void houses();
  void roof();
  void room();
  void rims();
  void copies();

  double tiny(bool either = true) { return attack::tiny(random_, scale_, either); }
  void object(const char* name);
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  /// As triangles: a fan about a corner, about a point inside, or ears.
  void polygon(const std::vector<Vec3>& corners);
  void box(const Vec3& low, const Vec3& high, bool open_below);
  /// Corner `i` of the target, any integer.
  const Vec3& corner(int i) const;
  Vec3 outward(int side) const;
  bool pierces(const Vec3& a, const Vec3& b, const Vec3& c) const;

  Random& random_;
  double scale_;
  std::vector<Vec3> outline_;
  vantage::Scene scene_;
  bool lets_pierce_ = false;
};

}  // namespace attack
