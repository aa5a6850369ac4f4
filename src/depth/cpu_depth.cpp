#include "depth/cpu_depth.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "depth/center_raster.h"
#include "depth/conservative_raster.h"
#include "depth/depth_request.h"
#include "depth/face_view.h"
#include "depth/ray_caster.h"
#include "depth/seen_scene.h"

namespace vantage::internal::depth {
namespace {

// Texels along a side of a face from which on rasterising all polygons in range is faster than a ray for each texel.
// Measured per cube map with one thread, rays and rasterising: 40 texels 0.5 and 1.6 ms, 200 texels 7.3 and 3.3 ms,
// 2048 texels 578 and 52 ms (Florence, 300 m; Munich is alike, in Charlotte with its fewer polygons rasterising gains
// more).
constexpr int kRasterSize = 128;
constexpr int kBandRows = 128;                              // of a face: the unit of work of a thread
constexpr std::size_t kAheadBytes = std::size_t{64} << 20;  // for the images of one round of viewpoints
constexpr std::size_t kAheadViewpoints = 64;

class CpuDepthRenderer : public DepthRenderer {
 public:
  explicit CpuDepthRenderer(const PreparedScene& scene) : device_(cpu_device()), scene_(scene) {}

  const RenderDevice& device() const override { return device_; }

  void render(const DepthRequest& request, const DepthSink& sink) override {
    check_request(request, device_);
    const bool by_rays = request.sampling == Sampling::centers && request.face_size < kRasterSize;
    if (by_rays && !rays_) rays_.emplace(scene_);
    const std::size_t image = std::size_t{6} * request.face_size * request.face_size;
    const std::size_t round = std::clamp<std::size_t>(kAheadBytes / (image * sizeof(float)), 1, kAheadViewpoints);
    for (std::size_t first = 0; first < request.viewpoints.size(); first += round) {
      const std::size_t count = std::min(round, request.viewpoints.size() - first);
      images_.resize(std::max(images_.size(), count * image));
      render_round(request, first, count, image);
      for (std::size_t i = 0; i < count; ++i)
        sink(first + i, std::span<const float>(images_).subspan(i * image, image));
    }
  }

 private:
  /// All bands of all faces of some viewpoints, on all threads.
  void render_round(const DepthRequest& request, std::size_t first, std::size_t count, std::size_t image) {
    const int size = request.face_size;
    const std::size_t bands = static_cast<std::size_t>((size + kBandRows - 1) / kBandRows);
    parallel::for_ranges(count * 6 * bands, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t unit = begin; unit < end; ++unit) {
        FaceBand band;
        band.face = static_cast<int>(unit / bands % 6);
        band.size = size;
        band.row_begin = static_cast<int>(unit % bands) * kBandRows;
        band.row_end = std::min(band.row_begin + kBandRows, size);
        const std::size_t viewpoint = unit / (6 * bands);
        const std::size_t offset = (static_cast<std::size_t>(band.face) * size + band.row_begin) * size;
        const std::span<float> texels = std::span<float>(images_).subspan(
            viewpoint * image + offset, static_cast<std::size_t>(band.row_end - band.row_begin) * size);
        std::fill(texels.begin(), texels.end(), 0.0F);
        const Vec3 eye = request.viewpoints[first + viewpoint] - scene_.data().origin;
        if (request.sampling == Sampling::nearest) {
          draw_footprints(band, eye, request.range_m, texels);
        } else if (size >= kRasterSize) {
          draw_centers(band, eye, request.range_m, texels);
        } else {
          cast_rays(band, eye, request.range_m, texels);
        }
      }
    });
  }

  void draw_footprints(const FaceBand& band, const Vec3& eye, double range, std::span<float> texels) const {
    FaceClip clip(band);
    ConservativeRaster raster(band, texels);
    std::vector<Vec3> corners;
    for_each_polygon(scene_.data().bvh, eye, range, clip, [&](std::uint32_t number) {
      const ViewedPolygon polygon = scene_.polygon(number, eye, corners);
      raster.draw(clip.clip(polygon), polygon.slack);
    });
  }

  void draw_centers(const FaceBand& band, const Vec3& eye, double range, std::span<float> texels) const {
    FaceClip clip(band);
    std::vector<Vec3> corners;
    for_each_polygon(scene_.data().bvh, eye, range, clip, [&](std::uint32_t number) {
      draw_at_centers(band, clip.clip(scene_.polygon(number, eye, corners)), texels);
    });
  }

  /// Rays, but for what is so near that they might start on its wrong side.
  void cast_rays(const FaceBand& band, const Vec3& eye, double range, std::span<float> texels) const {
    const double near_distance = std::min(range, rays_->near_distance(eye));
    draw_centers(band, eye, near_distance, texels);
    std::vector<std::uint32_t> near;
    const FaceClip clip(band);
    for_each_polygon(scene_.data().bvh, eye, near_distance, clip,
                     [&](std::uint32_t number) { near.push_back(number); });
    std::sort(near.begin(), near.end());
    rays_->cast(band, eye, range, near, texels);
  }

  RenderDevice device_;
  SeenScene scene_;
  std::optional<RayCaster> rays_;  ///< made when first asked for
  std::vector<float> images_;
};

}  // namespace

RenderDevice cpu_device() {
  RenderDevice device;
  device.kind = DeviceKind::cpu;
  device.name = "CPU (Embree " + ray_caster_version() + ")";
  device.largest_face_size = 8192;
  return device;
}

std::unique_ptr<DepthRenderer> make_cpu_depth_renderer(const PreparedScene& scene) {
  return std::make_unique<CpuDepthRenderer>(scene);
}

}  // namespace vantage::internal::depth
