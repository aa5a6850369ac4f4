#include "support/plane_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::testing {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

using Spans = std::vector<std::array<double, 2>>;

/// Where a horizontal line lies inside polygons, which do not overlap.
Spans spans_at(const PlainPolygons& polygons, double y) {
  std::vector<double> crossings;
  for (const auto& polygon : polygons) {
    for (const PlainRing& ring : polygon) {
      for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        const auto &a = ring[i], &b = ring[i + 1];
        if ((a[1] > y) != (b[1] > y)) crossings.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  Spans spans;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) spans.push_back({crossings[i], crossings[i + 1]});
  return spans;
}

Spans united(Spans spans) {
  std::sort(spans.begin(), spans.end());
  Spans result;
  for (const auto& span : spans) {
    if (result.empty() || span[0] > result.back()[1]) {
      result.push_back(span);
    } else {
      result.back()[1] = std::max(result.back()[1], span[1]);
    }
  }
  return result;
}

double common_length(const Spans& a, const Spans& b) {
  double length = 0;
  for (const auto& one : a) {
    for (const auto& other : b) {
      length += std::max(0.0, std::min(one[1], other[1]) - std::max(one[0], other[0]));
    }
  }
  return length;
}

}  // namespace

PlainFrame::PlainFrame(double longitude_deg, double latitude_deg) : longitude_(longitude_deg), latitude_(latitude_deg) {
  constexpr double a = 6378137.0, f = 1 / 298.257223563, e2 = f * (2 - f);
  const double sine = std::sin(latitude_deg * kDegree), w2 = 1 - e2 * sine * sine;
  metres_east_ = a / std::sqrt(w2) * std::cos(latitude_deg * kDegree) * kDegree;
  metres_north_ = a * (1 - e2) / (w2 * std::sqrt(w2)) * kDegree;
}

std::array<double, 2> PlainFrame::operator()(const std::array<double, 2>& lonlat) const {
  return {(lonlat[0] - longitude_) * metres_east_, (lonlat[1] - latitude_) * metres_north_};
}

PlainFrame frame_about(const std::vector<LonLatPolygon>& polygons) {
  const auto& first = polygons.at(0).at(0).at(0);
  return {first[0], first[1]};
}

PlainPolygons in_metres(const std::vector<LonLatPolygon>& polygons, const PlainFrame& frame) {
  PlainPolygons result;
  for (const LonLatPolygon& polygon : polygons) {
    result.emplace_back();
    for (const LonLatRing& ring : polygon) {
      PlainRing& plain = result.back().emplace_back();
      for (const auto& position : ring) plain.push_back(frame(position));
    }
  }
  return result;
}

double plain_area(const PlainPolygons& polygons) {
  double sum = 0;
  for (const auto& polygon : polygons) {
    for (std::size_t r = 0; r < polygon.size(); ++r) {
      double doubled = 0;
      for (std::size_t i = 0; i + 1 < polygon[r].size(); ++i) {
        doubled += polygon[r][i][0] * polygon[r][i + 1][1] - polygon[r][i + 1][0] * polygon[r][i][1];
      }
      sum += (r == 0 ? 0.5 : -0.5) * std::abs(doubled);
    }
  }
  return sum;
}

double covered_area(const PlainPolygons& outline, const std::vector<PlainPolygons>& covering) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& polygon : outline) {
    for (const auto& point : polygon.at(0)) {
      low = std::min(low, point[1]);
      high = std::max(high, point[1]);
    }
  }
  const double step = (high - low) / kScanLines;
  double area = 0;
  for (int line = 0; line < kScanLines; ++line) {
    const double y = low + (line + 0.5) * step;
    const Spans inside = spans_at(outline, y);
    if (inside.empty()) continue;
    Spans covered;
    for (const PlainPolygons& one : covering) {
      for (const auto& span : spans_at(one, y)) covered.push_back(span);
    }
    area += step * common_length(inside, united(std::move(covered)));
  }
  return area;
}

std::array<double, 4> bounds_of(const std::vector<LonLatPolygon>& polygons) {
  std::array<double, 4> bounds = {INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const LonLatPolygon& polygon : polygons) {
    for (const auto& position : polygon.at(0)) {
      bounds = {std::min(bounds[0], position[0]), std::min(bounds[1], position[1]), std::max(bounds[2], position[0]),
                std::max(bounds[3], position[1])};
    }
  }
  return bounds;
}

}  // namespace vantage::testing
