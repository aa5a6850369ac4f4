// plan_tiles: how a map is cut.
//
// A volume is the same in a tile as in the whole map, bit for bit, because all that it is made of is:
// - the frame, the ground and the origin that the scene is prepared about are those of the whole map (CityFrame);
// - objects come in the order of their ids, and each is built and prepared by itself (Scene::whole);
// - the engine walks from the target outward over groups of polygons, one for each square of kGroupSide, and a group is
//   the same wherever it is complete (build_bvh_of_groups).
// So a tile must have all polygons of every group that comes within reach of a target. A polygon is in a group when the
// middle of its bounds is in the square, and is no larger than the square: it reaches beyond it by half a side. A group
// comes within reach, then, only if its square comes within half a diagonal more than that; the square is a diagonal
// across; and each polygon has a place within half a diagonal of the middle of its bounds. Two diagonals in all.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/input.h"
#include "core/group_side.h"
#include "maps/city/interruption.h"
#include "maps/city/region.h"
#include "maps/city/tile_frame.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::city::Vec2;

constexpr double kBeyondReach = 2 * std::numbers::sqrt2 * internal::core::kGroupSide;

void check_tiling(const CityOptions& options, double size_m, double margin_m) {
  constexpr double kMost = 50e3;  // metres
  const auto refuse = [](const char* what, double value, const char* fix) {
    throw Error(ErrorCode::value_out_of_range, std::string("the ") + what + " of tiles is " + shortest(value) + " m",
                what, fix);
  };
  if (!(size_m >= 1) || !(size_m <= kMost)) refuse("size", size_m, "give metres, from 1 to 50000");
  if (!(margin_m >= 0) || !(margin_m <= kMost)) refuse("margin", margin_m, "give metres, from 0 to 50000");
  const char* const what = options.region.center_deg || options.region.bbox_deg ? "a region"
                           : options.frame                                      ? "a frame"
                           : !options.terrain.empty()                           ? "terrain"
                                                                                : nullptr;
  if (what == nullptr) return;
  throw Error(ErrorCode::not_applicable, std::string("tiles are of a whole map on flat ground, and there is ") + what,
              "tiles", "leave it out");
}

std::size_t count_of(double length, double size_m) {
  constexpr double kMostTiles = 1e6;
  const double count = std::max(1.0, std::ceil(length / size_m));
  if (count <= kMostTiles) return static_cast<std::size_t>(count);
  throw Error(ErrorCode::value_out_of_range, "there would be more than a million tiles", "size", "give a larger size");
}

}  // namespace

std::size_t TilePlan::tile_at(double east_m, double north_m) const {
  const auto index = [&](double from_first, std::size_t count) {
    const double at = std::floor(from_first / size_m);
    return at > 0 ? static_cast<std::size_t>(std::min(at, static_cast<double>(count - 1))) : 0;
  };
  return index(north_m - frame.ground_m[1], rows) * columns + index(east_m - frame.ground_m[0], columns);
}

TilePlan plan_tiles(const std::filesystem::path& file, const CityOptions& options, double size_m, double margin_m,
                    const Progress& progress) {
  check_tiling(options, size_m, margin_m);
  const internal::osm::Extract extract = internal::osm::read_extract(file, {{}, internal::city::wanted}, progress);
  if (!options.partial) internal::city::check_complete(extract, file);
  const internal::geo::LocalFrame frame(internal::city::frame_origin({}, extract));
  const internal::osm::RegionFilter everything({});
  const internal::core::ProgressReporter reporter(progress);
  reporter.begin("outlines");
  const internal::city::Interruption interruption(reporter);
  const internal::city::Site site = internal::city::make_site(extract, everything, frame, options);
  if (site.items.empty()) internal::city::fail_empty({}, extract, site.outside, internal::city::reasons_of(site), file);

  TilePlan plan;
  const Vec2 ground = Vec2::Constant(options.ground_margin_m);
  const Vec2 min = site.min - ground, max = site.max + ground;
  const internal::geo::LonLat origin = frame.origin();
  plan.frame = {{origin.latitude_deg, origin.longitude_deg}, {min.x(), min.y(), max.x(), max.y()}, site.reach_m};
  plan.size_m = size_m;
  plan.margin_m = margin_m;
  plan.columns = count_of(max.x() - min.x(), size_m);
  plan.rows = count_of(max.y() - min.y(), size_m);
  count_of(static_cast<double>(plan.columns) * static_cast<double>(plan.rows), 1);
  const Vec2 margin = Vec2::Constant(margin_m + kBeyondReach);
  for (std::size_t row = 0; row < plan.rows; ++row) {
    for (std::size_t column = 0; column < plan.columns; ++column) {
      const Vec2 low = min + size_m * Vec2(static_cast<double>(column), static_cast<double>(row));
      const Vec2 high = low + Vec2::Constant(size_m);
      Tile& tile = plan.tiles.emplace_back();
      tile.square_m = {low.x(), low.y(), high.x(), high.y()};
      tile.region.bbox_deg = internal::city::degrees_round({low - margin, high + margin}, frame);
    }
  }
  return plan;
}

}  // namespace vantage
