// From a request to a finished picture.
#include "vantage/picture.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "common/atomic_file.h"
#include "core/png_mark.h"
#include "core/progress_reporter.h"
#include "core/system_limits.h"
#include "depth/depth.h"
#include "depth/gl_context.h"
#include "picture/annotate.h"
#include "picture/canvas.h"
#include "picture/draw_list.h"
#include "picture/gl_picture.h"
#include "picture/occlusion_rays.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using namespace internal::picture;

void check(const PictureRequest& request) {
  for (const int size : {request.width, request.height}) {
    if (size >= kSmallestPicture && size <= kLargestPicture) continue;
    throw Error(
        ErrorCode::value_out_of_range, "a picture cannot be " + std::to_string(size) + " pixels wide or high",
        "size " + std::to_string(request.width) + "x" + std::to_string(request.height),
        "take " + std::to_string(kSmallestPicture) + " to " + std::to_string(kLargestPicture) + " pixels each way");
  }
}

void check_indices(const Mesh& mesh, const std::string& what) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size() && mesh.vertices[v].allFinite()) continue;
      throw Error(
          v < mesh.vertices.size() ? ErrorCode::coordinate_not_finite : ErrorCode::index_out_of_range,
          "triangle " + std::to_string(t) + " of the " + what + " has a vertex that does not exist or is not finite",
          what, "pass a mesh whose indices are in range and whose coordinates are finite");
    }
  }
}

void check_objects(const Scene& scene) {
  const auto is_bad = [&](std::uint32_t object) { return object >= scene.objects.size(); };
  if (scene.object_of.empty() || (scene.object_of.size() == scene.mesh.triangles.size() &&
                                  std::none_of(scene.object_of.begin(), scene.object_of.end(), is_bad)))
    return;
  throw Error(scene.object_of.size() == scene.mesh.triangles.size() ? ErrorCode::index_out_of_range
                                                                    : ErrorCode::array_sizes_differ,
              "the scene's objects do not fit its triangles", "scene",
              "pass an object in range for each triangle, or none at all");
}

void check_volume(const Volume& volume) {
  check_indices(volume.mesh, "volume");
  const auto is_bad = [&](std::uint32_t cause) { return cause >= volume.causes.size(); };
  if (volume.cause_of.empty() || (volume.cause_of.size() == volume.mesh.triangles.size() &&
                                  std::none_of(volume.cause_of.begin(), volume.cause_of.end(), is_bad)))
    return;
  throw Error(volume.cause_of.size() == volume.mesh.triangles.size() ? ErrorCode::index_out_of_range
                                                                     : ErrorCode::array_sizes_differ,
              "the volume's causes do not fit its triangles", "volume",
              "pass a cause in range for each triangle, or none at all");
}

void check_marks(const PictureRequest& request) {
  const Mesh* const solid = request.volume != nullptr ? &request.volume->mesh : request.solid;
  const std::size_t facets = solid == nullptr ? 0 : solid->triangles.size();
  for (const MarkedFacets& marks : request.marks) {
    for (const std::uint32_t facet : marks.facets) {
      if (facet < facets) continue;
      throw Error(ErrorCode::index_out_of_range,
                  "facet " + std::to_string(facet) + " is marked, and the volume has " + std::to_string(facets),
                  "marks", "give numbers of the volume's facets");
    }
  }
}

void check_paths(const PictureRequest& request) {
  const auto check_points = [](const PicturePath& path, const std::vector<Vec3>& points) {
    if (std::all_of(points.begin(), points.end(), [](const Vec3& point) { return point.allFinite(); })) return;
    throw Error(ErrorCode::coordinate_not_finite, "a point of the line '" + path.label + "' is not finite", "paths",
                "pass finite coordinates");
  };
  for (const PicturePath& path : request.paths) {
    check_points(path, path.points);
    for (const std::vector<Vec3>& stretch : path.marked) check_points(path, stretch);
  }
}

/// Draws on the first device that is able to, graphics processors first.
std::vector<std::uint8_t> draw(const DrawList& list, const View& view,
                               const internal::core::ProgressReporter& progress) {
  std::string why;
  std::vector<internal::depth::GlDeviceInfo> devices = internal::depth::gl_devices(why);
  std::stable_sort(devices.begin(), devices.end(),
                   [](const internal::depth::GlDeviceInfo& a, const internal::depth::GlDeviceInfo& b) {
                     return a.device.kind == DeviceKind::opengl_hardware &&
                            b.device.kind != DeviceKind::opengl_hardware;
                   });
  for (const internal::depth::GlDeviceInfo& device : devices) {
    try {
      const internal::depth::GlContext context(device);
      return draw_picture(context, list, view, progress);
    } catch (const internal::depth::DeviceFailure& failure) {
      why = device.device.name + ": " + failure.what();
    }
  }
  if (!internal::core::can_load_libraries()) {
    throw Error(ErrorCode::device_missing,
                std::string("pictures are drawn with OpenGL, but ").append(internal::core::kLoadsNone), "",
                internal::core::kLoadsNoneFix);
  }
  throw Error(ErrorCode::device_missing, "pictures need OpenGL 4.5: " + why, "this machine's OpenGL",
              devices.empty() ? "install libegl1 and libgl1-mesa-dri (Debian): no graphics processor is needed"
                              : "ask for a smaller picture, or mend the driver");
}

}  // namespace

Picture render_picture(const Scene& scene, const PictureRequest& request, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback);
  progress.begin("preparing the picture");
  check(request);
  check_indices(scene.mesh, "scene");
  check_objects(scene);
  if (request.volume != nullptr) check_volume(*request.volume);
  check_marks(request);
  check_paths(request);
  if (request.solid != nullptr) check_indices(*request.solid, "solid");
  for (const Mesh* solid : request.solids) check_indices(*solid, "solid");

  Annotation annotation{
      request.title, request.subtitle,     legend_of(request), 0, request.view.kind == PictureView::Kind::from,
      request.notes, attribution_of(scene)};
  const PictureExtent extent = find_extent(scene, request, progress);
  Insets insets{8, 8, 8, 8};
  if (request.annotate) insets = insets_of(annotation, request.width, request.height);
  progress.check();
  Box bounds = bounding_box(scene.mesh);
  bounds.extend(extent.framed);
  const OcclusionRays occlusion_rays(scene.mesh, extent.centre, progress.part(0, 0));
  PictureView from = request.view;
  if (from.kind == PictureView::Kind::oblique && !from.azimuth_deg) {
    from.azimuth_deg =
        best_azimuth(occlusion_rays, extent, extent.target, from.elevation_deg, kPreferredAzimuth, progress);
  }
  const View view = make_view(from, request.width, request.height, insets, extent.points, extent.centre, bounds);
  const DrawList list = make_draw_list(scene, request, extent, view, occlusion_rays, progress);
  annotation.grid_m = list.grid_m;

  progress.begin("drawing the picture");
  const std::vector<std::uint8_t> rgb = draw(list, view, progress);
  Picture picture{request.width, request.height, {}};
  picture.rgba.reserve(rgb.size() / 3 * 4);
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    picture.rgba.insert(picture.rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 255});
  progress.finish();
  return request.annotate ? annotated(picture, annotation, view) : credited(picture, annotation.credit);
}

void write_png(const Picture& picture, const std::filesystem::path& file, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback, file);
  progress.begin("writing the picture");
  AtomicFile output(file);
  output.write(internal::core::with_png_mark(Canvas(picture).png(progress)));
  progress.finish();
  output.commit();
}

}  // namespace vantage
