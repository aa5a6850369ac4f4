// Maps in tiles.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "bindings.h"
#include "calls.h"
#include "vantage/city.h"
#include "vantage/georeference.h"
#include "vantage/mission.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

/// Origin, ground and reach.
using FrameRow = std::tuple<std::array<double, 2>, std::array<double, 4>, double>;
/// Square in metres, region in degrees.
using TileRow = std::tuple<std::array<double, 4>, std::array<double, 4>>;

std::tuple<FrameRow, std::vector<TileRow>> planned_tiles(const std::string& text, const std::string& name,
                                                         double size_m, double margin_m, nb::object progress) {
  const TilePlan made = computed(std::move(progress), 0, [&](const Progress& told) {
    const MissionFile mission = read_scene_text(text, name);
    return plan_tiles(mission.scene.file, mission.scene.city, size_m, margin_m, told);
  });
  std::vector<TileRow> rows;
  for (const Tile& tile : made.tiles) rows.emplace_back(tile.square_m, *tile.region.bbox_deg);
  const FrameRow frame{made.frame.origin_deg, made.frame.ground_m, made.frame.reach_m};
  return {frame, std::move(rows)};
}

/// Metres east and north of an origin.
std::pair<double, double> position(const std::array<double, 2>& origin_deg, double latitude_deg, double longitude_deg) {
  const Eigen::Vector2d at = scene_position({origin_deg[0], origin_deg[1], "", ""}, longitude_deg, latitude_deg);
  return {at.x(), at.y()};
}

}  // namespace

void bind_tiles(nb::module_& module) {
  module.def("plan_tiles", &planned_tiles, "text"_a, "name"_a, "size_m"_a, "margin_m"_a, "progress"_a = nb::none());
  module.def("position", &position, "origin_deg"_a, "latitude_deg"_a, "longitude_deg"_a);
}

}  // namespace vantage::python
