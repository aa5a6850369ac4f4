// A scene of the part of a tileset of 3D Tiles that lies within a radius.
#include "vantage/tileset.h"

namespace example {

vantage::Scene quarter(const char* tileset) {
  vantage::TilesetOptions options;
  options.center_deg = {{35.67, 139.76}};
  options.radius_m = 400;
  options.detail_m = 1;
  const vantage::TilesetScene read = vantage::read_tileset(tileset, options);
  return read.report.holes == 0 ? read.scene : vantage::Scene{};
}

}  // namespace example
