#include "app/face_targets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "app/named_objects.h"
#include "app/scene_lookups.h"
#include "app/target_section.h"
#include "common/input.h"
#include "common/ledger.h"
#include "core/text.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage::internal::app {
namespace {

using Vec2 = Eigen::Vector2d;
using Objects = std::vector<std::uint32_t>;

const char* const kNoNames = "give the target's vertices: the objects of this scene have no names";

Objects named(const Mission& mission, const std::string& name) {
  Objects found = objects_named(mission.scene(), name);
  if (!found.empty()) return found;
  throw Error(ErrorCode::object_missing, "the scene has no object " + in_quotes(name), mission.as_written.places.target,
              advice_for_object(mission.scene(), name, kNoNames));
}

/// The objects of a map, by their ids in it.
struct MapObjects {
  explicit MapObjects(const LoadedScene& loaded) {
    const std::vector<SceneObject>& objects = loaded.scene.objects;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      if (!objects[i].source_id.empty()) of[objects[i].source_id].push_back(i);
    }
    if (!loaded.city) return;
    for (const CityRecord& record : loaded.city->records) {
      if (!record.building.empty()) parts[record.building].push_back(record.object.source_id);
    }
    for (const CityPassedOver& one : loaded.city->passed_over) not_built.emplace(one.object.source_id, one.reason);
    for (const LedgerEntry& entry : loaded.scene.ledger) {
      if (!entry.stand_in && !entry.object.source_id.empty()) not_built.emplace(entry.object.source_id, entry.reason);
    }
    // Of a building whose parts have its name the building counts.
    std::unordered_map<std::string, std::string> building_of;
    for (const CityRecord& record : loaded.city->records) building_of[record.object.source_id] = record.building;
    for (const SceneObject& object : objects) {
      if (object.name.empty() || object.source_id.empty()) continue;
      const auto building = building_of.find(object.source_id);
      const bool is_part = building != building_of.end() && !building->second.empty();
      named.push_back({object.name, is_part ? building->second : object.source_id});
    }
    const auto add_whole = [&](const SceneObject& object) {
      if (parts.contains(object.source_id) && !object.name.empty()) named.push_back({object.name, object.source_id});
    };
    for (const CityRecord& record : loaded.city->records) add_whole(record.object);
    for (const CityPassedOver& one : loaded.city->passed_over) add_whole(one.object);
  }

  bool knows(const std::string& id) const { return of.contains(id) || parts.contains(id) || not_built.contains(id); }

  std::unordered_map<std::string, Objects> of;
  std::unordered_map<std::string, std::vector<std::string>> parts;  // of a building
  std::unordered_map<std::string, std::string> not_built;           // why it is not built
  std::vector<NamedId> named;
};

/// Whether it is written as ids of maps are: "way/123", "w123", "way/-1" before it is uploaded. The reader of maps
/// (osm::parse_object_id) is in a library that a build may lack.
bool is_map_id(const std::string& text) {
  const std::size_t begin = text.find_first_of("-0123456789");
  const std::string_view all = text, head = all.substr(0, begin);
  const bool is_type =
      head == "way/" || head == "relation/" || head == "node/" || head == "w" || head == "r" || head == "n";
  if (!is_type || begin == std::string::npos) return false;
  const std::string_view digits = all.substr(text[begin] == '-' ? begin + 1 : begin);
  return !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos;
}

/// An object of the map, by its id or its name, and, of a building, its parts.
Objects of_map(const Mission& mission, const std::string& asked) {
  const auto& map =
      looked_up<MapObjects>(*mission.loaded, [&] { return std::make_shared<const MapObjects>(*mission.loaded); });
  const bool is_id = map.knows(asked) || is_map_id(asked);
  const std::string id = is_id ? asked
                               : id_of_name(map.named, asked, "object of the scene", mission.as_written.places.target,
                                            uses_part_of_map(mission));
  std::set<std::string> wanted{id};
  if (const auto parts = map.parts.find(id); parts != map.parts.end()) {
    wanted.insert(parts->second.begin(), parts->second.end());
  }
  Objects found;
  for (const std::string& one : wanted) {
    if (const auto of = map.of.find(one); of != map.of.end()) {
      found.insert(found.end(), of->second.begin(), of->second.end());
    }
  }
  std::sort(found.begin(), found.end());
  if (!found.empty()) return found;
  const std::string& place = mission.as_written.places.target;
  const auto not_built = map.not_built.find(id);
  const std::string reason = not_built == map.not_built.end() ? "" : not_built->second;
  if (!reason.empty()) {
    throw Error(ErrorCode::object_missing, id + " of the map is not built: " + reason, place,
                "name another object, or give the target's vertices");
  }
  std::set<std::string> names;
  for (const auto& entry : map.of) names.insert(entry.first);
  throw Error(ErrorCode::object_missing, "the scene has no object " + in_quotes(id) + " of the map", place,
              "name a building, wall, tower or bridge in the part of the map that is used; " +
                  advice_for_name(id, names, kNoNames));
}

/// z of a triangle at a place in plan; nothing where it is not there. Of triangles that share a side, one holds a place
/// on it.
std::optional<double> height_at(const Scene& scene, const Triangle& triangle, const Vec2& at) {
  const Vec3 &a = scene.mesh.vertices[triangle[0]], &b = scene.mesh.vertices[triangle[1]],
             &c = scene.mesh.vertices[triangle[2]];
  bool inside = false;
  for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
    if ((from.y() > at.y()) == (to.y() > at.y())) continue;
    if (at.x() < from.x() + (to.x() - from.x()) * (at.y() - from.y()) / (to.y() - from.y())) inside = !inside;
  }
  const Vec3 normal = (b - a).cross(c - a);
  if (!inside || normal.z() == 0) return std::nullopt;
  return a.z() - (normal.x() * (at.x() - a.x()) + normal.y() * (at.y() - a.y())) / normal.z();
}

bool is_ground(const SceneObject& object) {
  return object.kind == ObjectKind::ground || object.kind == ObjectKind::surface;
}

/// The highest object at a place, but for the ground.
Objects at_place(const Mission& mission, const std::array<double, 2>& at_deg, const geo::OnGlobe& globe) {
  const Scene& scene = mission.scene();
  const geo::LonLat place{at_deg[1], at_deg[0]};
  constexpr double kStepM = 1000;  // along the vertical of the place, which is not z where the frame is no map
  const Vec2 at = globe.at_z(place, 0), lean = (globe.at_z(place, kStepM) - at) / kStepM;
  std::optional<std::uint32_t> highest, nearest;
  double top = -INFINITY, least = INFINITY;
  for (std::size_t i = 0; i < scene.object_of.size(); ++i) {
    const std::uint32_t object = scene.object_of[i];
    if (is_ground(scene.objects[object])) continue;
    const Triangle& triangle = scene.mesh.triangles[i];
    auto height = height_at(scene, triangle, at + scene.mesh.vertices[triangle[0]].z() * lean);
    if (height && globe.is_cartesian()) height = height_at(scene, triangle, at + *height * lean);
    if (height && *height > top) {
      top = *height;
      highest = object;
    }
    for (const std::uint32_t vertex : triangle) {
      const double distance = (scene.mesh.vertices[vertex].head<2>() - at).norm();
      if (distance >= least) continue;
      least = distance;
      nearest = object;
    }
  }
  if (highest) return {*highest};
  std::string fix = "write at: [latitude, longitude] of a place in the outline of an object";
  if (nearest) {
    fix += "; the nearest object, " + in_quotes(display_name(scene.objects[*nearest])) + ", has a corner " +
           std::to_string(std::lround(least)) + " m away";
  }
  if (seems_swapped(*scene.georeference, bounding_box(scene.mesh), at_deg[1], at_deg[0])) {
    fix = "latitude and longitude are the wrong way round: write at: [" + shortest(at_deg[1]) + ", " +
          shortest(at_deg[0]) + "]";
  }
  throw Error(ErrorCode::object_missing,
              "no object of the scene lies at [" + shortest(at_deg[0]) + ", " + shortest(at_deg[1]) + "]",
              mission.as_written.places.target, fix);
}

std::string name_of_objects(const Mission& mission, const FaceTarget& wanted, const Objects& objects) {
  if (!wanted.object.empty()) return wanted.object;
  const SceneObject& first = mission.scene().objects[objects.front()];
  if (wanted.osm.empty() || first.source_id == wanted.osm) return display_name(first);
  return wanted.osm;
}

std::string count_text(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::vector<Face> wanted_faces(const Mission& mission, const FaceTarget& wanted, const Objects& objects,
                               const std::string& name, const FaceFinder& finder) {
  const char* const kind = name_of(wanted.kind);
  const std::string& place = mission.as_written.places.target;
  std::vector<Face> faces;
  if (wanted.nearest) {
    if (auto face = finder.nearest(objects, wanted.kind, *wanted.nearest)) faces.push_back(std::move(*face));
  } else {
    faces = finder.faces(objects, wanted.kind);
  }
  if (faces.empty()) {
    throw Error(ErrorCode::face_missing,
                name + " has no " + kind + " of more than 1 square metre that nothing lies against", place,
                wanted.kind == FaceKind::roof ? "write 'part: facade', or name another object"
                                              : "write 'part: roof', or name another object");
  }
  if (!wanted.facing_deg) return faces;
  std::vector<Face> chosen = facing(faces, *wanted.facing_deg);
  if (!chosen.empty()) return chosen;
  std::set<std::string> directions;
  for (const Face& face : faces) {
    if (face.normal.head<2>().norm() < 1e-3) continue;  // level
    const double heading = std::atan2(face.normal.x(), face.normal.y()) * 180 / std::numbers::pi;
    directions.insert(heading_text(std::fmod(45 * std::round(heading / 45) + 360, 360)));
  }
  std::string known;
  for (const std::string& direction : directions) known += (known.empty() ? "" : ", ") + direction;
  throw Error(ErrorCode::face_missing,
              name + " has " + count_text(faces.size(), kind) + ", none within 45 degrees of " +
                  heading_text(*wanted.facing_deg),
              place,
              known.empty() ? "leave 'facing' out: they are level"
                            : "leave 'facing' out for all of them, or choose one of: " + known);
}

Warning faces_together(const std::vector<Face>& faces, const Target& target, FaceKind kind) {
  double area = 0;  // more than 1 m2 each
  for (const Face& face : faces) area += face.area_m2;
  return {
      WarningCode::faces_together,
      target.name + ": all " + std::to_string(faces.size()) + (kind == FaceKind::roof ? " roof faces" : " walls") +
          " of " + core::number_text(std::round(area)) + " m2, in " + std::to_string(target.parts.size()) +
          " convex parts, must be seen from one position; 'facing' or 'nearest' choose of them, and 'combine: each' "
          "makes a volume for each"};
}

/// What only holds the place of something has no faces to look at: nobody knows where those are.
void refuse_stand_ins(const Mission& mission, const Objects& objects) {
  for (const LedgerEntry& entry : mission.scene().ledger) {
    if (!entry.stand_in || std::find(objects.begin(), objects.end(), *entry.stand_in) == objects.end()) continue;
    if (mission.scene().objects[*entry.stand_in].kind != ObjectKind::stand_in) continue;
    throw Error(ErrorCode::face_missing, "only a stand-in is built: " + ledger_text(entry),
                mission.as_written.places.target, "give the target's vertices, or mend the map");
  }
}

}  // namespace

FaceTargets face_targets(const Mission& mission, const FaceTarget& wanted, const Target& target,
                         const geo::OnGlobe* globe, bool together) {
  const Objects objects = wanted.at_deg         ? at_place(mission, *wanted.at_deg, *globe)
                          : !wanted.osm.empty() ? of_map(mission, wanted.osm)
                                                : named(mission, wanted.object);
  refuse_stand_ins(mission, objects);
  std::string name = name_of_objects(mission, wanted, objects);
  const auto& finder =
      looked_up<FaceFinder>(*mission.loaded, [&] { return std::make_shared<const FaceFinder>(mission.scene()); });
  const std::vector<Face> faces = wanted_faces(mission, wanted, objects, name, finder);
  name += std::string(", ") + name_of(wanted.kind);
  if (wanted.facing_deg) name += " facing " + heading_text(*wanted.facing_deg);
  if (!target.name.empty()) name = target.name;
  FaceTargets result;
  if (together || faces.size() == 1) {
    result.targets.push_back(target_of(faces, name));
    if (faces.size() > 1) result.note = faces_together(faces, result.targets[0], wanted.kind);
  } else {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      result.targets.push_back(target_of(std::span(faces).subspan(i, 1), name + " " + std::to_string(i + 1)));
    }
  }
  for (Target& one : result.targets) one.offset_m = target.offset_m;
  return result;
}

}  // namespace vantage::internal::app
