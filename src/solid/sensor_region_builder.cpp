#include "solid/sensor_region_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/portable_math.h"
#include "solid/convex_body.h"
#include "solid/halve_sides.h"
#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

Region sensor_region(const std::string& name, Solid solid, const std::string& explanation) {
  return {.name = name,
          .solid = std::move(solid),
          .explain =
              [explanation](const Region& region, const Remainder& left) {
                return Emptiness{"the sensor's limit '" + region.name + "' leaves nothing of " + left.text() +
                                     (explanation.empty() ? "" : "; " + explanation),
                                 "relax it, or the limits that it goes with"};
              },
          .is_cut_alone = true};
}

}  // namespace

SensorRegionBuilder::SensorRegionBuilder(const sensor::Viewed& viewed, const Sensor& sensor, const Box& bounds,
                                         Regions& regions)
    : viewed_(viewed), sensor_(sensor), regions_(&regions) {
  const Vec3 overshoot = Vec3::Constant(numerics::kOvershoot * (bounds.max - bounds.min).norm());
  box_ = {bounds.min - overshoot - viewed.origin, bounds.max + overshoot - viewed.origin};
  reach_ = std::min(range_limit_m(sensor) + viewed.radius(), box_.min.cwiseAbs().cwiseMax(box_.max.cwiseAbs()).norm());
}

SensorRegionBuilder::SensorRegionBuilder(const sensor::Viewed& viewed, const Sensor& sensor, const TargetFrame& frame,
                                         LimitsInChart& chart)
    : viewed_(viewed),
      sensor_(sensor),
      chart_(&chart),
      frame_(&frame),
      reach_(range_limit_m(sensor) + viewed.radius()) {}

std::uint32_t SensorRegionBuilder::label_in_chart(const std::string& name) {
  chart_->causes.push_back({CauseKind::sensor, name});
  return static_cast<std::uint32_t>(chart_->causes.size() - 1);
}

std::uint32_t SensorRegionBuilder::label_of(const std::string& name) {
  const auto& causes = regions_->causes;
  const auto known = std::find_if(causes.begin(), causes.end(), [&](const Cause& cause) {
    return cause.kind == CauseKind::sensor && cause.name == name;
  });
  const auto cause = static_cast<std::uint32_t>(known - causes.begin());
  if (known == causes.end()) regions_->causes.push_back({CauseKind::sensor, name});
  regions_->sources.push_back({.cause = cause});
  return static_cast<std::uint32_t>(regions_->sources.size() - 1);
}

/// Booleans look at all pairs of facets whose boxes overlap, and long narrow ones have large boxes.
Solid SensorRegionBuilder::solid_of(Mesh mesh, std::vector<std::uint32_t> labels) const {
  const double longest = numerics::kLongestSide * reach_;
  const auto length = [&](std::uint32_t a, std::uint32_t b) { return (mesh.vertices[a] - mesh.vertices[b]).norm(); };
  const auto wants = [&](const Triangle& t) {
    Box box;
    for (const std::uint32_t i : t) box.extend(mesh.vertices[i]);
    const bool is_near = (box.min.array() < box_.max.array()).all() && (box.max.array() > box_.min.array()).all();
    return is_near && std::max({length(t[0], t[1]), length(t[1], t[2]), length(t[2], t[0])}) > longest;
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  std::vector<std::uint32_t> of_triangle, relabelled;
  while (halve_sides(mesh.triangles, wants, length, middle, of_triangle)) {
    relabelled.clear();
    for (const std::uint32_t t : of_triangle) relabelled.push_back(labels[t]);
    labels.swap(relabelled);
  }
  return Solid(moved_to_origin(mesh, std::move(labels), regions_->origin - viewed_.origin), "a limit of the sensor");
}

void SensorRegionBuilder::keep(const std::string& name, Solid solid, const std::string& explanation) {
  regions_->kept.push_back(sensor_region(name, std::move(solid), explanation));
}

void SensorRegionBuilder::forbid(const std::string& name, Solid solid, const std::string& explanation) {
  regions_->forbidden.push_back(sensor_region(name, std::move(solid), explanation));
}

void SensorRegionBuilder::forbid(const std::string& name, const Mesh& convex) {
  if (!chart_) return forbid(name, solid_of(convex, name));
  exact::ChartLimits::Body body{convex, label_in_chart(name)};
  for (Vec3& vertex : body.mesh.vertices) vertex = frame_->to_local(vertex + viewed_.origin);
  chart_->limits.removed.push_back(std::move(body));
}

void SensorRegionBuilder::forbid_star(const std::string& name, const std::vector<std::string>& names,
                                      const std::function<Star(const exact::ChartLimits::Reach&)>& make) {
  std::vector<std::uint32_t> label;
  for (const std::string& of : names) label.push_back(chart_ ? label_in_chart(of) : label_of(of));
  const auto labels_of = [label](const Star& star) {
    std::vector<std::uint32_t> labels;
    for (const std::size_t of : star.name_of) labels.push_back(label[of]);
    return labels;
  };
  if (!chart_) {
    const Star star = make({});
    return forbid(name, solid_of(star.mesh, labels_of(star)), star.explanation);
  }
  chart_->limits.stars.push_back(
      [make, labels_of, frame = *frame_, origin = viewed_.origin](const exact::ChartLimits::Reach& reach) {
        const Star star = make([&](const Vec3& direction, double angle) {
          return reach({frame.axis_u.dot(direction), frame.axis_v.dot(direction), frame.normal.dot(direction)}, angle);
        });
        exact::ChartLimits::Star local{star.mesh, labels_of(star)};
        for (Vec3& vertex : local.mesh.vertices) vertex = frame.to_local(vertex + origin);
        return local;
      });
}

void SensorRegionBuilder::keep(const std::string& name, std::vector<HalfSpace> half_spaces,
                               const std::string& explanation) {
  if (chart_) {
    const std::uint32_t label = label_in_chart(name);
    const Vec3 shift = frame_->origin - viewed_.origin;
    for (const auto& [normal, at] : half_spaces) {
      const Vec3 local(frame_->axis_u.dot(normal), frame_->axis_v.dot(normal), frame_->normal.dot(normal));
      chart_->limits.kept.push_back({local, at - normal.dot(shift), label});
    }
    return;
  }
  for (HalfSpace& half_space : half_spaces) {
    const double length = half_space.normal.norm();
    half_space = {half_space.normal / length, half_space.at / length};
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    half_spaces.push_back({Vec3::Unit(axis), box_.max[axis]});
    half_spaces.push_back({-Vec3::Unit(axis), -box_.min[axis]});
  }
  // A point deep inside, so that no plane is very near to it.
  std::optional<Vec3> inside;
  for (double depth = reach_; !inside && depth > numerics::kLeastDistance * reach_; depth /= 2) {
    inside = kernel_point(half_spaces, box_, depth);
  }
  keep(name, inside ? solid_of(intersect_half_spaces(half_spaces, *inside), name) : Solid(), explanation);
}

Vec3 any_across(const Vec3& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3::Unit(least)).normalized();
}

std::vector<Vec3> ring(const Vec3& axis, int count) {
  const Vec3 u = any_across(axis), v = axis.cross(u);
  std::vector<Vec3> result;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const portable::SineCosine turn = portable::sine_cosine(angle);
    result.push_back(turn.cosine * u + turn.sine * v);
  }
  return result;
}

double most_along(const std::vector<Vec3>& corners, const Vec3& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners) most = std::max(most, corner.dot(direction));
  return most;
}

void add_sensor_regions(const sensor::Viewed& viewed, const Sensor& sensor, std::span<const Limit> done,
                        const Box& bounds, Regions& regions) {
  SensorRegionBuilder builder(viewed, sensor, bounds, regions);
  const auto is_done = [&](Limit limit) { return std::find(done.begin(), done.end(), limit) != done.end(); };
  for (const sensor::ViewedPart& part : viewed.parts) {
    each_limit(sensor, [&](auto limit, const auto& value) {
      constexpr Limit kLimit = decltype(limit)::value;
      if constexpr (kLimit != Limit::frame) {
        if (!is_done(kLimit)) add_regions<kLimit>(value, part, builder);
      }
    });
  }
  if (sensor.camera && !is_done(Limit::frame)) add_frame_region(*sensor.camera, builder);
}

bool is_cut_in_chart(Limit limit) {
  switch (limit) {
    case Limit::min_range:
    case Limit::incidence:
    case Limit::sun:
    case Limit::frame:
      return true;
    default:
      return false;
  }
}

LimitsInChart sensor_limits_in_chart(const exact::StarTarget& target, const Sensor& sensor) {
  LimitsInChart chart;
  // What is kept is kept of the convex hull, too: its corners say all. What is taken away is convex for each polygon.
  const sensor::Viewed hull = sensor::viewed_of(target.frame, {&target.frame.polygon, 1});
  const sensor::Viewed cover = sensor::viewed_of(target.frame, target.cover);
  SensorRegionBuilder builder(hull, sensor, target.frame, chart);
  each_limit(sensor, [&](auto limit, const auto& value) {
    constexpr Limit kLimit = decltype(limit)::value;
    if (!is_cut_in_chart(kLimit)) return;
    chart.done.push_back(kLimit);
    if constexpr (kLimit == Limit::frame) {
      add_frame_region(*sensor.camera, builder);
    } else {
      for (const sensor::ViewedPart& part : kLimit == Limit::incidence ? hull.parts : cover.parts) {
        add_regions<kLimit>(value, part, builder);
      }
    }
  });
  return chart;
}

}  // namespace vantage::internal::solid
