#include "app/find_ground.h"

#include <string>
#include <string_view>
#include <vector>

#include "vantage/error.h"
#include "vantage/ground.h"
#include "vantage/input.h"

namespace vantage::internal::app {
namespace {

Ground named_ground(const Scene& scene, const std::string& name, const std::string& where) {
  std::vector<std::uint32_t> found;
  std::vector<std::string_view> names;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (name == object.name || name == object.source_id || name == display_name(object)) found.push_back(i);
    for (const std::string& known : {std::cref(object.name), std::cref(object.source_id)}) {
      if (!known.empty()) names.push_back(known);
    }
  }
  if (found.size() > 1) {
    throw Error(ErrorCode::unknown_choice,
                std::to_string(found.size()) + " objects of the scene go by the name of " + in_quotes(name), where,
                "name one that is alone with its name, or give the ground's z");
  }
  if (!found.empty()) return ground_of(scene, found.front());
  const std::string nearest(nearest_name(name, names));
  const bool is_like = !nearest.empty() && 2 * static_cast<std::size_t>(edit_distance(name, nearest)) <= name.size();
  throw Error(ErrorCode::object_missing, "the scene has no object " + in_quotes(name), where,
              (is_like ? "did you mean " + in_quotes(nearest) + "? " : "") +
                  std::string("'vantage inspect' lists the scene's objects"));
}

}  // namespace

void find_ground(Mission& mission) {
  auto& limit = mission.navigation.above_ground;
  if (!limit) return;
  const Scene& scene = mission.loaded.scene;
  const std::string& where = mission.as_written.places.above_ground;
  if (const auto& source = mission.as_written.ground) {
    limit->ground = source->plane_z_m ? Ground{*source->plane_z_m} : named_ground(scene, source->object, where);
    return;
  }
  const auto ground = ground_of(scene);
  if (!ground) {
    throw Error(ErrorCode::ground_missing, "the scene does not say what of it is ground, so nothing is above it", where,
                "write 'ground: 0' under 'navigation' for flat ground at z = 0, or 'ground: NAME' for an object of the "
                "scene; or give z: 'altitude: [20, 120]'");
  }
  limit->ground = *ground;
}

}  // namespace vantage::internal::app
