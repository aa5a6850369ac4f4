#include "picture/occlusion_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>

namespace vantage::internal::picture {
namespace {

constexpr int kAzimuths = 24;
constexpr std::size_t kSamples = 240;   // of the volume
constexpr double kTargetWeight = 3;     // over the whole volume's
constexpr double kDetourWeight = 0.15;  // of standing opposite to the preferred place
constexpr int kMostHits = 64;           // along one ray
constexpr double kStart = 0.05;         // metres: what a point lies on does not hide it

}  // namespace

struct OcclusionRays::Rays {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  ~Rays() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

OcclusionRays::OcclusionRays(const Mesh& mesh, const Vec3& origin, const core::ProgressReporter& progress)
    : rays_(std::make_unique<Rays>()), origin_(origin) {
  RTCGeometry geometry = rtcNewGeometry(rays_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  3 * sizeof(float), std::max<std::size_t>(mesh.vertices.size(), 1)));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned),
                                                                 std::max<std::size_t>(mesh.triangles.size(), 1)));
  if (vertices == nullptr || indices == nullptr) throw std::bad_alloc();
  for (const Vec3& vertex : mesh.vertices) {
    progress.tick();
    for (const double coordinate : Vec3(vertex - origin)) *vertices++ = static_cast<float>(coordinate);
  }
  for (const Triangle& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
  if (mesh.triangles.empty()) std::fill(indices, indices + 3, 0U);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(rays_->scene, geometry);
  rtcReleaseGeometry(geometry);
  core::ProgressBridge bridge(progress);
  rtcSetSceneProgressMonitorFunction(rays_->scene, core::ProgressBridge::ask, &bridge);
  rtcCommitScene(rays_->scene);
  rtcSetSceneProgressMonitorFunction(rays_->scene, nullptr, nullptr);
  bridge.rethrow();
}

OcclusionRays::~OcclusionRays() = default;

void OcclusionRays::each_hit(const Vec3& point, const Vec3& towards, bool to_infinity,
                             const std::function<bool(std::uint32_t)>& visit) const {
  const double length = towards.norm();
  const Eigen::Vector3f from = (point - origin_).cast<float>(), along = (towards / length).cast<float>();
  float start = static_cast<float>(kStart);
  for (int hit = 0; hit < kMostHits; ++hit) {
    RTCRayHit query{};
    query.ray = {
        from.x(),  from.y(),  from.z(),
        start,     along.x(), along.y(),
        along.z(), 0,         to_infinity ? std::numeric_limits<float>::infinity() : static_cast<float>(length),
        ~0U,       0,         0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(rays_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || !visit(query.hit.primID)) return;
    start = query.ray.tfar + static_cast<float>(1e-3) * std::max(1.0F, 0.01F * query.ray.tfar);
  }
}

double best_azimuth(const OcclusionRays& occlusion_rays, const PictureExtent& extent, const std::vector<Vec3>& target,
                    double elevation_deg, double preferred, const core::ProgressReporter& progress) {
  std::vector<Vec3> samples;
  const std::size_t stride = std::max<std::size_t>(1, extent.points.size() / kSamples);
  for (std::size_t i = 0; i < extent.points.size(); i += stride) samples.push_back(extent.points[i]);

  const auto hidden_share = [&](const std::vector<Vec3>& points, const Vec3& towards) {
    double hidden = 0;
    for (const Vec3& point : points) {
      progress.check();
      bool is_hidden = false;
      occlusion_rays.each_hit(point + kStart * Vec3::UnitZ(), towards, true, [&](std::uint32_t) {
        is_hidden = true;
        return false;
      });
      hidden += is_hidden ? 1 : 0;
    }
    return points.empty() ? 0 : hidden / static_cast<double>(points.size());
  };
  double best = preferred, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kAzimuths; ++i) {
    const int turn = i % 2 == 0 ? i / 2 : -(i / 2 + 1);
    const double azimuth = preferred + 360.0 / kAzimuths * turn;
    const double a = azimuth * std::numbers::pi / 180, e = elevation_deg * std::numbers::pi / 180;
    const Vec3 towards(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
    const double cost = kTargetWeight * hidden_share(target, towards) + hidden_share(samples, towards) +
                        kDetourWeight * std::abs(turn) / (kAzimuths / 2.0);
    if (cost >= least - 1e-9) continue;
    least = cost;
    best = azimuth;
  }
  return std::remainder(best - 180, 360) + 180;
}

}  // namespace vantage::internal::picture
