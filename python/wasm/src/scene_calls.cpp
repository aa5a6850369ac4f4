// Scenes: as python/src/scene.cpp.
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "common/json.h"
#include "held.h"
#include "vantage/earth.h"
#include "vantage/error.h"
#include "vantage/geometry.h"

namespace vantage::wasm {
namespace {

Json load(const Json& a) {
  const MissionFile mission = read_scene_text(a.at("text").get<std::string>(), a.at("name").get<std::string>());
  auto scene = std::make_shared<HeldScene>();
  scene->loaded = std::make_shared<const LoadedScene>(load_scene(mission.scene, tell_progress));
  scene->source = mission.scene;
  scene->sea_level_m = mission.sea_level_m;
  return keep(std::move(scene));
}

Georeference place_of(const Json& row) {
  return {row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<std::string>(), row.at(3).get<std::string>()};
}

/// A box; null in place of an infinite number.
Box box_of(const Json& row) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    const Json &low = row.at(i), &high = row.at(i + 3);
    box.min[static_cast<Eigen::Index>(i)] = low.is_null() ? -kInfinite : low.get<double>();
    box.max[static_cast<Eigen::Index>(i)] = high.is_null() ? kInfinite : high.get<double>();
  }
  return box;
}

/// As ledger_of in python/src/scene.cpp.
LedgerEntry entry_of(const Json& row) {
  LedgerEntry entry;
  const Json& object = row.at(0);
  entry.object = {object.at(0).get<std::string>(), object.at(1).get<std::string>(),
                  static_cast<ObjectKind>(object.at(2).get<int>())};
  entry.what = row.at(1).get<std::string>();
  entry.reason = row.at(2).get<std::string>();
  if (const Json& box = row.at(3); !box.is_null()) entry.box = box_of(box);
  if (const Json& height = row.at(4); !height.is_null()) entry.height_m = height.get<double>();
  if (const Json& holder = row.at(5); !holder.is_null()) entry.stand_in = holder.get<std::uint32_t>();
  entry.instead = row.at(6).get<std::string>();
  entry.may_be_larger = row.at(7).get<bool>();
  entry.outlines = row.at(8).get<std::vector<std::vector<std::array<double, 2>>>>();
  return entry;
}

Json ledger_json(const Scene& scene) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  Json rows = Json::array();
  for (const LedgerEntry& entry : scene.ledger) {
    Json box;
    for (const Vec3& corner : entry.box ? std::vector<Vec3>{entry.box->min, entry.box->max} : std::vector<Vec3>{}) {
      for (const double value : corner) box.push_back(number(value));
    }
    const Json object = {entry.object.name, entry.object.source_id, static_cast<int>(entry.object.kind)};
    rows.push_back({object, entry.what, entry.reason, box, entry.height_m ? Json(*entry.height_m) : Json(),
                    entry.stand_in ? Json(*entry.stand_in) : Json(), entry.instead, entry.may_be_larger,
                    entry.outlines});
  }
  return rows;
}

Json from_arrays(const Json& a) {
  LoadedScene loaded;
  loaded.scene.mesh = mesh_of(a);
  loaded.scene.object_of = indices_of(a.at("object_of"));
  for (const Json& row : a.at("objects")) {
    loaded.scene.objects.push_back(
        {row.at(0).get<std::string>(), row.at(1).get<std::string>(), static_cast<ObjectKind>(row.at(2).get<int>())});
  }
  if (const Json& place = a.at("place"); !place.is_null()) loaded.scene.georeference = place_of(place);
  for (const Json& row : a.at("ledger")) loaded.scene.ledger.push_back(entry_of(row));
  loaded.scene.attribution = a.at("attribution").get<std::string>();
  if (auto& known = loaded.scene.georeference) known->attribution = attribution_of(loaded.scene);  // for files
  if (const Json& whole = a.at("whole"); !whole.is_null()) {
    const auto at = whole.get<std::array<double, 6>>();
    loaded.scene.whole = Box{Vec3(at.data()), Vec3(at.data() + 3)};
  }
  auto scene = std::make_shared<HeldScene>();
  scene->loaded = std::make_shared<const LoadedScene>(std::move(loaded));
  if (const Json& level = a.at("sea_level_m"); !level.is_null()) scene->sea_level_m = level.get<double>();
  return keep(std::move(scene));
}

Json objects_json(const Scene& scene) {
  Json rows = Json::array();
  for (const SceneObject& object : scene.objects)
    rows.push_back({object.name, object.source_id, static_cast<int>(object.kind)});
  return rows;
}

Json facts(const Json& a) {
  const auto held_scene = held<HeldScene>(a, "scene");
  const Scene& scene = held_scene->scene();
  Json whole;
  if (scene.whole) {
    const Box& box = *scene.whole;
    whole = {box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()};
  }
  return {{"vertices", array_at(scene.mesh.vertices, 3)},
          {"faces", array_at(scene.mesh.triangles, 3)},
          {"object_of", array_at(scene.object_of)},
          {"objects", objects_json(scene)},
          {"ledger_rows", ledger_json(scene)},
          {"place", place_json(scene.georeference)},
          {"projection", projection_json(scene.georeference)},
          {"attribution", attribution_of(scene)},
          {"source", scene.source.string()},
          {"sea_level_m", held_scene->sea_level_m ? Json(*held_scene->sea_level_m) : Json()},
          {"whole", std::move(whole)}};
}

Json position(const Json& a) {
  const auto& place = held<HeldScene>(a, "scene")->scene().georeference;
  if (!place) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies", "",
                "use positions in the scene's frame, or give the scene an origin");
  }
  const Eigen::Vector2d at = scene_position(*place, a.at("longitude_deg").get<double>(),
                                            a.at("latitude_deg").get<double>(), a.at("z_m").get<double>());
  return {at.x(), at.y()};
}

Json frame_is_map(const Json& a) { return is_map(place_of(a.at("place"))); }

Json is_swapped(const Json& a) {
  const auto scene = held<HeldScene>(a, "scene");
  const auto& place = scene->scene().georeference;
  return place && seems_swapped(*place, bounding_box(scene->scene().mesh), a.at("longitude_deg").get<double>(),
                                a.at("latitude_deg").get<double>());
}

}  // namespace

void add_scene_calls(Calls& calls) {
  calls["load_scene"] = &load;
  calls["scene_from_arrays"] = &from_arrays;
  calls["scene_facts"] = &facts;
  calls["scene_hash"] = [](const Json& a) -> Json { return held<HeldScene>(a, "scene")->hash(); };
  calls["set_scene_source"] = [](const Json& a) -> Json {
    held<HeldScene>(a, "scene")->source =
        read_scene_text(a.at("text").get<std::string>(), a.at("name").get<std::string>()).scene;
    return nullptr;
  };
  calls["prepare_scene"] = [](const Json& a) -> Json {
    held<HeldScene>(a, "scene")->prepared(tell_progress);
    return nullptr;
  };
  calls["scene_report"] = [](const Json& a) -> Json {
    const auto scene = held<HeldScene>(a, "scene");
    return json_text(*scene->loaded, scene->prepared(tell_progress).statistics());
  };
  calls["save_scene"] = [](const Json& a) -> Json {
    return write_scene(held<HeldScene>(a, "scene")->scene(), a.at("file").get<std::string>());
  };
  calls["scene_position"] = &position;
  calls["is_map"] = &frame_is_map;
  calls["seems_swapped"] = &is_swapped;
  calls["free_scene"] = [](const Json& a) -> Json { return table<HeldScene>().erase(a.at("object").get<Handle>()); };
}

}  // namespace vantage::wasm
