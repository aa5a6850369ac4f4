// What a picture shows, as plain arrays for the drawing: positions are single precision, relative to an origin near by.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/progress_reporter.h"
#include "picture/view.h"
#include "vantage/geometry.h"
#include "vantage/picture.h"

namespace vantage::internal::picture {

class OcclusionRays;

/// A corner of a triangle; three in a row make one.
struct DrawVertex {
  Eigen::Vector3f position, normal;
  std::uint32_t colour = 0;  ///< packed()
};

struct DrawLine {
  Eigen::Vector3f a, b;
  std::uint32_t colour = 0;
  float width = 1;          ///< pixels
  float behind_volume = 1;  ///< times the opacity where the volume is before it
  float behind_scene = 0;   ///< times the opacity where the scene is
};

/// Lengths are metres.
struct DrawList {
  Vec3 origin = Vec3::Zero();                       ///< scene frame: that all positions are relative to
  std::vector<DrawVertex> solids;                   ///< lit and opaque: scene and ground
  std::vector<DrawVertex> volume;                   ///< translucent
  std::vector<DrawVertex> target;                   ///< a flat colour over the volume, hidden by the scene only
  std::vector<DrawLine> ground_lines;               ///< below the volume
  std::vector<DrawLine> creases;                    ///< above it, below the target
  std::vector<DrawLine> lines;                      ///< above all
  Eigen::Vector2f focus = Eigen::Vector2f::Zero();  ///< middle of the disc of scene that is shown
  float fade_begin = 0, fade_end = 1;               ///< radii between which it fades into the paper
  Eigen::Vector3f light_centre = Eigen::Vector3f::Zero();
  float light_radius = 1;                          ///< of a ball that holds all that is lit
  Eigen::Vector3f sun = Eigen::Vector3f::UnitZ();  ///< unit vector towards it
  double grid_m = 0;                               ///< spacing of the ground's grid
};

/// Everything of the request that is drawn. `ground_z` and all of it in the scene frame.
struct PictureExtent {
  Vec3 centre = Vec3::Zero();  ///< of the target, or of what is framed
  Box framed;
  std::vector<Vec3> points;  ///< what must be in the picture
  std::vector<Vec3> target;  ///< corners, as drawn
  double ground_z = 0;
  double radius = 1;  ///< of the disc about `framed`'s middle that the scene is shown in full
};

PictureExtent find_extent(const Scene& scene, const PictureRequest& request,
                          const core::ProgressReporter& progress = {});
/// Parts of the scene that hide the target are drawn as of glass.
DrawList make_draw_list(const Scene& scene, const PictureRequest& request, const PictureExtent& extent,
                        const View& view, const OcclusionRays& occlusion_rays,
                        const core::ProgressReporter& progress = {});

/// 1, 2 or 5 times a power of ten, the largest that is at most `length` (> 0).
double round_length(double length);

}  // namespace vantage::internal::picture
