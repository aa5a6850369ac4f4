#include "solid/share_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "vantage/sensor.h"

namespace vantage::internal::solid {
namespace {

/// What a cell costs is counted in this part of a cell of average size. One part alone has cells of one size.
constexpr std::uint64_t kUnitsPerCell = 8;

constexpr double kOneUlp = 0x1p-51;        // of a product with a decimal number that is no binary one
constexpr double kAreaRounding = 0x1p-36;  // of the areas of cells, with what their strips have

double area_of(const TargetFrame& frame) {
  double twice = 0;
  const auto& p = frame.polygon;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Eigen::Vector2d a = p[i] - p[0], b = p[i + 1] - p[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// How many cells each part becomes: as many as its area asks, and at least one.
std::vector<std::size_t> cell_counts(const std::vector<double>& areas, std::size_t cells) {
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<std::size_t> counts;
  std::vector<std::pair<double, std::size_t>> rest;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double wanted = areas[i] / all * static_cast<double>(cells);
    counts.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(wanted)));
    rest.emplace_back(static_cast<double>(counts.back()) - wanted, i);  // the least was rounded down most
  }
  std::stable_sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::size_t given = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  for (std::size_t i = 0; given + i < cells && i < rest.size(); ++i) ++counts[rest[i].second];
  return counts;
}

}  // namespace

SharePlan share_plan(const PreparedTarget& target) {
  const VisibleShare& visible = *target.sensor().visible;
  std::vector<double> areas;
  for (std::size_t i = 0; i < target.part_count(); ++i) areas.push_back(area_of(target.frame(i)));
  SharePlan plan;
  plan.counts = cell_counts(areas, visible.cells);
  const std::uint64_t units = kUnitsPerCell * std::accumulate(plan.counts.begin(), plan.counts.end(), std::uint64_t{0});
  const double unit = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(units);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double cost = areas[i] / static_cast<double>(plan.counts[i]) / unit;
    plan.costs.push_back(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(cost * (1 - kAreaRounding)))));
  }
  plan.budget =
      units - static_cast<std::uint64_t>(std::ceil(visible.share * static_cast<double>(units) * (1 - kOneUlp)));
  std::uint64_t divisor = 0;
  for (const std::uint64_t cost : plan.costs) divisor = std::gcd(divisor, cost);
  for (std::uint64_t& cost : plan.costs) cost /= divisor;
  plan.budget /= divisor;
  return plan;
}

bool has_share(const PreparedTarget& target) {
  if (!target.sensor().visible || target.sensor().visible->share >= 1 || target.target().is_point()) return false;
  const SharePlan plan = share_plan(target);
  return std::any_of(plan.costs.begin(), plan.costs.end(), [&](std::uint64_t cost) { return cost <= plan.budget; });
}

}  // namespace vantage::internal::solid
