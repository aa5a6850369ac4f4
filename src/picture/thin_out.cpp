#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/parallel.h"
#include "picture/creases.h"

namespace vantage::internal::picture {
namespace {

constexpr double kCell = 14;       // pixels (of a picture of 1600 x 1200) along a side of the cells that are counted
constexpr double kMostInk = 0.16;  // of a cell's area; from half of it on lines fade
constexpr double kMostBorderInk = 0.5;  // the same for borders alone
constexpr double kLongEnough = 120;     // pixels: what is longer is not more important
constexpr double kLeastStrength = 0.04;
constexpr double kMarginPixels = 4;  // round the picture

struct Stroke {
  Eigen::Vector2d a, b;  ///< pixels
  double length = 0, rank = 0;
  std::uint32_t crease = 0;
};

/// What part of each cell of the picture is ink.
class InkMap {
 public:
  InkMap(const View& view, double unit)
      : size_(kCell * unit),
        columns_(static_cast<int>(std::ceil((view.width + 2 * kMarginPixels) / size_)) + 1),
        rows_(static_cast<int>(std::ceil((view.height + 2 * kMarginPixels) / size_)) + 1),
        ink_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

  /// The part of a stroke's opacity that there is room for, on average along it; that much is inked.
  double take(const Stroke& stroke, double width, double opacity, double most) {
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * stroke.length / size_)));
    cells_.clear();
    double room = 0;
    for (int i = 0; i < steps; ++i) {
      const std::ptrdiff_t cell = cell_at(stroke.a + (stroke.b - stroke.a) * ((i + 0.5) / steps));
      if (cell < 0) continue;
      cells_.push_back(static_cast<std::size_t>(cell));
      room += std::clamp(2 - 2 * ink_[cells_.back()] / most, 0.0, 1.0);
    }
    if (cells_.empty()) return 0;
    const double share = room / static_cast<double>(cells_.size());
    // A dot is as wide as it is long at the least: a pixel.
    const double ink = std::max(stroke.length, 1.0) * width * opacity * share / steps / (size_ * size_);
    for (const std::size_t cell : cells_) ink_[cell] += ink;
    return share;
  }

 private:
  std::ptrdiff_t cell_at(const Eigen::Vector2d& pixel) const {
    const int column = static_cast<int>(std::floor((pixel.x() + kMarginPixels) / size_));
    const int row = static_cast<int>(std::floor((pixel.y() + kMarginPixels) / size_));
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
    return static_cast<std::ptrdiff_t>(row) * columns_ + column;
  }

  double size_;
  int columns_, rows_;
  std::vector<double> ink_;
  std::vector<std::size_t> cells_;
};

}  // namespace

std::vector<Crease> thin_out(const std::vector<Crease>& creases, const View& view, double unit,
                             const core::ProgressReporter& progress) {
  const Eigen::AlignedBox2d picture(Eigen::Vector2d(-kMarginPixels, -kMarginPixels),
                                    Eigen::Vector2d(view.width + kMarginPixels, view.height + kMarginPixels));
  std::vector<Crease> result;
  std::vector<Stroke> strokes;
  for (std::uint32_t i = 0; i < creases.size(); ++i) {
    progress.tick();
    const Crease& crease = creases[i];
    if (view.perspective && std::min(view.depth(crease.a), view.depth(crease.b)) < view.near_m) {
      result.push_back(crease);  // it has no two ends in the picture
      continue;
    }
    Stroke stroke{view.pixel(crease.a), view.pixel(crease.b), 0, 0, i};
    if (!picture.intersects(Eigen::AlignedBox2d(stroke.a.cwiseMin(stroke.b), stroke.a.cwiseMax(stroke.b)))) continue;
    stroke.length = (stroke.b - stroke.a).norm();
    stroke.rank = crease.is_border ? 2 * kLongEnough : crease.strength * std::min(stroke.length, kLongEnough * unit);
    strokes.push_back(stroke);
  }
  parallel::sort(strokes, [](const Stroke& one, const Stroke& other) {
    return one.rank != other.rank ? one.rank > other.rank : one.crease < other.crease;
  });
  InkMap map(view, unit);
  for (const Stroke& stroke : strokes) {
    progress.tick();
    Crease crease = creases[stroke.crease];
    crease.strength *= map.take(stroke, unit * crease_width(crease.strength), crease_opacity(crease.strength),
                                crease.is_border ? kMostBorderInk : kMostInk);
    if (crease.strength >= kLeastStrength) result.push_back(crease);
  }
  return result;
}

}  // namespace vantage::internal::picture
