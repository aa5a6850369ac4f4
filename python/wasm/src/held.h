// What Python holds of the engine in WebAssembly: objects by number. python/src/*.h has the same for the native
// package.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/query.h"
#include "vantage/scene.h"
#include "vantage/scene_source.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage::wasm {

using Json = nlohmann::ordered_json;

struct HeldScene {
  std::shared_ptr<const LoadedScene> loaded;
  SceneSource source;
  std::optional<double> sea_level_m;
  std::optional<PreparedScene> ready;
  std::string known_hash;

  const Scene& scene() const { return loaded->scene; }
  const PreparedScene& prepared(const Progress& progress) {
    if (!ready) ready.emplace(PreparedScene(scene(), progress));
    return *ready;
  }
  const std::string& hash() {
    if (known_hash.empty()) known_hash = scene_hash(scene());
    return known_hash;
  }
};

struct HeldMission {
  std::shared_ptr<HeldScene> scene;
  std::shared_ptr<const Mission> mission;
  bool is_part = false;  ///< one of the volumes of a mission that has several

  bool is_in_scene() const { return mission->loaded == scene->loaded; }
  PreparedScene prepared(const Progress& progress) const {
    return is_in_scene() ? scene->prepared(progress) : PreparedScene(mission->scene(), progress);
  }
  RunOptions run_options(const Progress& progress) const {
    RunOptions options;
    if (!is_in_scene()) return options;
    options.prepared = scene->prepared(progress);
    options.scene_hash = scene->hash();
    return options;
  }
};

struct HeldVolume {
  std::shared_ptr<const Volume> volume;
  double rounding_m = 0;    ///< of the file that it was read from
  std::string stated_hash;  ///< that file's; empty: it states none
};

struct HeldResult {
  std::shared_ptr<HeldMission> mission;
  Result result;  ///< without its volume, which `volume` has
  std::shared_ptr<HeldVolume> volume;

  Result whole() const {
    Result copy = result;
    copy.volume = *volume->volume;
    return copy;
  }
};

struct HeldQuery {
  ViewsQuery query;
};

using Handle = std::uint32_t;

Handle new_handle();

template <typename Held>
std::map<Handle, std::shared_ptr<Held>>& table() {
  static std::map<Handle, std::shared_ptr<Held>> one;
  return one;
}

template <typename Held>
Handle keep(std::shared_ptr<Held> object) {
  const Handle handle = new_handle();
  table<Held>().emplace(handle, std::move(object));
  return handle;
}

inline Handle keep_volume(Volume volume, double rounding_m = 0, std::string hash = {}) {
  return keep(std::make_shared<HeldVolume>(
      HeldVolume{std::make_shared<const Volume>(std::move(volume)), rounding_m, std::move(hash)}));
}

/// The object that `arguments[key]` names. Throws std::out_of_range, a defect of the caller.
template <typename Held>
std::shared_ptr<Held> held(const Json& arguments, const char* key) {
  return table<Held>().at(arguments.at(key).template get<Handle>());
}

// ---- arrays: where they lie in the memory, and how many numbers they have

template <typename T>
Json array_at(const std::vector<T>& values, std::size_t numbers_each = 1) {
  return {{"at", reinterpret_cast<std::uintptr_t>(values.data())}, {"count", values.size() * numbers_each}};
}

/// An array that stays until the next call.
Json answer_array(std::vector<double> values);
Json answer_array(std::vector<std::uint8_t> values);

std::vector<Vec3> points_of(const Json& array);
std::vector<std::uint32_t> indices_of(const Json& array);
Mesh mesh_of(const Json& arguments);

inline Json json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json json(const std::vector<Warning>& notes);
/// Of a scene or a volume: latitude, longitude, what heights are measured from, CRS of the source; or null.
Json place_json(const std::optional<Georeference>& place);
Json projection_json(const std::optional<Georeference>& place);
Json error_json(const Error& error);

/// Asks Python whether to go on, with its function of progress.
bool tell_progress(std::string_view stage, double fraction);

using Call = Json (*)(const Json& arguments);
using Calls = std::map<std::string, Call>;

void add_scene_calls(Calls& calls);
void add_mission_calls(Calls& calls);
void add_volume_calls(Calls& calls);
void add_judge_calls(Calls& calls);
void add_list_calls(Calls& calls);

}  // namespace vantage::wasm
