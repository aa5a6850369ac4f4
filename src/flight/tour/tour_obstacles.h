// Ways round obstacles, and courses that keep clear of them.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/tour_course.h"
#include "flight/tour/tour_random.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// How long a way is looked for. `little`: when time is over; what is not near at hand is not found then.
enum class Effort { full, little };

/// A way of bends from one allowed place to another, each leg of it allowed: over what stands there, or round it. Bends
/// are drawn about the straight way, in a space that grows; of the graph of their neighbours the shortest way is taken
/// whose legs are allowed, asked only as needed (R. Bohlin and L. E. Kavraki, "Path planning using lazy PRM", 2000).
/// Then it is shortened. Nothing where none was found. Without the ends.
std::optional<std::vector<Vec3>> find_way(const Airspace& airspace, const Leg& leg, SplitMix64& draw,
                                          const core::ProgressReporter& progress, Effort effort = Effort::full);

/// What a course is to keep.
struct CourseLimits {
  const Regions& regions;
  const Airspace* airspace;  ///< null: everywhere

  bool allows(const Vec3& from, const Vec3& to) const { return !airspace || airspace->allows({from, to}, 0); }
};

/// Stops of this kind are bends: they serve no region and may go.
inline constexpr int kBend = -2;

struct FlownCourse {
  Course course;  ///< with bends; every leg is allowed
  std::vector<TourProblem> problems;
};

/// Moves stops to allowed places, puts bends in where legs are not allowed, leaves out what cannot be reached, and
/// shortens the rest. Home must be allowed. Ways are looked for with little effort where it `is_late`. On a call to
/// stop it throws Error(cancelled).
FlownCourse fly_clear(const Course& course, const CourseLimits& limits, SplitMix64& draw,
                      const core::ProgressReporter& progress, const std::function<bool()>& is_late);

/// Draws the bends between stops anew, keeps those that make the way shorter, and shortens the course; between two
/// stops it asks whether time is up. There must be an airspace. On a call to stop it throws Error(cancelled); all legs
/// are allowed then, too.
void draw_ways_anew(Course& course, const CourseLimits& limits, SplitMix64& draw,
                    const core::ProgressReporter& progress, const std::function<bool()>& is_over);

/// Makes one bend of two where the way gets little longer, by a thousandth in all at most: the vehicle brakes at each.
void join_bends(Course& course, const CourseLimits& limits);

/// Moves stops and bends while that shortens the way, and leaves out bends, all legs staying allowed.
void shorten(Course& course, const CourseLimits& limits);

}  // namespace vantage::internal::flight::tour
