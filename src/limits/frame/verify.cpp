// Whether the camera can have all of the target in one picture, by a search over its orientations.
#include <Eigen/Geometry>
#include <vector>

#include "verify/sensor_probe.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

class FrameProbe : public SensorProbe {
 public:
  FrameProbe(const Pinhole& camera, const Mount& mount, const std::vector<TargetView>& parts)
      : parts_(parts),
        is_fixed_(mount.is_fixed()),
        mounted_(camera, mount),
        free_(camera, {.yaw_deg = {}, .roll_deg = mount.roll_deg}) {
    Vec3 sum = Vec3::Zero();
    std::size_t count = 0;
    for (const TargetView& part : parts) {
      for (const Vec3& vertex : part.vertices()) sum += vertex - in_frame_of(part, Vec3::Zero(), parts);
      count += part.vertices().size();
    }
    middle_ = sum / static_cast<double>(count);
  }

  /// What lies nearer to the target, and to all sides, must keep it too where facets may be the reason that the point
  /// is not claimed.
  SensorJudgement judge(const Vec3& position, Judged as) const override {
    if (is_fixed_ || as == Judged::claimed) return judge(position);
    const Vec3 nearer = kFrameLoose * (middle_ - position);
    const Vec3 beside = nearer.norm() * nearer.unitOrthogonal(), above = nearer.cross(beside) / nearer.norm();
    for (const Vec3& move : {nearer, beside, above, Vec3(-beside), Vec3(-above)}) {
      SensorJudgement judgement = judge(position + move);
      if (judgement.finding != Finding::kept) return judgement;
    }
    return {};
  }

 private:
  SensorJudgement judge(const Vec3& position) const {
    const std::vector<Vec3> seen = directions(position);
    const Finding finding = mounted_.search(seen).finding;
    if (finding != Finding::broken) return {finding, {}};
    const bool by_mount = free_.search(seen).finding == Finding::kept;
    return {finding, by_mount ? "gimbal" : "frame"};
  }

  std::vector<Vec3> directions(const Vec3& position) const {
    std::vector<Vec3> result;
    for (const TargetView& part : parts_) {
      const Vec3 own = in_frame_of(part, position, parts_);
      for (const Vec3& vertex : part.vertices()) {
        const Vec3 towards = vertex - own;
        if (towards.squaredNorm() > 0) result.push_back(towards.normalized());  // what touches the camera is anywhere
      }
    }
    return result;
  }

  const std::vector<TargetView>& parts_;
  Vec3 middle_;  ///< of all vertices, in the first part's frame
  bool is_fixed_;
  FrameSearch mounted_, free_;  ///< as the camera is, and as if it could look anywhere
};

}  // namespace

template <>
std::unique_ptr<const SensorProbe> probe_of<Limit::frame>(const Pinhole& camera, const Sensor& sensor,
                                                          const std::vector<TargetView>& parts) {
  return std::make_unique<FrameProbe>(camera, sensor.mount, parts);
}

}  // namespace vantage::internal::verify
