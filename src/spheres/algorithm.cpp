#include "spheres/algorithm.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/pieces.h"
#include "core/stopwatch.h"
#include "options/spheres_options.h"
#include "spheres/numerics.h"
#include "target/lengths.h"

namespace vantage::internal::spheres {
namespace {

using solid::LabelledMesh;
using solid::Solid;

/// Spheres of this many facets in all are made before their pairs are looked at: enough for a renderer to overlap its
/// work, and few enough to hold them all.
constexpr std::size_t kBatchFacets = 4'000'000;

/// A mesh without what is only rounding, and what it is made of.
struct Shape {
  LabelledMesh labelled;
  std::vector<long> component_euler;
  long euler = 0;
  double volume_m3 = 0;

  bool empty() const { return component_euler.empty(); }
  bool is_topological_sphere() const { return component_euler.size() == 1 && euler == 2; }
};

Shape shape_of(LabelledMesh labelled, double thickness_m) {
  Shape shape;
  shape.labelled = std::move(labelled);
  core::drop_slivers(shape.labelled, thickness_m);
  for (const core::Piece& piece : core::find_pieces(shape.labelled.mesh).pieces) {
    shape.component_euler.push_back(piece.euler);
    shape.euler += piece.euler;
    shape.volume_m3 += piece.volume_m3;
  }
  return shape;
}

Shape shape_of(const Solid& solid) { return shape_of(solid.to_mesh(), numerics::kSliverEpsilons * solid.epsilon()); }

class Run {
 public:
  Run(const TargetFrame& frame, const SphereMaker& maker, const SpheresOptions& options, SpheresReport& report,
      const StageSink& stages, const core::ProgressReporter& progress)
      : frame_(frame), maker_(maker), options_(options), report_(report), stages_(stages), progress_(progress) {}

  Intersection run() {
    for (const auto& corner : frame_.polygon) points_.push_back({{corner.x(), corner.y(), 0}, {}, 0, false});
    const auto corners = static_cast<std::uint32_t>(points_.size());
    make_spheres_of_corners();
    if (result_.blocked) return std::move(result_);
    if (corners == 1) {
      take_in(0);
    } else {
      for (std::uint32_t i = corners; i-- > 0;) push({i, (i + 1) % corners, 0});
    }
    while (!pending_.empty() && !is_empty_) take_batch();
    finish();
    return std::move(result_);
  }

 private:
  struct Point {
    Vec3 place;
    std::optional<Solid> sphere;
    int users;      // edges that wait and end here
    bool is_taken;  // in the partial result
  };
  struct Edge {
    std::uint32_t from, to;
    int halved;
  };

  void make_spheres_of_corners() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < points_.size(); ++i) all.push_back(i);
    make_spheres(all);
  }

  void make_spheres(const std::vector<std::uint32_t>& which) {
    if (which.empty()) return;
    std::vector<Vec3> places;
    for (const std::uint32_t i : which) places.push_back(points_[i].place);
    progress_.begin("making spheres");
    core::Stopwatch stopwatch;
    maker_.make(places, [&](std::size_t k, Sphere sphere) {
      report_.render_seconds += stopwatch.lap();
      progress_.report(k, places.size());
      take_sphere(which[k], std::move(sphere));
      stopwatch.lap();  // taking it is not rendering
    });
  }

  void take_sphere(std::uint32_t point, Sphere sphere) {
    ++report_.spheres;
    // A range of that size ends the view by itself; a coarse grid has no vertex straight above.
    const double near = target::hand_breadth(maker_.range_m());
    const bool sees_nothing = maker_.range_m() > 2 * near && sphere.reach_m < near;
    if (sees_nothing && !result_.blocked) result_.blocked = points_[point].place;
    if (result_.blocked) return;
    const core::Stopwatch stopwatch;
    points_[point].sphere.emplace(sphere.mesh, "a visibility sphere");
    report_.boolean_seconds += stopwatch.seconds();
    if (!stages_) return;
    const Shape shape = shape_of(std::move(sphere.mesh), 0);
    tell(SphereStage::Kind::sphere, "sphere " + std::to_string(point), {point}, &shape, sphere.seconds);
  }

  /// For a step of a stage whose steps are counted: only asked whether to go on.
  core::ProgressReporter still() const { return progress_.part(0, 0); }

  void push(const Edge& edge) {
    pending_.push_back(edge);
    ++points_[edge.from].users;
    ++points_[edge.to].users;
  }

  // The last edges first, so that few spheres wait at any time however often edges are halved.
  void take_batch() {
    const std::size_t facets = std::max<std::size_t>(1, options::facet_count(options_));
    const std::size_t most = std::max<std::size_t>(1, kBatchFacets / facets);
    std::vector<Edge> batch;
    std::vector<std::uint32_t> missing;
    while (!pending_.empty() && batch.size() < most) {
      batch.push_back(pending_.back());
      pending_.pop_back();
      for (const std::uint32_t end : {batch.back().from, batch.back().to}) {
        const bool is_known = points_[end].sphere || std::find(missing.begin(), missing.end(), end) != missing.end();
        if (!is_known) missing.push_back(end);
      }
    }
    make_spheres(missing);
    if (result_.blocked) is_empty_ = true;
    std::vector<Edge> halves;
    progress_.begin("intersecting spheres");
    for (const Edge& edge : batch) {
      if (is_empty_) return;
      progress_.report(edges_, edges_ + batch.size() + pending_.size());
      ++edges_;
      take_edge(edge, halves);
    }
    for (auto half = halves.rbegin(); half != halves.rend(); ++half) push(*half);
    for (const Edge& edge : batch)
      for (const std::uint32_t end : {edge.from, edge.to}) release(end);
  }

  void release(std::uint32_t point) {
    Point& p = points_[point];
    if (--p.users == 0 && p.is_taken) p.sphere.reset();
  }

  bool may_halve(const Edge& edge) const {
    const double length = (points_[edge.from].place - points_[edge.to].place).norm();
    return edge.halved < options_.max_splits && 0.5 * length >= options_.min_edge_m;
  }

  // What it would tell must matter to someone.
  bool must_test() const {
    return stages_ || (options_.split == SpheresOptions::Split::euler && options_.max_splits > 0);
  }

  void take_edge(const Edge& edge, std::vector<Edge>& halves) {
    bool is_sphere = options_.split == SpheresOptions::Split::euler;
    std::optional<Solid> pair;
    if (must_test()) {
      const core::Stopwatch stopwatch;
      pair = solid::intersect(*points_[edge.from].sphere, *points_[edge.to].sphere, still());
      const Shape shape = shape_of(*pair);
      const double seconds = stopwatch.seconds();
      report_.boolean_seconds += seconds;
      ++report_.pairs;
      tell(SphereStage::Kind::pair, "pair " + name_of(edge), {edge.from, edge.to}, &shape, seconds);
      if (shape.empty()) {
        result_.unseen = {points_[edge.from].place, points_[edge.to].place};
        is_empty_ = true;
        return;
      }
      if (options_.split == SpheresOptions::Split::euler) is_sphere = shape.is_topological_sphere();
      if (!shape.is_topological_sphere() && !may_halve(edge)) ++report_.unresolved_pairs;
    }
    if (!is_sphere && may_halve(edge)) {
      halve(edge, halves);
    } else {
      accept(edge, std::move(pair));
    }
  }

  void halve(const Edge& edge, std::vector<Edge>& halves) {
    const auto middle = static_cast<std::uint32_t>(points_.size());
    points_.push_back({0.5 * (points_[edge.from].place + points_[edge.to].place), {}, 0, false});
    ++report_.splits;
    halves.push_back({edge.from, middle, edge.halved + 1});
    halves.push_back({middle, edge.to, edge.halved + 1});
    tell(SphereStage::Kind::split, "split " + name_of(edge), {edge.from, edge.to, middle}, nullptr, 0);
  }

  /// The intersection with the pair's solid is that with the spheres of its ends; those that are in it already would
  /// only lay surface on surface.
  void accept(const Edge& edge, std::optional<Solid> pair) {
    if (!partial_ && waiting_.empty() && pair) {
      partial_ = std::move(pair);
      points_[edge.from].is_taken = points_[edge.to].is_taken = true;
      tell_partial(0);
      return;
    }
    take_in(edge.from);
    take_in(edge.to);
  }

  void take_in(std::uint32_t point) {
    if (points_[point].is_taken) return;
    points_[point].is_taken = true;
    waiting_.push_back(*points_[point].sphere);
    last_ = point;
    constexpr std::size_t kFew = 8;
    if (stages_ || waiting_.size() >= kFew) intersect_waiting();
  }

  void intersect_waiting() {
    if (waiting_.empty()) return;
    const core::Stopwatch stopwatch;
    if (partial_) waiting_.insert(waiting_.begin(), *partial_);
    partial_ = waiting_.size() == 1 ? waiting_.front() : solid::intersect(waiting_, still());
    waiting_.clear();
    const double seconds = stopwatch.seconds();
    report_.boolean_seconds += seconds;
    if (partial_->empty()) {
      is_empty_ = true;
      result_.unseen = {points_[last_].place, points_[last_].place};
    }
    tell_partial(seconds);
  }

  void finish() {
    if (!is_empty_) intersect_waiting();
    if (is_empty_) return;
    const core::Stopwatch stopwatch;
    Shape shape = shape_of(*partial_);
    if (shape.empty()) result_.unseen = {points_[last_].place, points_[last_].place};
    const double seconds = stopwatch.seconds();
    report_.boolean_seconds += seconds;
    tell(SphereStage::Kind::result, "result", {}, &shape, seconds);
    result_.mesh = std::move(shape.labelled);
  }

  std::string name_of(const Edge& edge) const { return std::to_string(edge.from) + "-" + std::to_string(edge.to); }

  void tell_partial(double seconds) {
    if (!stages_) return;
    const Shape shape = shape_of(*partial_);
    tell(SphereStage::Kind::partial, "partial " + std::to_string(partials_++), {}, &shape, seconds);
  }

  void tell(SphereStage::Kind kind, std::string name, const std::vector<std::uint32_t>& points, const Shape* shape,
            double seconds) const {
    if (!stages_) return;
    SphereStage stage;
    stage.kind = kind;
    stage.name = std::move(name);
    for (const std::uint32_t p : points) stage.points.push_back(frame_.to_scene(points_[p].place));
    Mesh mesh;
    if (shape) {
      mesh = shape->labelled.mesh;
      for (Vec3& v : mesh.vertices) v = frame_.to_scene(v);
      stage.mesh = &mesh;
      stage.euler = shape->euler;
      stage.component_euler = shape->component_euler;
      stage.volume_m3 = shape->volume_m3;
    }
    stage.seconds = seconds;
    stages_(stage);
  }

  const TargetFrame& frame_;
  const SphereMaker& maker_;
  const SpheresOptions& options_;
  SpheresReport& report_;
  const StageSink& stages_;
  const core::ProgressReporter& progress_;

  std::vector<Point> points_;
  std::vector<Edge> pending_;
  std::vector<Solid> waiting_;  // spheres to be intersected with the partial result
  std::optional<Solid> partial_;
  std::uint32_t last_ = 0;  // the last point that was taken in
  bool is_empty_ = false;
  int partials_ = 0;
  std::size_t edges_ = 0;  // looked at
  Intersection result_;
};

}  // namespace

Intersection intersect_spheres(const TargetFrame& frame, const SphereMaker& maker, const SpheresOptions& options,
                               SpheresReport& report, const StageSink& stages, const core::ProgressReporter& progress) {
  return Run(frame, maker, options, report, stages, progress).run();
}

}  // namespace vantage::internal::spheres
