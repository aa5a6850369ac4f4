#include "cli/flight_picture.h"

#include <cstddef>

#include "vantage/picture.h"
#include "vantage/target.h"

namespace vantage::cli {
namespace {

constexpr int kWidth = 1200, kSceneHeight = 850;

std::vector<Vec3> positions(const Flight& flight) {
  std::vector<Vec3> points;
  for (const FlightPoint& point : flight.points) points.push_back(point.position);
  return points;
}

/// The flight from one place along it to another.
std::vector<Vec3> stretch(const Flight& flight, const FlightCheck& check, const FlightSpan& span) {
  std::vector<Vec3> points{span.begin};
  for (std::size_t i = 0; i < flight.points.size(); ++i) {
    const double at = check.point_at_m[i];
    if (at > span.begin_m && at < span.end_m) points.push_back(flight.points[i].position);
  }
  points.push_back(span.end);
  return points;
}

Picture scene_picture(const FlightPicture& picture, const Progress& progress) {
  std::vector<Target> targets;
  for (std::size_t i = 0; i < volume_count(*picture.mission); ++i) {
    targets.push_back(one_volume(*picture.mission, i).target);
  }
  PictureRequest request;
  request.solids = picture.volumes;
  for (const Target& target : targets) {
    if (!target.is_volume()) request.others.push_back(&target);
    if (target.is_volume() && picture.volumes.empty()) request.solids.push_back(&target.volume->mesh);
  }
  PicturePath path{"flight", positions(*picture.flight), {}, "a target is seen whole"};
  for (const TargetCheck& target : picture.check->targets) {
    for (const FlightSpan& span : target.seen) {
      path.marked.push_back(stretch(*picture.flight, *picture.check, span));
    }
  }
  request.paths.push_back(std::move(path));
  request.navigation = picture.mission->navigation;
  request.width = kWidth;
  request.height = kSceneHeight;
  request.title = picture.title;
  request.subtitle = picture.subtitle;
  return render_picture(picture.mission->scene(), request, progress);
}

Picture profile_picture(const FlightPicture& picture, const Progress& progress) {
  ProfileRequest request;
  request.points = positions(*picture.flight);
  request.width = kWidth;
  request.height_label = "z, m";
  for (const TargetCheck& target : picture.check->targets) {
    ProfileStrip strip{target.name, {}};
    for (const FlightSpan& span : target.seen) strip.spans_m.push_back({span.begin_m, span.end_m});
    request.strips.push_back(std::move(strip));
  }
  for (const LinkCheck& link : picture.check->links) {
    ProfileStrip strip{"link: " + link.name, {}};
    for (const FlightSpan& span : link.linked) strip.spans_m.push_back({span.begin_m, span.end_m});
    request.strips.push_back(std::move(strip));
  }
  return render_profile(picture.mission->scene(), request, progress);
}

}  // namespace

void write_flight_picture(const FlightPicture& picture, const std::filesystem::path& file, const Progress& progress) {
  const Picture scene = scene_picture(picture, progress);
  if (picture.flight->leg_count() == 0) {
    write_png(scene, file, progress);
    return;
  }
  write_png(stack_pictures(scene, profile_picture(picture, progress)), file, progress);
}

}  // namespace vantage::cli
