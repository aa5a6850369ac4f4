// All that the attack does with limits, each of which has a file of its own in limits/. What treats every limit walks
// over them here: one that is added does not link before its file has all of this, by its definition alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "case.h"
#include "draw.h"
#include "mesh_case.h"
#include "random.h"
#include "seen_target.h"
#include "vantage/each_limit.h"
#include "vantage/mission.h"

namespace attack {

using vantage::Limit;
using vantage::LimitIs;
using vantage::LimitValueOf;

// ---- walks ----

/// The others are of the sensor.
constexpr bool is_of_navigation(Limit limit) { return limit < Limit::min_range; }

template <Limit kLimit>
concept IsLimit = requires {
  typename vantage::LimitValue<kLimit>::type;
};

/// Calls `visit(LimitIs<...>)` for every limit, given or not: first these, so that seeds draw what they drew before,
/// then all others in the order of Limit.
template <Limit... kFirst, typename Visit>
void every_limit(const Visit& visit) {
  (visit(LimitIs<kFirst>{}), ...);
  const auto visit_all = [&]<int kNext>(const auto& self, std::integral_constant<int, kNext>) -> void {
    constexpr Limit kLimit = static_cast<Limit>(kNext);
    if constexpr (IsLimit<kLimit>) {
      if constexpr (((kLimit != kFirst) && ...)) visit(LimitIs<kLimit>{});
      self(self, std::integral_constant<int, kNext + 1>{});
    }
  };
  visit_all(visit_all, std::integral_constant<int, 0>{});
}

template <Limit... kFirst, typename Visit>
void every_navigation_limit(const Visit& visit) {
  every_limit<kFirst...>([&](auto limit) {
    if constexpr (is_of_navigation(limit)) visit(limit);
  });
}

template <Limit... kFirst, typename Visit>
void every_sensor_limit(const Visit& visit) {
  every_limit<kFirst...>([&](auto limit) {
    if constexpr (!is_of_navigation(limit)) visit(limit);
  });
}

/// The limit, where it is given.
template <Limit kLimit>
const LimitValueOf<kLimit>* given(const vantage::Navigation& navigation, const vantage::Sensor& sensor) {
  const LimitValueOf<kLimit>* found = nullptr;
  const auto look = [&](auto limit, const auto& value) {
    if constexpr (limit == kLimit) found = &value;
  };
  if constexpr (is_of_navigation(kLimit)) {
    each_limit(navigation, look);
  } else {
    each_limit(sensor, look);
  }
  return found;
}

// ---- what a limit is called, and how it is cut ----

/// One way to draw a limit for a mesh that is claimed to keep it.
struct ClaimWay {
  int number;        ///< among all ways, so that seeds draw what they drew before: a new one comes last
  const char* name;  ///< in MeshCase::kind
  void (*draw)(Random&, MeshCase&);
};

struct LimitFacts {
  const char* claim;               ///< in proofs and certificates
  std::vector<std::string> names;  ///< in PointAnswer::outside_of, or how they begin
  std::vector<std::string> words;  ///< in the text of a mission that has it; to be counted
  bool is_flat;                    ///< its surfaces are, and so it is cut where it is
  std::vector<ClaimWay> ways;
};
template <Limit kLimit>
LimitFacts facts_of();

/// Of the limit whose name begins so, as PointAnswer::outside_of or a claim has it. Nothing: it is none.
std::optional<LimitFacts> facts_named(const std::string& name);

/// Whether a proof of it is right to the last digits.
template <Limit kLimit>
bool is_exact(const LimitValueOf<kLimit>& limit);

// ---- draws; a limit that is never drawn there has an empty function ----

struct CaseDraws {
  Random& random;
  const Pose& pose;
  Case& c;
};
template <Limit kLimit>
void draw_in_case(CaseDraws& draws);

/// What a flight's case has besides.
struct FlightDraws {
  Random& random;
  Case& c;
};
template <Limit kLimit>
void draw_in_flight(FlightDraws& draws);

/// Lengths are drawn as if the range were some tens of metres, and scaled.
struct MissionDraws {
  Random& random;
  double scale, range;
  vantage::Vec3 shift;
  bool has_ground;
  std::string sensor, navigation;           ///< keys of the mission's text
  std::vector<vantage::KeepInMesh> meshes;  ///< which the text cannot hold

  vantage::Vec3 placed(const vantage::Vec3& p) const { return scale * p + shift; }
  double height(double z) const { return scale * z + shift.z(); }
  std::string length(double metres) const;
  void add_navigation(const std::string& key) { navigation += (navigation.empty() ? "" : ", ") + key; }
};
template <Limit kLimit>
void draw_in_mission(MissionDraws& draws);

struct TourDraws {
  Random& random;
  double size;
  bool has_ground;
  vantage::Navigation& navigation;
  std::string mission_navigation, mission_sensor;  ///< keys of the mission's text: what is best resolved by it
};
template <Limit kLimit>
void draw_in_tour(TourDraws& draws);

// ---- places ----

/// Where a flight is likely to meet the limit. `middle`: of the target.
template <Limit kLimit>
void add_anchors(const LimitValueOf<kLimit>& limit, const vantage::Vec3& middle, std::vector<vantage::Vec3>& anchors);

struct MeshPlaces {
  Random& random;
  const MeshCase& c;
  vantage::Vec3 centre;  ///< of the target
  std::vector<vantage::Vec3>& places;

  void about(const vantage::Vec3& at, double size);
};
/// Where the limit is, which places drawn before the target rarely meet.
template <Limit kLimit>
void add_places(const LimitValueOf<kLimit>& limit, MeshPlaces& places);

// ---- the oracle ----

/// Above 0 the limit is kept by every position nearer than that, below 0 it is broken by every such one; metres. Where
/// rounding decides (at the borders of ground, seen from above) `low` and `high` differ.
struct Margin {
  std::string limit;  ///< as PointAnswer::outside_of has it
  double low = 0, high = 0;
  bool is_measured = true;   ///< it is a distance, not only of its sign; heights over ground are none
  bool is_searched = false;  ///< the engine finds the limit by a search, not by a formula
};
/// Those of one name are one.
void add_margin(std::vector<Margin>& margins, const Margin& margin);

/// In whose coordinates limits of the sensor are judged.
struct SeenBy {
  vantage::Sensor sensor;
  std::vector<SeenTarget> parts;  ///< of the target, as used
};
using AddMargins = std::function<void(const vantage::Vec3& position, std::vector<Margin>& margins)>;
/// `limit` and `by` must live as long. `by`: for limits of the sensor only; its parts' coordinates are those of
/// positions.
template <Limit kLimit>
AddMargins margins_of(const LimitValueOf<kLimit>& limit, const SeenBy& by);

// ---- changes ----

struct Placement {
  double unit;
  vantage::Vec3 shift;

  void move(vantage::Vec3& v) const { v = unit * v + shift; }
  void move(double& z) const { z = unit * z + shift.z(); }
  void move(vantage::Mesh& mesh) const;
  void move(vantage::AboveGround& above) const;
};
template <Limit kLimit>
void move(LimitValueOf<kLimit>& limit, const Placement& pose);

/// With what makes no sense without it.
template <Limit kLimit>
void leave_out(vantage::Navigation& navigation, vantage::Sensor& sensor);

// ---- texts ----

std::string exact_text(double value);
std::string exact_text(const vantage::Vec3& p);   ///< "[x, y, z]"
std::string exact_pair(double low, double high);  ///< "[low, high]"

/// Lines of a mission.
struct MissionLines {
  std::string altitude;  ///< within the braces of that key
  std::string navigation, sensor;
  vantage::Mount mount = {};  ///< of the camera

  void add_altitude(const std::string& entry) { altitude += (altitude.empty() ? "" : ", ") + entry; }
};
/// What cannot be said in the text of a mission is said in a comment.
template <Limit kLimit>
void add_text(const LimitValueOf<kLimit>& limit, MissionLines& lines);
MissionLines lines_of(const vantage::Navigation& navigation, const vantage::Sensor& sensor);

/// A mission that is written in a folder.
struct WrittenClaim {
  const MeshCase& c;
  std::filesystem::path folder;
  vantage::MissionFile& mission;               ///< has the limits of `c`
  std::optional<vantage::Ground> ground = {};  ///< that heights are measured from
  bool names_ground = false;                   ///< the scene's ground is no obstacle
};
/// Adds what the text of a mission says in another way than Navigation and Sensor.
template <Limit kLimit>
void write_beside(const LimitValueOf<kLimit>& limit, WrittenClaim& claim);

}  // namespace attack
