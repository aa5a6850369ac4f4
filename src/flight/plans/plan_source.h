// What all readers of plans share: the text with its name, tracks, checks and errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/error.h"
#include "vantage/flight.h"

namespace vantage::internal::flight::plans {

struct PlanSource {
  std::string_view text;
  std::string name;        ///< of the file, for messages
  std::string track;       ///< ReadPlanOptions::track
  bool was_utf16 = false;  ///< `text` is UTF-8, whatever encoding XML declares
  core::ProgressReporter progress;

  /// "a.plan: item 3".
  std::string place(const std::string& within) const { return within.empty() ? name : name + ": " + within; }
  /// `where` as place() makes it.
  [[noreturn]] static void fail_at(ErrorCode code, const std::string& where, const std::string& problem,
                                   const std::string& fix) {
    throw Error(code, problem, where, fix);
  }
  [[noreturn]] void fail(ErrorCode code, const std::string& within, const std::string& problem,
                         const std::string& fix) const {
    fail_at(code, place(within), problem, fix);
  }
};

/// Longitude and latitude, checked to be on the earth; `where` as place() makes it. Throws Error(input).
Eigen::Vector2d checked_lonlat(double longitude_deg, double latitude_deg, const std::string& where);

/// One of several tracks that a file may have.
struct PlanTrack {
  std::string name;   ///< may be empty
  std::string place;  ///< within the file: "line 12"
  std::vector<PlanItem> items;
  std::size_t segments = 1;  ///< that were apart in the file
};

/// A new item of a track, in `place` of the file. `total` counts those of all tracks. Throws Error(value_out_of_range)
/// where there are too many: before they take more memory than the file would let one expect.
PlanItem& new_item(PlanTrack& track, std::size_t& total, const std::string& place, const PlanSource& source);

/// The track that was asked for (those of that name, where several have it), or all of them, one after the other, with
/// a note. Throws Error(input) where there is none of that name, or none with items.
void take_tracks(std::vector<PlanTrack> tracks, const char* one, const char* many, const PlanSource& source,
                 FlightPlan& plan);

/// Joins tracks from `first` on that were one: cut at the antimeridian, where one ends and the next one begins.
void join_at_antimeridian(std::vector<PlanTrack>& tracks, std::size_t first);

/// "2 surveys, 1 point" of what was counted, the names as they are.
std::string counted(const std::map<std::string, std::size_t>& counts);

/// Names what is not judged, each place once, however often jumps come to it: the first twenty, and how many more.
class NotJudged {
 public:
  NotJudged(const std::string& file, std::vector<std::string>& texts) : file_(file), texts_(texts) {}
  void name(const std::string& place, const std::string& why);

 private:
  const std::string& file_;
  std::vector<std::string>& texts_;
  std::set<std::string> places_;
};

/// Throws Error(value_out_of_range) for more items than are followed.
void check_count(std::size_t items, const PlanSource& source);

/// Throws Error(input) for a plan without positions or with too many items, and with an item's place for numbers that
/// are not finite or cannot be.
void check_plan(const FlightPlan& plan, const PlanSource& source);

// ---- the formats ----

/// A plan of QGroundControl, or GeoJSON: told by its members.
FlightPlan read_json(const PlanSource& source);
FlightPlan read_waypoints(const PlanSource& source);
/// KML, or WPML: told by the names of its elements.
FlightPlan read_kml(const PlanSource& source);
FlightPlan read_gpx(const PlanSource& source);
FlightPlan read_csv(const PlanSource& source);

}  // namespace vantage::internal::flight::plans
