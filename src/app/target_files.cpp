#include "app/target_files.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/ground_target.h"
#include "app/input_file.h"
#include "app/named_objects.h"
#include "app/target_section.h"
#include "app/zone_file.h"
#include "app/zone_files.h"
#include "common/input.h"
#include "core/solid_check.h"
#include "core/zone_check.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::internal::app {
namespace {

/// The polygons of a feature, by its number.
using Features = std::map<std::size_t, std::vector<ListedZone>>;

class FeatureOfFile {
 public:
  FeatureOfFile(const Mission& mission, const TargetFile& from, const geo::OnGlobe& globe)
      : mission_(mission), from_(from), globe_(globe) {}

  /// Those of the feature that counts.
  std::vector<ListedZone> polygons(ZoneList list) const;
  GroundTarget placed(const std::vector<ListedZone>& polygons) const;

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& place, const std::string& problem,
                         const std::string& fix) const {
    fail_in_zones(code, from_.file, place, problem, fix);
  }
  [[noreturn]] void fail_for_unlike_heights(const std::string& place) const {
    fail(ErrorCode::target_not_planar, place, "its corners have different heights above the ground",
         "give all of them one height, or heights above the sea level ('absolute')");
  }
  const std::vector<ListedZone>& chosen(const Features& features) const;
  void check_near(const Zone::Ring& ring, const std::string& place) const;
  std::optional<double> add_heights(const ListedZone& listed, TargetOutline& outline) const;

  const Mission& mission_;
  const TargetFile& from_;
  const geo::OnGlobe& globe_;
};

std::set<std::string> names_of(const Features& features) {
  std::set<std::string> names;
  for (const auto& [number, polygons] : features) {
    const std::vector<std::string>& known = polygons.front().names;
    names.insert(known.empty() ? std::to_string(number) : known.front());
  }
  return names;
}

const std::vector<ListedZone>& FeatureOfFile::chosen(const Features& features) const {
  const std::string& wanted = from_.feature;
  if (wanted.empty()) {
    if (features.size() == 1) return features.begin()->second;
    fail(ErrorCode::missing_key, "", "the file has " + std::to_string(features.size()) + " areas",
         "say which one is the target, by its name, id or number, with 'feature'; " +
             advice_for_name("", names_of(features), ""));
  }
  enum class By { name, name_in_any_case, number };
  for (const By by : {By::name, By::name_in_any_case, By::number}) {
    std::vector<const std::vector<ListedZone>*> found;
    for (const auto& [number, polygons] : features) {
      const std::vector<std::string>& known = polygons.front().names;
      const auto fits = [&](const std::string& name) {
        return by == By::name ? name == wanted : is_same_name(name, wanted);
      };
      const bool is_wanted =
          by == By::number ? std::to_string(number) == wanted : std::any_of(known.begin(), known.end(), fits);
      if (is_wanted) found.push_back(&polygons);
    }
    if (found.size() == 1) return *found.front();
    if (found.empty()) continue;
    fail(ErrorCode::conflicting_keys, "",
         std::to_string(found.size()) + " areas of the file are called " + in_quotes(wanted),
         "give each a name of its own in the file");
  }
  fail(ErrorCode::object_missing, "", "the file has no area " + in_quotes(wanted),
       advice_for_name(wanted, names_of(features), "look into the file for its name"));
}

std::vector<ListedZone> FeatureOfFile::polygons(ZoneList list) const {
  const auto is_named = [&](const ListedZone& zone) {
    const auto is_wanted = [&](const std::string& name) { return is_same_name(name, from_.feature); };
    return std::to_string(zone.feature) == from_.feature ||
           std::any_of(zone.names.begin(), zone.names.end(), is_wanted);
  };
  for (const UnreadZone& unread : list.unread) {
    if (list.zones.empty() || is_named(unread.zone)) throw unread.fault;
  }
  if (list.zones.empty()) {
    fail(ErrorCode::nothing_given, "", "the file has no areas",
         "give polygons: lines and points are no targets of a file");
  }
  Features features;
  for (ListedZone& listed : list.zones) features[listed.feature].push_back(std::move(listed));
  std::vector<ListedZone> polygons = chosen(features);
  for (const UnreadZone& unread : list.unread) {
    if (unread.zone.feature == polygons.front().feature) throw unread.fault;  // a part of the target
  }
  for (const ListedZone& listed : polygons) {
    if (listed.circle) {
      fail(ErrorCode::value_unsupported, listed.place, "the area is a circle", "give a polygon, of up to 64 corners");
    }
    if (listed.is_solid) {
      fail(ErrorCode::value_unsupported, listed.place, "the area has a floor, a ceiling and walls",
           "give one polygon, in a file of its own");
    }
  }
  return polygons;
}

void FeatureOfFile::check_near(const Zone::Ring& ring, const std::string& place) const {
  double farthest_m = 0;
  for (const Eigen::Vector2d& corner : ring) {
    farthest_m = std::max(farthest_m, globe_.map().to_local({corner.x(), corner.y()}).norm());
  }
  if (farthest_m <= geo::kFarthestM) return;
  const bool is_swapped = std::all_of(ring.begin(), ring.end(), [this](const Eigen::Vector2d& corner) {
    return std::abs(corner.x()) <= 90 && globe_.map().to_local({corner.y(), corner.x()}).norm() <= geo::kFarthestM;
  });
  fail(ErrorCode::too_far_away, place,
       "the target lies " + std::to_string(std::lround(farthest_m / 1000)) + " km from the scene's origin" +
           (is_swapped ? "; longitude and latitude seem to be swapped" : ""),
       is_swapped ? "write the longitude before the latitude" : "check the file: is it of another place?");
}

/// Of heights above the ground: the one that all corners have.
std::optional<double> FeatureOfFile::add_heights(const ListedZone& listed, TargetOutline& outline) const {
  const std::size_t count = listed.corner_z_m.size();
  const auto without = static_cast<std::size_t>(
      std::count_if(listed.corner_z_m.begin(), listed.corner_z_m.end(), [](double z) { return std::isnan(z); }));
  if (without == count) return std::nullopt;
  if (without > 0) {
    fail(ErrorCode::wrong_type, listed.place,
         std::to_string(without) + " of its " + std::to_string(count) + " corners have no height, and others have one",
         "give all corners a height, or none: then they lie on the ground");
  }
  if (listed.corners_from == HeightReference::ground) {
    const auto [low, high] = std::minmax_element(listed.corner_z_m.begin(), listed.corner_z_m.end());
    if (*low != *high) fail_for_unlike_heights(listed.place);
    return *low;
  }
  double shift = 0;
  if (listed.corners_from == HeightReference::sea_level) {
    const auto sea = sea_level_m(mission_);
    if (!sea) {
      fail(ErrorCode::heights_differ, listed.place,
           "its heights are above mean sea level, and the scene does not say which z that is",
           "say it with 'scene.sea_level', or let the polygon lie on the ground ('clampToGround')");
    }
    shift = *sea;
  }
  for (const double z : listed.corner_z_m) outline.z_m.push_back(z + shift);
  return std::nullopt;
}

GroundTarget FeatureOfFile::placed(const std::vector<ListedZone>& polygons) const {
  GroundTarget target;
  for (const ListedZone& listed : polygons) {
    TargetOutline outline{listed.outer, listed.holes, {}};
    check_near(outline.outer, listed.place);
    for (const Zone::Ring& hole : outline.holes) check_near(hole, listed.place);
    // One on the ground is no metre above it, and not where the others are.
    const double above_ground_m = add_heights(listed, outline).value_or(0);
    place_corners(globe_, above_ground(mission_, above_ground_m), outline);
    Zone area;
    area.outer = outline.outer;
    area.holes = outline.holes;
    if (const auto fault = core::fault_of(area)) {
      fail(fault->code, listed.place, fault->problem, advice_for_outline(*fault, listed.corner_z_m));
    }
    if (!target.outlines.empty() && above_ground_m != target.above_ground_m) fail_for_unlike_heights(listed.place);
    target.above_ground_m = above_ground_m;
    target.outlines.push_back(std::move(outline));
  }
  const auto has_heights = [](const TargetOutline& one) { return !one.z_m.empty(); };
  const auto count = std::count_if(target.outlines.begin(), target.outlines.end(), has_heights);
  if (count > 0 && static_cast<std::size_t>(count) < target.outlines.size()) {
    fail(ErrorCode::wrong_type, polygons.front().place, "it has polygons with heights and polygons without",
         "give all corners a height, or none: then they lie on the ground");
  }
  return target;
}

}  // namespace

void read_target_file(const Mission& mission, const geo::OnGlobe& globe, const core::ProgressReporter& progress,
                      MissionTarget& given) {
  const TargetFile from = std::get<TargetFile>(given.source);
  const FeatureOfFile reader(mission, from, globe);
  const std::vector<ListedZone> polygons =
      reader.polygons(parse_zones(read_text(from.file, "file of the target", kMostZoneBytes), from.file, progress));
  given.source = reader.placed(polygons);
  if (given.target.name.empty()) {
    const ListedZone& first = polygons.front();
    given.target.name = first.names.empty() ? from.file.stem().string() : first.names.front();
  }
}

void read_target_volume(Mission& mission, const Progress& progress, MissionTarget& given) {
  const TargetFile from = std::get<TargetFile>(given.source);
  const Scene& scene = mission.scene();
  VolumeFile read = read_volume(from.file, scene, progress);
  auto volume = std::make_shared<TargetVolume>();
  volume->mesh = core::checked_solid(read.volume.mesh, from.name, core::ProgressReporter(progress));
  volume->rounding_m = read.rounding_m;
  const auto note = [&](WarningCode code, const std::string& text) {
    mission.notes.push_back({code, in_quotes(from.name) + " " + text});
  };
  if (read.volume.georeference && !scene.georeference) {
    note(WarningCode::volume_of_other_scene,
         "says where on the earth it lies, and the scene does not: it is taken to be in the frame of the scene");
  }
  const auto& made = read.volume.provenance;
  volume->is_computed = made.has_value();
  if (made && !made->scene_hash.empty() && made->scene_hash != scene_hash(scene)) {
    note(WarningCode::volume_of_other_scene, "says that it was computed in another scene than the mission's");
  }
  std::move(read.notes.begin(), read.notes.end(), std::back_inserter(mission.notes));
  given.target.volume = std::move(volume);
  given.source = std::monostate{};
  if (given.target.name.empty()) given.target.name = from.file.stem().string();
}

}  // namespace vantage::internal::app
