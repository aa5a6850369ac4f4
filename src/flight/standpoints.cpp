#include "vantage/standpoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "core/format.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "flight/solid_depth.h"
#include "flight/standpoint_search.h"
#include "flight/view_describer_data.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using internal::flight::PointRequest;
using internal::flight::PointSearch;
using internal::flight::SearchEnd;
using internal::flight::SolidDepth;
using internal::flight::TargetView;

constexpr std::array kKinds = {StandpointKind::deepest, StandpointKind::nearest, StandpointKind::finest_pixel,
                               StandpointKind::best_incidence, StandpointKind::farthest};

void check_options(const StandpointOptions& options) {
  const auto fail = [](const char* what, const char* where) {
    throw Error(ErrorCode::value_out_of_range, what, where, "give metres");
  };
  if (!std::isnan(options.margin_m) && !(options.margin_m >= 0 && std::isfinite(options.margin_m))) {
    fail("the margin is below 0 or not finite", "margin_m");
  }
  if (!std::isnan(options.tolerance_m) && !(options.tolerance_m > 0 && std::isfinite(options.tolerance_m))) {
    fail("the tolerance is not positive and finite", "tolerance_m");
  }
}

/// All searches in one volume.
class StandpointFinder {
 public:
  StandpointFinder(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                   const ViewDescriber& describer, const StandpointOptions& options)
      : mission_(mission),
        exact_(volume.mesh),  // before others: it checks the mesh
        solid_(volume.mesh),
        query_(prepare_views(mission, scene), mission.navigation),
        describer_(describer),
        options_(options) {}

  Standpoints find(const ProgressReporter& progress) {
    tolerance_m_ = std::isnan(options_.tolerance_m) ? std::min(0.1, solid_.size_m() / 1000) : options_.tolerance_m;
    const PointSearch deepest = search(StandpointKind::deepest, 0, progress.part(0, 1.0 / kKinds.size()));
    if (!deepest.point()) {
      result_.reason = "no position of the volume is deeper inside than rounding";
      return std::move(result_);
    }
    constexpr double kQuarter = 0.25;
    result_.margin_m = std::isnan(options_.margin_m) ? std::min(1.0, kQuarter * deepest.best()) : options_.margin_m;
    if (deepest.best() < result_.margin_m + solid_.rounding_m()) {
      result_.reason = fmt::format(
          "no position lies {:.3g} m inside the volume: the deepest that was found lies {:.3g} m inside, "
          "and none more than {:.3g} m",
          result_.margin_m, deepest.best(), bound_);
      return std::move(result_);
    }
    add(StandpointKind::deepest, deepest);
    if (std::isnan(options_.tolerance_m) && result_.margin_m > 0) {
      tolerance_m_ = std::min(tolerance_m_, result_.margin_m / 2);
    }
    for (std::size_t i = 1; i < kKinds.size(); ++i) {
      if (!is_measured(kKinds[i])) continue;
      constexpr double kShare = 1.0 / kKinds.size();
      const auto place = static_cast<double>(i);
      const PointSearch found =
          search(kKinds[i], result_.margin_m, progress.part(place * kShare, (place + 1) * kShare));
      if (found.point()) add(kKinds[i], found);
    }
    internal::flight::AskedPitches asked;
    for (const Standpoint& point : result_.found) asked.add(point.view.pitch_deg);
    if (const auto note = asked.note(mission_)) result_.notes.push_back(*note);
    return std::move(result_);
  }

 private:
  Vec3 scene_point(const Vec3& local) const { return solid_.origin() + local; }
  const TargetView& target() const { return describer_.data().target; }

  bool is_measured(StandpointKind kind) {
    const auto is_known = [&](bool known, const char* why) {
      if (!known) result_.notes.push_back(std::string(name_of(kind)) + ": " + why);
      return known;
    };
    switch (kind) {
      case StandpointKind::finest_pixel:
        return is_known(target().has_pixels(), "the mission has no camera whose pixels are known");
      case StandpointKind::best_incidence:
        return is_known(target().has_incidence(), "the target is a point that is seen from all sides");
      case StandpointKind::farthest:
        return is_known(!describer_.data().around->obstacles.empty(), "the scene is empty");
      case StandpointKind::deepest:
      case StandpointKind::nearest:
        return true;
    }
    return false;
  }

  /// The value of points about the solid's origin. Larger is better.
  internal::flight::PointValue value_of(StandpointKind kind) const {
    const TargetView& view = target();
    switch (kind) {
      case StandpointKind::nearest:
        return [&, this](const Vec3& p, double reach) { return -view.distance_m(scene_point(p), reach); };
      case StandpointKind::finest_pixel:  // so that the tolerance is a share
        return [&, this](const Vec3& p, double reach) { return -std::log(view.pixel_m(scene_point(p), reach)); };
      case StandpointKind::best_incidence:
        return [&, this](const Vec3& p, double reach) { return -view.incidence_deg(scene_point(p), reach); };
      case StandpointKind::farthest:
        return [this](const Vec3& p, double reach) {
          return describer_.data().around->obstacles.distance_m(scene_point(p)) + reach;
        };
      case StandpointKind::deepest:
        break;
    }
    return {};
  }

  static double told(StandpointKind kind, double value) {
    switch (kind) {
      case StandpointKind::nearest:
      case StandpointKind::best_incidence:
        return -value;
      case StandpointKind::finest_pixel:
        return std::exp(-value);
      case StandpointKind::deepest:
      case StandpointKind::farthest:
        break;
    }
    return value;
  }

  double tolerance_of(StandpointKind kind) const {
    constexpr double kPixelShare = 0.005, kDegrees = 0.1;
    if (kind == StandpointKind::finest_pixel) return kPixelShare;
    return kind == StandpointKind::best_incidence ? kDegrees : tolerance_m_;
  }

  PointSearch search(StandpointKind kind, double margin_m, const ProgressReporter& progress) {
    PointRequest request;
    request.value = value_of(kind);
    request.margin_m = margin_m + solid_.rounding_m();
    request.slack_m = kind == StandpointKind::deepest ? 0 : tolerance_m_;
    request.limits = {tolerance_of(kind), options_.most_boxes};
    request.least_step_m = std::max(tolerance_m_ / 100, solid_.rounding_m());
    // By the mesh as it is, and by the exact query: a mesh of spheres may claim what is hidden.
    request.is_inside = [this](const Vec3& local) {
      const std::array points = {scene_point(local)};
      return exact_.contains(points)[0] != 0 && query_.answer(points)[0].inside;
    };
    PointSearch found(solid_, std::move(request));
    const SearchEnd end = found.run(progress);
    bound_ = told(kind, end.bound);
    if (end.is_cut) {
      result_.notes.push_back(
          fmt::format("{}: the search was cut short after {} boxes; its bound is loose", name_of(kind), end.boxes));
    }
    return found;
  }

  void add(StandpointKind kind, const PointSearch& found) {
    Standpoint& point = result_.found.emplace_back();
    point.kind = kind;
    point.view = describer_.describe(scene_point(*found.point()));
    const std::array points = {point.view.position};
    point.margin_m = std::max(0.0, exact_.depths_m(points)[0] - solid_.rounding_m());
    point.value = kind == StandpointKind::deepest ? point.margin_m : told(kind, found.best());
    point.bound = bound_;
  }

  const Mission& mission_;
  SolidIndex exact_;
  SolidDepth solid_;
  ViewsQuery query_;
  const ViewDescriber& describer_;
  const StandpointOptions& options_;
  double tolerance_m_ = 0;
  double bound_ = 0;  ///< of the last search
  Standpoints result_;
};

}  // namespace

const char* name_of(StandpointKind kind) {
  switch (kind) {
    case StandpointKind::deepest:
      return "deepest";
    case StandpointKind::nearest:
      return "nearest";
    case StandpointKind::finest_pixel:
      return "finest_pixel";
    case StandpointKind::best_incidence:
      return "best_incidence";
    case StandpointKind::farthest:
      return "farthest";
  }
  return "unknown";
}

Standpoints find_standpoints(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                             const ViewDescriber& describer, const StandpointOptions& options,
                             const Progress& progress) {
  check_options(options);
  Standpoints result;
  if (volume.empty()) {
    result.reason = volume.reason.empty() ? "the volume is empty" : volume.reason;
    return result;
  }
  const ProgressReporter reporter(progress, "standpoints");
  reporter.begin("standpoints");
  internal::parallel::with_threads(
      options.threads, [&] { result = StandpointFinder(mission, volume, scene, describer, options).find(reporter); });
  reporter.finish();
  return result;
}

}  // namespace vantage
