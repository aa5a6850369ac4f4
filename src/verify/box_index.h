// A hierarchy of boxes, by Embree 3: the only file of the check that sees it. Embree works in single precision, so it
// is asked for candidates only: every box is grown by more than its rounding can amount to, and whoever asks decides on
// the candidates in double precision. A candidate too many costs time, a candidate too few cannot happen.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::verify {

/// The points x with normal · x >= offset.
struct HalfSpace {
  Vec3 normal;
  double offset;
};

class BoxIndex {
 public:
  /// Indexes boxes by their place in the list. `reach`: no coordinate of a box or of a query exceeds it; metres.
  /// Cost O(n log n). Queries are safe from many threads.
  BoxIndex(const std::vector<Box>& boxes, double reach);
  ~BoxIndex();
  BoxIndex(BoxIndex&&) noexcept;
  BoxIndex& operator=(BoxIndex&&) noexcept;

  /// Calls visit(i) for every box i that the segment may meet, in no order, until it returns true. Returns whether it
  /// did.
  template <class Visit>
  bool any_along(const Vec3& from, const Vec3& to, Visit&& visit) const {
    return any_along(from, to, visit_function<bool, Visit>(), &visit);
  }

  /// Calls visit(i) for every box i that may lie within the radius that the last call returned (at first: infinity).
  template <class Visit>
  void nearest(const Vec3& point, Visit&& visit) const {
    nearest(point, visit_function<double, Visit>(), &visit);
  }

  /// Calls visit(i) for every box i that may reach into the intersection of the half spaces, until it returns true.
  template <class Visit>
  bool any_within(const std::vector<HalfSpace>& region, Visit&& visit) const {
    return any_within(region, visit_function<bool, Visit>(), &visit);
  }

 private:
  template <class Result>
  using VisitFunction = Result (*)(void* visitor, std::uint32_t box);

  template <class Result, class Visit>
  static VisitFunction<Result> visit_function() {
    return [](void* visitor, std::uint32_t box) -> Result {
      return (*static_cast<std::remove_reference_t<Visit>*>(visitor))(box);
    };
  }

  bool any_along(const Vec3& from, const Vec3& to, VisitFunction<bool> call, void* visitor) const;
  void nearest(const Vec3& point, VisitFunction<double> call, void* visitor) const;
  bool any_within(const std::vector<HalfSpace>& region, VisitFunction<bool> call, void* visitor) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage::internal::verify
