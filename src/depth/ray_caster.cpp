#include "depth/ray_caster.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/error.h"

namespace vantage::internal::depth {
namespace {

constexpr int kPacket = 8;

/// Embree hands the context back to the filter: what follows its own part is ours.
struct CastContext {
  RTCIntersectContext embree;
  const std::vector<std::uint32_t>* polygon_of;
  std::span<const std::uint32_t> skipped;
};

/// Lets rays pass the skipped polygons.
void pass_skipped(const RTCFilterFunctionNArguments* arguments) {
  const auto* context = reinterpret_cast<const CastContext*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] != -1) continue;
    const std::uint32_t polygon = (*context->polygon_of)[RTCHitN_primID(arguments->hit, arguments->N, i)];
    if (std::binary_search(context->skipped.begin(), context->skipped.end(), polygon)) arguments->valid[i] = 0;
  }
}

void check(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return;
  const bool is_memory = code == RTC_ERROR_OUT_OF_MEMORY;
  throw Error(is_memory ? ErrorCode::out_of_memory : ErrorCode::internal_defect,
              "Embree failed with error " + std::to_string(static_cast<int>(code)),
              "indexing the scene for ray casting", "free some memory, or take a smaller scene");
}

}  // namespace

std::string ray_caster_version() { return RTC_VERSION_STRING; }

struct RayCaster::Impl {
  const SeenScene& scene;
  RTCDevice device = nullptr;
  RTCScene embree = nullptr;
  std::vector<std::uint32_t> polygon_of;  ///< per triangle
  double reach = 0;                       ///< largest coordinate of a vertex

  explicit Impl(const SeenScene& seen) : scene(seen) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (embree) rtcReleaseScene(embree);
    if (device) rtcReleaseDevice(device);
  }

  void fill_triangles(RTCGeometry geometry) {
    const PreparedScene::Data& data = scene.data();
    std::size_t triangles = 0;
    for (std::uint32_t p = 0; p < data.polygon_count(); ++p)
      triangles += std::max<std::size_t>(data.corners_of(p).size(), 2) - 2;
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), data.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles));
    check(device);
    for (const Vec3& v : data.vertices) {
      for (int a = 0; a < 3; ++a) *vertices++ = static_cast<float>(v[a]);
      reach = std::max(reach, v.cwiseAbs().maxCoeff());
    }
    polygon_of.reserve(triangles);
    for (std::uint32_t p = 0; p < data.polygon_count(); ++p) {
      const auto corners = data.corners_of(p);
      for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        *indices++ = corners[0];
        *indices++ = corners[i];
        *indices++ = corners[i + 1];
        polygon_of.push_back(p);
      }
    }
  }

  void build() {
    device = rtcNewDevice(nullptr);
    check(device);
    embree = rtcNewScene(device);
    rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_triangles(geometry);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree);
    check(device);
  }

  /// Inverse depth of a polygon along a ray of forward component 1, at single-precision depth `found`.
  double inverse_depth(std::uint32_t polygon, const Vec3& eye, const Vec3& direction, double found) const {
    const auto corners = scene.data().corners_of(polygon);
    const auto corner = [&](std::size_t i) { return Vec3(scene.data().vertices[corners[i]] - eye); };
    const Vec3 base = corner(0);
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) normal += (corner(i) - base).cross(corner(i + 1) - base);
    const double exact = normal.dot(direction) / normal.dot(base);
    // Seen edge on, the plane says little: then single precision must do.
    constexpr double kEdgeOn = 1e-2;
    return std::abs(exact * found - 1) < kEdgeOn ? exact : 1 / found;
  }
};

RayCaster::RayCaster(const SeenScene& scene) : impl_(std::make_unique<Impl>(scene)) {
  if (scene.data().polygon_count() > 0) impl_->build();
}

RayCaster::~RayCaster() = default;

double RayCaster::near_distance(const Vec3& eye) const {
  // So many roundings of a coordinate that the angle under which a border is off is far below a texel's.
  constexpr double kRoundings = 4096;
  return kRoundings * std::numeric_limits<float>::epsilon() * std::max(impl_->reach, eye.cwiseAbs().maxCoeff());
}

void RayCaster::cast(const FaceBand& band, const Vec3& eye, double range, std::span<const std::uint32_t> skipped,
                     std::span<float> inverse_depths) const {
  if (!impl_->embree) return;
  CastContext context{{}, &impl_->polygon_of, skipped};
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if (!skipped.empty()) context.embree.filter = pass_skipped;
  const CubeFace& axes = cube_faces()[band.face];
  for (int row = band.row_begin; row < band.row_end; ++row) {
    float* texels = inverse_depths.data() + static_cast<std::size_t>(row - band.row_begin) * band.size;
    const Vec3 middle = axes.forward + band.centre(row) * axes.up;
    for (int first = 0; first < band.size; first += kPacket) {
      const int count = std::min(kPacket, band.size - first);
      alignas(32) int valid[kPacket];
      RTCRayHit8 packet{};
      Vec3 directions[kPacket];
      for (int i = 0; i < kPacket; ++i) {
        valid[i] = i < count ? -1 : 0;
        directions[i] = middle + band.centre(first + i) * axes.right;
        packet.ray.org_x[i] = static_cast<float>(eye.x());
        packet.ray.org_y[i] = static_cast<float>(eye.y());
        packet.ray.org_z[i] = static_cast<float>(eye.z());
        packet.ray.dir_x[i] = static_cast<float>(directions[i].x());
        packet.ray.dir_y[i] = static_cast<float>(directions[i].y());
        packet.ray.dir_z[i] = static_cast<float>(directions[i].z());
        packet.ray.tfar[i] = static_cast<float>(range);  // directions are at least 1 long
        packet.ray.mask[i] = ~0U;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, impl_->embree, &context.embree, &packet);
      for (int i = 0; i < count; ++i) {
        if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID || !(packet.ray.tfar[i] > 0)) continue;
        const std::uint32_t polygon = impl_->polygon_of[packet.hit.primID[i]];
        const double q = impl_->inverse_depth(polygon, eye, directions[i], packet.ray.tfar[i]);
        texels[first + i] = std::max(texels[first + i], static_cast<float>(q));
      }
    }
  }
}

}  // namespace vantage::internal::depth
