#include "verify/sensor_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "vantage/error.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

class ProbeOfParts : public SensorProbe {
 public:
  using Breaks = std::function<bool(const TargetView& part, const Vec3& own, Judged as)>;

  ProbeOfParts(std::string limit, const std::vector<TargetView>& parts, Breaks breaks)
      : limit_(std::move(limit)), parts_(parts), breaks_(std::move(breaks)) {}

  SensorJudgement judge(const Vec3& position, Judged as) const override {
    for (const TargetView& part : parts_) {
      if (breaks_(part, in_frame_of(part, position, parts_), as)) return {Finding::broken, limit_};
    }
    return {};
  }

 private:
  std::string limit_;
  const std::vector<TargetView>& parts_;
  Breaks breaks_;
};

void check_link(const Sensor& sensor, const std::vector<TargetView>& parts) {
  if (!sensor.link || parts.front().is_point()) return;
  throw Error(ErrorCode::not_applicable, "a radio link ends in an antenna, and the target is no point", "sensor.link",
              "give the antenna's place as a target of one point, or leave out the link");
}

}  // namespace

std::unique_ptr<const SensorProbe> probe_of_parts(const std::string& limit, const std::vector<TargetView>& parts,
                                                  ProbeOfParts::Breaks breaks) {
  return std::make_unique<ProbeOfParts>(limit, parts, std::move(breaks));
}

void check_has_plane(const std::vector<TargetView>& parts, const std::string& limit) {
  if (!parts.front().all_sides()) return;
  throw Error(ErrorCode::direction_invalid, "a point without a front has no plane, which the limit is about", limit,
              "give the target a front");
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

double with_tangent_times(double angle, double factor) {
  return angle < std::numbers::pi / 2 ? std::atan(std::tan(angle) * factor) : angle;
}

SensorJudge::SensorJudge(const Sensor& sensor, const std::vector<TargetView>& parts, double tolerance_m)
    : parts_(parts) {
  check_sensor(sensor);
  check_link(sensor, parts);
  const double infinity = std::numeric_limits<double>::infinity();
  const double pixel_range = sensor.pixel ? sensor.pixel->size_m * *sensor.camera->focal_px : infinity;
  range_ = std::min(sensor.max_range_m, pixel_range);
  // A foreshortened pixel is judged by itself; else its range is one.
  const bool is_slanted = sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::worst;
  const double range_m = is_slanted ? sensor.max_range_m : range_;
  claimed_range_ = range_m * (1 + kRangeSlack);
  unclaimed_range_ = range_m - tolerance_m;
  std::unique_ptr<const SensorProbe> searched;
  each_limit(sensor, [&](auto limit, const auto& value) {
    constexpr Limit kLimit = decltype(limit)::value;
    auto probe = probe_of<kLimit>(value, sensor, parts);
    if (kLimit == Limit::frame) {
      searched = std::move(probe);
    } else {
      probes_.push_back(std::move(probe));
    }
  });
  if (searched) probes_.push_back(std::move(searched));
}

bool SensorJudge::is_too_far(const Vec3& position, Judged as) const {
  const double most = as == Judged::claimed ? claimed_range_ : unclaimed_range_;
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const TargetView& part) { return part.farthest(in_frame_of(part, position, parts_)) > most; });
}

SensorJudgement SensorJudge::judge(const Vec3& position, Judged as) const {
  if (is_too_far(position, as)) return {Finding::broken, "max_range"};
  for (const auto& probe : probes_) {
    SensorJudgement judgement = probe->judge(position, as);
    if (judgement.finding != Finding::kept) return judgement;
  }
  return {};
}

}  // namespace vantage::internal::verify
