// The public functions: they choose the device.
#include "vantage/spheres.h"

#include "core/parallel.h"
#include "depth/depth.h"
#include "options/spheres_options.h"
#include "spheres/sphere_maker.h"
#include "spheres/visibility.h"
#include "vantage/error.h"

namespace vantage {

Volume compute_visibility_spheres(const PreparedTarget& target, const SpheresOptions& options, SpheresReport* report,
                                  const StageSink& stages, const Progress& progress) {
  internal::options::check_options(options);  // before a device is looked for
  if (target.sensor().visible) {
    throw Error(ErrorCode::not_applicable, "the method of spheres cannot tell how much of a target is seen",
                "sensor.visible", "use the exact method, or leave 'visible' out");
  }
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] {
    const internal::depth::ChosenRenderer chosen = internal::depth::make_depth_renderer(target.scene(), options.device);
    const RenderDevice hoped = chosen.renderer->device();
    volume = internal::spheres::compute_visibility(target, options, *chosen.renderer, report, stages, progress);
    if (!report) return;
    report->device_note = chosen.note;
    if (report->device.index != hoped.index) report->device_note = hoped.name + " failed on the way, the CPU went on";
  });
  return volume;
}

Mesh visibility_sphere(const PreparedScene& scene, const Vec3& viewpoint, double radius_m,
                       const SpheresOptions& options, const Progress& progress) {
  internal::options::check_options(options);
  Mesh mesh;
  internal::parallel::with_threads(options.threads, [&] {
    const internal::depth::ChosenRenderer chosen = internal::depth::make_depth_renderer(scene, options.device);
    mesh = internal::spheres::visibility_sphere(viewpoint, radius_m, options, *chosen.renderer, progress);
  });
  return mesh;
}

}  // namespace vantage
