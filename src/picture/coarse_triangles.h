// A rough likeness of many small triangles, for shadows that are rough themselves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/progress_reporter.h"
#include "picture/draw_list.h"

namespace vantage::internal::picture {

/// Corners, three for each triangle: all vertices of a cell of a grid become their mean, and triangles that then have
/// two corners in one place, or are there already, are left out. Nothing moves by more than the diagonal of a cell;
/// what is thinner than a cell may vanish. `triangles`: three vertices for each; `cell` > 0. Cost: O(n log n).
std::vector<Eigen::Vector3f> coarse_triangles(const std::vector<DrawVertex>& triangles, float cell,
                                              const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::picture
