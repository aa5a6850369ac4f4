// Polygons of the plane for Python.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "arrays.h"
#include "vantage/solid.h"

namespace vantage::python {

using PlanView = View<double, nb::shape<-1, 2>>;
/// The rings of each polygon, the outer one first.
using Rings = std::vector<std::vector<PlanView>>;

inline PlanView plan_view(std::vector<Eigen::Vector2d> points) {
  auto kept = std::make_shared<const std::vector<Eigen::Vector2d>>(std::move(points));
  return view_of<PlanView>(kept->empty() ? nullptr : kept->front().data(), {kept->size(), 2}, kept);
}

inline Rings rings_of(std::vector<PlanPolygon> polygons) {
  Rings rings;
  for (PlanPolygon& polygon : polygons) {
    std::vector<PlanView>& of_polygon = rings.emplace_back();
    of_polygon.push_back(plan_view(std::move(polygon.outer)));
    for (PlanPolygon::Ring& hole : polygon.holes) of_polygon.push_back(plan_view(std::move(hole)));
  }
  return rings;
}

}  // namespace vantage::python
