#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/places.h"
#include "core/stopwatch.h"
#include "core/volume_check.h"
#include "depth/depth.h"
#include "scene/viewpoint_check.h"
#include "spheres/visibility.h"
#include "vantage/error.h"
#include "vantage/spheres.h"

namespace vantage {
namespace {

using Matrix = Eigen::Matrix3d;

/// Index of each cause in Volume::causes.
enum CauseIndex : std::uint32_t { kScene, kRange, kLow, kHigh };

/// A vertex this much nearer than the range, relatively, was stopped by the scene.
constexpr double kRangeRounding = 1e-6;

/// All meshes in world axes. Files in world axes are read as if they were in the scene frame.
Scene read_world(const WillisConfig& config, const Progress& progress) {
  Scene world;
  for (const WillisMesh& mesh : config.meshes) {
    const Scene part = internal::core::with_place(mesh.where, [&] { return read_scene(mesh.file, {}, progress); });
    const auto first_vertex = static_cast<std::uint32_t>(world.mesh.vertices.size());
    const auto first_object = static_cast<std::uint32_t>(world.objects.size());
    for (const Vec3& given : part.mesh.vertices) {
      // What has axes and a unit of its own, as glTF, was turned and scaled: back to the numbers of the file.
      const Vec3 turned = part.up == UpAxis::y ? Vec3(given.x(), given.z(), -given.y()) : given;
      const Vec3 v = turned / part.scale;
      world.mesh.vertices.push_back(mesh.position + mesh.rotation * mesh.scale.cwiseProduct(v));
    }
    for (const Triangle& t : part.mesh.triangles) {
      world.mesh.triangles.push_back({t[0] + first_vertex, t[1] + first_vertex, t[2] + first_vertex});
    }
    for (const std::uint32_t object : part.object_of) world.object_of.push_back(object + first_object);
    world.objects.insert(world.objects.end(), part.objects.begin(), part.objects.end());
  }
  return world;
}

/// World axes to the axes of the cube: front, up x front, up.
Matrix cube_axes(const WillisVolume& volume) {
  Matrix axes;
  axes << volume.front.transpose(), volume.up.cross(volume.front).transpose(), volume.up.transpose();
  return axes;
}

/// The renderer of the scene in the axes of a cube; most files have one cube only.
class TurnedRenderer {
 public:
  TurnedRenderer(const Scene& world, const DeviceChoice& device, const Progress& progress)
      : world_(world), device_(device), progress_(progress) {}

  internal::depth::DepthRenderer& along(const Matrix& axes) {
    if (!chosen_.renderer || axes != axes_) {
      Scene turned = world_;
      for (Vec3& v : turned.mesh.vertices) v = axes * v;
      chosen_ = internal::depth::make_depth_renderer(PreparedScene(turned, progress_), device_);
      axes_ = axes;
    }
    return *chosen_.renderer;
  }

  const internal::depth::ChosenRenderer& chosen() const { return chosen_; }

 private:
  const Scene& world_;
  const DeviceChoice& device_;
  const Progress& progress_;
  internal::depth::ChosenRenderer chosen_;
  Matrix axes_;
};

double farthest_corner(const Box& box, const Vec3& from) {
  return (box.max - from).cwiseAbs().cwiseMax((box.min - from).cwiseAbs()).norm();
}

/// The vertex after the limits of height, and which of them moved it.
std::pair<Vec3, CauseIndex> cut_vertex(const WillisVolume& volume, SpheresOptions::Sphere sphere, const Vec3& vertex) {
  const double height = vertex.dot(volume.up);
  const double limit = std::clamp(height, volume.up_min, volume.up_max);
  if (limit == height) return {vertex, kScene};
  const CauseIndex cause = limit > height ? kLow : kHigh;
  if (sphere == SpheresOptions::Sphere::centers) return {vertex + (limit - height) * volume.up, cause};
  const double eye = volume.origin.dot(volume.up);
  return {volume.origin + (limit - eye) / (height - eye) * (vertex - volume.origin), cause};
}

/// The mesh in world axes, with its causes, cut to the limits and turned to the scene frame.
Volume finished(const WillisConfig& config, const WillisVolume& volume, SpheresOptions::Sphere sphere, Mesh mesh,
                double radius) {
  Volume result;
  result.causes = {{CauseKind::scene, "scene"},
                   {CauseKind::range, "radius_max"},
                   {CauseKind::navigation, "up_min"},
                   {CauseKind::navigation, "up_max"}};
  std::vector<CauseIndex> cause_at;
  for (Vec3& vertex : mesh.vertices) {
    const bool is_at_range = (vertex - volume.origin).norm() >= radius * (1 - kRangeRounding);
    const auto [moved, cause] = cut_vertex(volume, sphere, vertex);
    vertex = config.up == UpAxis::y ? Vec3(moved.x(), -moved.z(), moved.y()) : moved;
    cause_at.push_back(cause == kScene && is_at_range ? kRange : cause);
  }
  for (const Triangle& t : mesh.triangles) {
    const bool is_one = cause_at[t[0]] == cause_at[t[1]] && cause_at[t[0]] == cause_at[t[2]];
    const CauseIndex cause = is_one ? cause_at[t[0]] : kScene;
    result.cause_of.push_back(cause);
  }
  result.mesh = std::move(mesh);
  return result;
}

WillisResult compute(const WillisConfig& config, const WillisVolume& volume, const Box& bounds,
                     TurnedRenderer& renderer, SpheresOptions options, const Progress& progress) {
  const internal::core::Stopwatch stopwatch;
  const Matrix axes = cube_axes(volume);
  const double radius = std::isfinite(volume.radius_max) ? volume.radius_max : farthest_corner(bounds, volume.origin);
  options.cubemap = volume.texels;
  options.resolution.reset();
  options.merge = 0;  // theirs has every texel
  Mesh mesh =
      internal::spheres::visibility_sphere(axes * volume.origin, radius, options, renderer.along(axes), progress);
  for (Vec3& v : mesh.vertices) v = axes.transpose() * v;

  WillisResult result;
  result.volume = finished(config, volume, options.sphere, std::move(mesh), radius);
  result.measures = internal::core::measure_sound(result.volume.mesh);
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace

WillisRun run_willis_config(const WillisConfig& config, const SpheresOptions& options, const Progress& progress) {
  const Scene world = read_world(config, progress);
  const internal::scene::ViewpointCheck check(world);
  for (const WillisVolume& volume : config.volumes) {
    internal::core::with_place(volume.where, [&] { check.check(volume.origin, "the viewpoint of " + volume.name); });
  }
  const Box bounds = bounding_box(world.mesh);
  TurnedRenderer renderer(world, options.device, progress);
  WillisRun run;
  for (const WillisVolume& volume : config.volumes) {
    run.results.push_back(internal::core::with_place(
        volume.where, [&] { return compute(config, volume, bounds, renderer, options, progress); }));
  }
  run.device = renderer.chosen().renderer->device();
  run.device_note = renderer.chosen().note;
  return run;
}

}  // namespace vantage
