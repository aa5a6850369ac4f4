#include "verify/box_index.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <string>

#include "vantage/error.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kLeafSize = 4;

float rounded_down(double value) {
  const float near = static_cast<float>(value);
  return near > value ? std::nextafter(near, -kInfinity) : near;
}

float rounded_up(double value) {
  const float near = static_cast<float>(value);
  return near < value ? std::nextafter(near, kInfinity) : near;
}

/// A node of the hierarchy for convex regions: either two children with their bounds, or a handful of boxes.
struct Node {
  unsigned count = 0;  ///< boxes in a leaf; 0 for an inner node
  std::array<std::uint32_t, kLeafSize> boxes{};
  std::array<const Node*, 2> children{};
  std::array<RTCBounds, 2> bounds{};
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned /*children*/, void* /*user*/) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(Node), alignof(Node))) Node;
}

void set_children(void* node, void** children, unsigned count, void* /*user*/) {
  for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->children[i] = static_cast<const Node*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/) {
  for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* boxes, std::size_t count,
                  void* /*user*/) {
  Node* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Node), alignof(Node))) Node;
  leaf->count = static_cast<unsigned>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->boxes[i] = boxes[i].primID;
  return leaf;
}

void report_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto* bounds = static_cast<const RTCBounds*>(arguments->geometryUserPtr);
  *arguments->bounds_o = bounds[arguments->primID];
}

/// Embree hands the context back to the callback: what follows its own part is ours.
struct AlongContext {
  RTCIntersectContext embree;
  bool (*call)(void*, std::uint32_t);
  void* visitor;
  bool stopped;
};

void visit_along(const RTCOccludedFunctionNArguments* arguments) {
  auto* context = reinterpret_cast<AlongContext*>(arguments->context);
  if (!arguments->valid[0] || context->stopped) return;
  context->stopped = context->call(context->visitor, arguments->primID);
  if (context->stopped) RTCRayN_tfar(arguments->ray, arguments->N, 0) = -kInfinity;
}

struct NearestContext {
  double (*call)(void*, std::uint32_t);
  void* visitor;
  double growth;
};

bool visit_nearest(RTCPointQueryFunctionArguments* arguments) {
  const auto* context = static_cast<const NearestContext*>(arguments->userPtr);
  const double asked = context->call(context->visitor, arguments->primID);
  const double radius = asked * (1 + kBoxGrowth) + context->growth;
  if (!(radius < arguments->query->radius)) return false;
  arguments->query->radius = std::min(arguments->query->radius, rounded_up(radius));
  return true;
}

/// Whether the box lies wholly outside one of the half spaces.
bool outside(const RTCBounds& box, const std::vector<HalfSpace>& region) {
  return std::any_of(region.begin(), region.end(), [&box](const HalfSpace& side) {
    const Vec3& n = side.normal;
    const double farthest = n.x() * (n.x() > 0 ? box.upper_x : box.lower_x) +
                            n.y() * (n.y() > 0 ? box.upper_y : box.lower_y) +
                            n.z() * (n.z() > 0 ? box.upper_z : box.lower_z);
    return farthest < side.offset;
  });
}

bool any_below(const Node* node, const std::vector<HalfSpace>& region, bool (*call)(void*, std::uint32_t),
               void* visitor) {
  for (unsigned i = 0; i < node->count; ++i) {
    if (call(visitor, node->boxes[i])) return true;
  }
  if (node->count > 0) return false;
  for (int i = 0; i < 2; ++i) {
    if (!node->children[i] || outside(node->bounds[i], region)) continue;
    if (any_below(node->children[i], region, call, visitor)) return true;
  }
  return false;
}

}  // namespace

struct BoxIndex::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RTCBVH tree = nullptr;
  const Node* root = nullptr;
  std::vector<RTCBounds> bounds;  ///< in single precision, grown
  double growth = 0;              ///< metres; see kBoxGrowth

  ~Impl() {
    if (tree) rtcReleaseBVH(tree);
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check() const {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    const bool is_memory = code == RTC_ERROR_OUT_OF_MEMORY;
    throw Error(is_memory ? ErrorCode::out_of_memory : ErrorCode::internal_defect,
                "Embree failed with error " + std::to_string(static_cast<int>(code)),
                "building the index of the check over " + std::to_string(bounds.size()) + " triangles",
                "free some memory, or check a smaller scene");
  }

  void grow(const std::vector<Box>& boxes) {
    bounds.reserve(boxes.size());
    for (const Box& box : boxes) {
      RTCBounds out{};
      out.lower_x = rounded_down(box.min.x() - growth);
      out.lower_y = rounded_down(box.min.y() - growth);
      out.lower_z = rounded_down(box.min.z() - growth);
      out.upper_x = rounded_up(box.max.x() + growth);
      out.upper_y = rounded_up(box.max.y() + growth);
      out.upper_z = rounded_up(box.max.z() + growth);
      bounds.push_back(out);
    }
  }

  void build_scene() {
    scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(bounds.size()));
    rtcSetGeometryUserData(geometry, bounds.data());
    rtcSetGeometryBoundsFunction(geometry, report_bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry, visit_along);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    check();
  }

  void build_tree() {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(bounds.size());
    for (const RTCBounds& box : bounds) {
      const auto id = static_cast<unsigned>(primitives.size());
      primitives.push_back({box.lower_x, box.lower_y, box.lower_z, 0, box.upper_x, box.upper_y, box.upper_z, id});
    }
    tree = rtcNewBVH(device);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxLeafSize = kLeafSize;
    arguments.maxDepth = 64;
    arguments.bvh = tree;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    root = static_cast<const Node*>(rtcBuildBVH(&arguments));
    check();
  }
};

BoxIndex::BoxIndex(const std::vector<Box>& boxes, double reach) : impl_(std::make_unique<Impl>()) {
  if (boxes.empty()) return;
  impl_->growth = reach * kBoxGrowth;
  impl_->device = rtcNewDevice(nullptr);
  impl_->check();
  impl_->grow(boxes);
  impl_->build_scene();
  impl_->build_tree();
}

BoxIndex::~BoxIndex() = default;
BoxIndex::BoxIndex(BoxIndex&&) noexcept = default;
BoxIndex& BoxIndex::operator=(BoxIndex&&) noexcept = default;

bool BoxIndex::any_along(const Vec3& from, const Vec3& to, VisitFunction<bool> call, void* visitor) const {
  if (!impl_->scene) return false;
  AlongContext context{{}, call, visitor, false};
  rtcInitIntersectContext(&context.embree);
  const Eigen::Vector3f origin = from.cast<float>();
  const Eigen::Vector3f direction = (to - from).cast<float>();
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = 0;
  ray.tfar = 1 + static_cast<float>(kBoxGrowth);
  ray.mask = ~0u;
  rtcOccluded1(impl_->scene, &context.embree, &ray);
  return context.stopped;
}

void BoxIndex::nearest(const Vec3& point, VisitFunction<double> call, void* visitor) const {
  if (!impl_->scene) return;
  NearestContext context{call, visitor, 2 * impl_->growth};
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x());
  query.y = static_cast<float>(point.y());
  query.z = static_cast<float>(point.z());
  query.radius = kInfinity;
  RTCPointQueryContext instances;
  rtcInitPointQueryContext(&instances);
  rtcPointQuery(impl_->scene, &query, &instances, visit_nearest, &context);
}

bool BoxIndex::any_within(const std::vector<HalfSpace>& region, VisitFunction<bool> call, void* visitor) const {
  return impl_->root && any_below(impl_->root, region, call, visitor);
}

}  // namespace vantage::internal::verify
