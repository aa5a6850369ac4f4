// How much two volumes have in common, and what one takes up at a height of 30 m.
#include "vantage/solid.h"

namespace example {

double common_m3(const vantage::Mesh& a, const vantage::Mesh& b) {
  return vantage::compare_volumes(a, b).intersection_m3;
}

double level_m2(const vantage::Mesh& volume) {
  double area = 0;
  for (const vantage::PlanPolygon& polygon : vantage::slice_mesh(volume, 30)) area += vantage::area_m2(polygon);
  return area;
}

}  // namespace example
