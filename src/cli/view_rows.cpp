#include "cli/view_rows.h"

namespace vantage::cli {

std::string pixel_text(double pixel_m) {
  constexpr double kCentimetre = 0.01, kMillimetre = 0.001;
  return pixel_m < kCentimetre ? fixed(pixel_m / kMillimetre, 2) + " mm" : fixed(pixel_m / kCentimetre, 2) + " cm";
}

void add_place(TextTable& table, const ViewDescription& view) {
  constexpr int kCentimetreOnEarth = 7;  // digits of degrees
  table.row("  position", vector(view.position), "x, y and z in metres, scene frame");
  if (view.longitude_deg && view.latitude_deg) {
    table.row("  on the earth",
              fixed(*view.latitude_deg, kCentimetreOnEarth) + " " + fixed(*view.longitude_deg, kCentimetreOnEarth),
              "latitude and longitude, WGS 84");
  }
  if (view.above_ground_m) table.row("  height", fixed(*view.above_ground_m, 2), "metres above the ground");
  if (view.above_sea_m) table.row("  altitude", fixed(*view.above_sea_m, 2), "metres above mean sea level");
}

void add_sight(TextTable& table, const ViewDescription& view) {
  table.row("  yaw", fixed(view.yaw_deg, 1), "degrees clockwise from north");
  table.row("  pitch", fixed(view.pitch_deg, 1),
            view.is_centred ? "degrees; -90 is straight down"
                            : "degrees; all of the target is in the picture so, but not in its middle");
  table.row("  distance", fixed(view.distance_m, 2), "metres to the target's centre");
  if (view.pixel_m) table.row("  pixel", pixel_text(*view.pixel_m), "on the target, at most");
  if (view.incidence_deg) table.row("  incidence", fixed(*view.incidence_deg, 1), "degrees, at most");
  if (view.obstacle_distance_m) {
    table.row("  clear by", fixed(*view.obstacle_distance_m, 2),
              "metres" + (view.obstacle.empty() ? "" : ": " + view.obstacle + " is nearest"));
  }
}

}  // namespace vantage::cli
