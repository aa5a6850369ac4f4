#include "app/providers/maps.h"
#include "maps/city/footprint.h"
#include "maps/city/object_outlines.h"
#include "vantage/city.h"
#include "vantage/ground.h"

namespace vantage {

void enable_maps() {
  static constexpr internal::app::MapProvider kProvider{.build_city = build_city,
                                                        .scene_from_raster = scene_from_raster,
                                                        .add_terrain = add_terrain,
                                                        .find_outlines = internal::city::find_outlines,
                                                        .convex_areas = internal::city::convex_areas};
  internal::app::provide(kProvider);
}

}  // namespace vantage
