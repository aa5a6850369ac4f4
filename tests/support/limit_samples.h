// One table of all limits, for tests of what holds for each of them. A limit that is added does not link before
// limit_rows_navigation.cpp or limit_rows_sensor.cpp has its row; then it is visited, cut, asked, verified, proved,
// moved, flown through, written, hashed and told by the tests that walk over the table.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/random.h"
#include "vantage/each_limit.h"
#include "vantage/error.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::testing {

struct LimitWorld {
  Scene scene;
  Target target;
  Sensor sensor;
  Navigation navigation;
};

/// Turns, scales, then shifts.
struct Motion {
  const char* name;
  double scale = 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();

  Vec3 of(const Vec3& point) const { return scale * (turn * point) + shift; }
  double of_z(double z) const { return scale * z + shift.z(); }
};

/// What turns a limit allows.
enum class Turns { all, about_z, quarters };

/// A way to draw a limit for a target of some metres at the origin that looks up, with 40 m of range.
struct LimitDraw {
  const char* name;
  Turns turns;
  /// So much, of the range, may the surfaces of two volumes be apart: that facets of the limit stand off from it.
  double apart;
  bool has_proof;
  std::function<void(LimitWorld&, Random&)> add;
};

/// One limit of a square of 10 m at the origin that looks up, seen from 60 m at most.
struct LimitSample {
  Limit limit;
  std::function<void(LimitWorld&)> add;                              ///< the limit alone
  std::function<void(LimitWorld&)> add_needed = [](LimitWorld&) {};  ///< what it makes no sense without
  Vec3 kept, broken;                                                 ///< positions that see the square
  std::vector<std::string> outside_of;                               ///< what is told of `broken`
  std::string text;   ///< what a mission has for both: keys of `sensor` or `navigation`
  bool is_flat;       ///< its surfaces are, and so it is cut where it is
  bool is_refuted;    ///< a volume that is not cut to it is; one that is cut is proved
  bool bounds_outer;  ///< an outer volume is cut to it
  /// The limit with a number that no limit has; the same in a mission, where it can say so.
  std::function<void(LimitWorld&)> add_wrong;
  ErrorCode wrong_code;
  std::string wrong_text;
  std::vector<LimitDraw> draws;
};

/// All, in the order of Limit.
const std::vector<LimitSample>& limit_samples();
inline bool is_of_navigation(Limit limit) { return limit < Limit::min_range; }

/// The square with a block to the east, without a limit but the range.
LimitWorld world_of_samples();
LimitWorld world_of(const LimitSample& sample);
/// The same as a mission, whose scene is "scene.obj". Files that it names are written into the folder.
std::string mission_text_of(const LimitSample& sample, const std::filesystem::path& folder);
/// With `wrong_text`.
std::string wrong_mission_text_of(const LimitSample& sample);
std::string mission_text_without_limit();

// ---- what a test does with the value of any limit ----

Mesh moved(Mesh mesh, const Motion& motion);
Navigation moved(const Navigation& navigation, const Motion& motion);
Sensor moved(const Sensor& sensor, const Motion& motion);
LimitWorld moved(const LimitWorld& world, const Motion& motion);

/// Changes the triangle soups that limits are measured from.
void change_soups(Navigation& navigation, const std::function<Mesh(const Mesh&)>& change);

/// The numbers that a mission says.
void expect_same_limits(const Navigation& found, const Navigation& expected);
void expect_same_limits(const Sensor& found, const Sensor& expected);

}  // namespace vantage::testing
