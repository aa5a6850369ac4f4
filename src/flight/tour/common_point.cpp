#include "flight/tour/common_point.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "flight/box_search.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kNowhere = -std::numeric_limits<double>::infinity();

Vec3 vector_of(const std::array<double, 3>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

/// Solids about the origin of the first one.
class CommonDepth {
 public:
  explicit CommonDepth(std::span<const SolidDepth* const> solids) {
    for (const SolidDepth* solid : solids) {
      parts_.push_back({solid, solids[0]->origin() - solid->origin()});
      rounding_m_ = std::max(rounding_m_, 2 * solid->rounding_m());
    }
  }

  const Vec3& origin() const { return parts_[0].solid->origin(); }
  double rounding_m() const { return rounding_m_; }

  /// That holds all points that are in all solids, or no farther than `within_m` from each. May be empty.
  Box bounds(double within_m) const {
    Box all;
    for (const Part& part : parts_) {
      const Vec3 more = Vec3::Constant(within_m + rounding_m_);
      const Vec3 low = part.solid->bounds().min - part.shift - more,
                 high = part.solid->bounds().max - part.shift + more;
      all = &part == parts_.data() ? Box{low, high} : Box{all.min.cwiseMax(low), all.max.cwiseMin(high)};
    }
    return all;
  }

  /// No point of the box lies deeper in all solids; minus infinity where that is less than `needed`. `middle_m` becomes
  /// no more than the depth of the middle, where there is a bound.
  double box_bound(const Vec3& middle, const Vec3& half, double needed, double& middle_m) const {
    double bound = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) {
      bound = std::min(bound, part.solid->box_at_most_m(middle + part.shift, half));
      if (bound < needed) return kNowhere;
    }
    middle_m = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) {
      const SolidDepth::Bounded depth = part.solid->bounded_m(middle + part.shift, half);
      bound = std::min(bound, depth.bound_m);
      middle_m = std::min(middle_m, depth.depth_m);
      if (bound < needed) return kNowhere;
    }
    return bound;
  }

  double depth_m(const Vec3& point) const {
    double depth = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) depth = std::min(depth, part.solid->depth_m(point + part.shift));
    return depth;
  }

 private:
  struct Part {
    const SolidDepth* solid;
    Vec3 shift;
  };
  std::vector<Part> parts_;
  double rounding_m_ = 0;
};

SearchBox<3> root_of(const Box& bounds) {
  SearchBox<3> root;
  const double longest = (bounds.max - bounds.min).maxCoeff();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    root.middle[a] = (bounds.min[axis] + bounds.max[axis]) / 2;
    root.half[a] = (bounds.max[axis] - bounds.min[axis]) / 2;
    root.weight[a] = flatness(root.half[a], longest / 2);
  }
  return root;
}

class DeepestSearch {
 public:
  DeepestSearch(const CommonDepth& depth, const CommonRequest& request)
      : depth_(depth), request_(request), needed_m_(request.least_m + depth.rounding_m()) {}

  /// For search_box: a box must promise more than this. So points near the deepest one are good enough.
  double best() const { return found_.point ? found_.depth_m / request_.share : kNowhere; }

  double bound_of(const SearchBox<3>& box) {
    const Vec3 middle = vector_of(box.middle), half = vector_of(box.half);
    double at_middle = 0;
    const double bound = depth_.box_bound(middle, half, needed_m_, at_middle);
    if (!(bound > best())) return kNowhere;
    take(middle);
    return half.norm() > request_.finest_m ? bound : kNowhere;
  }

  const CommonPoint& found() const { return found_; }

 private:
  void take(const Vec3& point) {
    const double depth = depth_.depth_m(point);
    if (depth < needed_m_ || (found_.point && depth <= found_.depth_m)) return;
    const Vec3 place = depth_.origin() + point;
    if (request_.is_allowed && !request_.is_allowed(place)) return;
    found_ = {place, depth - depth_.rounding_m()};
  }

  const CommonDepth& depth_;
  const CommonRequest& request_;
  double needed_m_;
  CommonPoint found_;
};

/// Ends with the first point that is near enough to all.
class ApartSearch {
 public:
  ApartSearch(const CommonDepth& depth, double within_m) : depth_(depth), least_m_(-within_m - depth.rounding_m()) {}

  double best() const { return do_meet_ ? std::numeric_limits<double>::infinity() : kNowhere; }

  double bound_of(const SearchBox<3>& box) {
    if (do_meet_) return kNowhere;
    double at_middle = 0;
    const double bound = depth_.box_bound(vector_of(box.middle), vector_of(box.half), least_m_, at_middle);
    do_meet_ = bound > kNowhere && at_middle >= least_m_;
    return bound;
  }

  bool do_meet() const { return do_meet_; }

 private:
  const CommonDepth& depth_;
  double least_m_;
  bool do_meet_ = false;
};

}  // namespace

CommonPoint deepest_common_point(std::span<const SolidDepth* const> solids, const CommonRequest& request,
                                 const core::ProgressReporter& progress) {
  const CommonDepth depth(solids);
  const Box bounds = depth.bounds(0);
  if (bounds.empty()) return {};
  DeepestSearch search(depth, request);
  const SearchLimits limits{request.least_m / 100, request.most_boxes};
  // It asks whether to go on; how far a search is says nothing of the whole.
  search_box(search, root_of(bounds), limits, progress.part(0, 0));
  return search.found();
}

bool are_surely_apart(std::span<const SolidDepth* const> solids, double within_m, std::size_t most_boxes,
                      const core::ProgressReporter& progress) {
  const CommonDepth depth(solids);
  const Box bounds = depth.bounds(within_m);
  if (bounds.empty()) return true;
  ApartSearch search(depth, within_m);
  const SearchEnd end = search_box(search, root_of(bounds), {0, most_boxes}, progress.part(0, 0));
  return !search.do_meet() && !end.is_cut;
}

}  // namespace vantage::internal::flight::tour
