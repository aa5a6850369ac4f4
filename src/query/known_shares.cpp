// PointQuery::known_shares and fraction_field: docs/theory.md, "How much is seen from a box".
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "core/format.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "query/box_view.h"
#include "query/point_query_data.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using internal::query::BoxView;
using internal::query::SightBox;
namespace parallel = internal::parallel;

constexpr std::size_t kMostVoxels = std::size_t{1} << 31;

/// Voxels along the edge of the boxes that threads share.
constexpr std::size_t kBlock = 32;

/// Points that are looked from between two looks at the progress.
constexpr std::size_t kPortion = 1 << 13;

/// Voxels [begin, end) along each axis.
struct Cells {
  std::array<std::size_t, 3> begin, end;
  std::size_t along(int axis) const { return end[axis] - begin[axis]; }
  bool is_one() const { return along(0) == 1 && along(1) == 1 && along(2) == 1; }
};

void fill(const VoxelGrid& grid, const Cells& cells, KnownShare share, std::span<KnownShare> known) {
  for (std::size_t k = cells.begin[2]; k < cells.end[2]; ++k) {
    for (std::size_t j = cells.begin[1]; j < cells.end[1]; ++j) {
      const std::size_t row = (k * grid.count[1] + j) * grid.count[0];
      std::fill_n(known.begin() + static_cast<std::ptrdiff_t>(row + cells.begin[0]), cells.along(0), share);
    }
  }
}

/// Divides boxes of voxels until a box is known or a single voxel. What may hide the target from a part of a box is
/// among what may hide it from the box.
class Divider {
 public:
  /// `front`: of the other side of a target that is seen from both; points on its side are not looked at.
  Divider(const BoxView& view, const BoxView* front, bool is_back_seen, const VoxelGrid& grid,
          std::span<KnownShare> known)
      : view_(view), front_(front), is_back_seen_(is_back_seen), grid_(grid), known_(known) {}

  void divide(const Cells& cells) {
    blockers_.resize(view_.blocker_count());
    for (std::uint32_t b = 0; b < blockers_.size(); ++b) blockers_[b] = b;
    divide(cells, 0, blockers_.size());
  }

 private:
  /// Nothing where the box must be divided.
  std::optional<KnownShare> share_of(const Cells& cells, std::size_t begin, std::size_t end) {
    Vec3 low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = grid_.low[a] + grid_.step_m * static_cast<double>(cells.begin[a]);
      high[a] = grid_.low[a] + grid_.step_m * static_cast<double>(cells.end[a]);
    }
    const SightBox box = view_.box(low, high);
    BoxView::Place place = view_.place_of(box);
    if (place == BoxView::Place::behind) return is_back_seen_ ? KnownShare::unknown : KnownShare::none;
    if (front_) {
      const BoxView::Place of_front = front_->place_of(front_->box(low, high));
      if (of_front == BoxView::Place::in_front) return KnownShare::unknown;
      if (of_front == BoxView::Place::across) place = BoxView::Place::across;
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (view_.may_hide(blockers_[i], box)) blockers_.push_back(blockers_[i]);
    }
    if (place == BoxView::Place::across) return std::nullopt;
    if (blockers_.size() == end) return KnownShare::whole;
    if (view_.hides_all(std::span(blockers_).subspan(end), box)) return KnownShare::none;
    return std::nullopt;
  }

  /// `blockers_` from `begin` to `end`, its end, are those that may matter.
  void divide(const Cells& cells, std::size_t begin, std::size_t end) {
    const std::optional<KnownShare> share = share_of(cells, begin, end);
    const std::size_t last = blockers_.size();
    if (share && *share != KnownShare::unknown) fill(grid_, cells, *share, known_);
    if (!share && !cells.is_one()) {
      std::array<std::size_t, 3> middle;
      for (int a = 0; a < 3; ++a) middle[a] = cells.begin[a] + (cells.along(a) + 1) / 2;
      for (int part = 0; part < 8; ++part) {
        Cells below = cells;
        for (int a = 0; a < 3; ++a) ((part >> a & 1) != 0 ? below.begin : below.end)[a] = middle[a];
        if (below.along(0) > 0 && below.along(1) > 0 && below.along(2) > 0) divide(below, end, last);
      }
    }
    blockers_.resize(end);
  }

  const BoxView& view_;
  const BoxView* front_;
  bool is_back_seen_;
  const VoxelGrid& grid_;
  std::span<KnownShare> known_;
  std::vector<std::uint32_t> blockers_;
};

/// Boxes that cover the grid.
std::vector<Cells> blocks_of(const VoxelGrid& grid) {
  std::vector<Cells> blocks;
  const auto& n = grid.count;
  for (std::size_t k = 0; k < n[2]; k += kBlock) {
    for (std::size_t j = 0; j < n[1]; j += kBlock) {
      for (std::size_t i = 0; i < n[0]; i += kBlock) {
        blocks.push_back(
            {{i, j, k}, {std::min(i + kBlock, n[0]), std::min(j + kBlock, n[1]), std::min(k + kBlock, n[2])}});
      }
    }
  }
  return blocks;
}

double farthest_corner(const VoxelGrid& grid, const Vec3& from) {
  Vec3 farthest = Vec3::Zero();
  for (int a = 0; a < 3; ++a) {
    const double high = grid.low[a] + grid.step_m * static_cast<double>(grid.count[a]);
    farthest[a] = std::max(std::abs(grid.low[a] - from[a]), std::abs(high - from[a]));
  }
  return farthest.norm() * (1 + 1e-9);
}

std::vector<KnownShare> known_of_part(const internal::query::Sides& sides, bool is_point, const VoxelGrid& grid,
                                      const ProgressReporter& progress) {
  std::vector<KnownShare> known(grid.size(), KnownShare::unknown);
  std::vector<std::unique_ptr<BoxView>> views;
  for (const auto& side : sides) {
    const auto& index = side->index_for(farthest_corner(grid, side->frame.origin));
    views.push_back(std::make_unique<BoxView>(*side, index, is_point));
    progress.check();
  }
  const std::vector<Cells> blocks = blocks_of(grid);
  internal::core::ProgressCounter counter(progress, blocks.size() * views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const BoxView* const front = v > 0 ? views[0].get() : nullptr;
    parallel::for_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
      Divider divider(*views[v], front, views.size() > 1, grid, known);
      for (std::size_t i = begin; i < end; ++i) {
        divider.divide(blocks[i]);
        counter.add();
      }
    });
  }
  return known;
}

/// Whether all of the target is within range of a point.
bool is_in_range(const PreparedTarget& target, const Vec3& point, double range) {
  for (std::size_t part = 0; part < target.part_count(); ++part) {
    const TargetFrame& frame = target.frame(part);
    const Vec3 local = frame.to_local(point);
    for (const auto& t : frame.polygon) {
      if (!((local - Vec3(t.x(), t.y(), 0)).squaredNorm() <= range * range)) return false;
    }
  }
  return true;
}

void forget_beyond(const PreparedTarget& target, const VoxelGrid& grid, double range, std::vector<KnownShare>& known) {
  parallel::for_ranges(grid.count[1] * grid.count[2], 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t i = 0; i < grid.count[0]; ++i) {
        KnownShare& share = known[row * grid.count[0] + i];
        if (share == KnownShare::none) continue;
        const Vec3 centre = grid.centre(i, row % grid.count[1], row / grid.count[1]);
        if (!is_in_range(target, centre, range)) share = KnownShare::none;
      }
    }
  });
}

}  // namespace

void check_grid(const VoxelGrid& grid) {
  constexpr double kFarthest = 1e9;  // as for the vertices of a scene
  constexpr const char* kWhere = "grid of voxels";
  if (!grid.low.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "the grid's lowest corner is not finite", kWhere,
                "give three numbers");
  }
  if (!(grid.step_m > 0 && std::isfinite(grid.step_m))) {
    throw Error(ErrorCode::value_out_of_range,
                internal::core::format("a voxel cannot have an edge of {:g} m", grid.step_m), kWhere,
                "give a positive number of metres");
  }
  std::size_t count = 1;
  for (const std::size_t n : grid.count) {
    if (n == 0 || n > kMostVoxels / count) {
      throw Error(
          ErrorCode::value_out_of_range,
          internal::core::format("a grid cannot have {} x {} x {} voxels", grid.count[0], grid.count[1], grid.count[2]),
          kWhere, "take a smaller box or a larger step: 1 to 2,147,483,648 voxels");
    }
    count *= n;
  }
  for (int a = 0; a < 3; ++a) {
    const double high = grid.low[a] + grid.step_m * static_cast<double>(grid.count[a]);
    if (std::abs(grid.low[a]) <= kFarthest && std::abs(high) <= kFarthest) continue;
    throw Error(ErrorCode::coordinate_too_large, "the grid reaches farther than 1e9 m from the origin", kWhere,
                "check its corners");
  }
}

std::vector<KnownShare> PointQuery::known_shares(const VoxelGrid& grid, double max_range_m, const Progress& callback) {
  check_grid(grid);
  internal::query::check_has_share(data_->target);
  if (!(max_range_m > 0)) {
    throw Error(ErrorCode::value_out_of_range, internal::core::format("the range is {:g} m", max_range_m), "max_range",
                "give a positive number of metres");
  }
  const ProgressReporter progress(callback);
  progress.begin("dividing space");
  std::vector<KnownShare> known;
  const std::size_t parts = data_->parts.size();
  for (std::size_t part = 0; part < parts; ++part) {
    const double share = 1.0 / static_cast<double>(parts), from = static_cast<double>(part) * share;
    std::vector<KnownShare> of_part =
        known_of_part(data_->parts[part], data_->target.target().is_point(), grid, progress.part(from, from + share));
    if (part == 0) {
      known = std::move(of_part);
      continue;
    }
    for (std::size_t v = 0; v < known.size(); ++v) {
      if (known[v] != of_part[v]) known[v] = KnownShare::unknown;
    }
  }
  if (!(max_range_m == std::numeric_limits<double>::infinity())) forget_beyond(data_->target, grid, max_range_m, known);
  progress.finish();
  return known;
}

FractionField PointQuery::fraction_field(const VoxelGrid& grid, const FieldOptions& options, const Progress& callback) {
  const std::vector<KnownShare> known = known_shares(grid, options.max_range_m, callback);
  const ProgressReporter progress(callback);
  progress.begin("looking from voxels");
  FractionField field{grid, std::vector<double>(known.size()), 0};
  std::vector<Vec3> points;
  std::vector<std::size_t> voxels;
  const auto look = [&](std::size_t done) {
    const std::vector<PointFraction> found = fractions(points, {options.measure, false});
    for (std::size_t i = 0; i < found.size(); ++i) field.shares[voxels[i]] = found[i].fraction;
    field.evaluated += points.size();
    points.clear();
    voxels.clear();
    progress.report(done, known.size());
  };
  for (std::size_t v = 0; v < known.size(); ++v) {
    if (known[v] == KnownShare::whole) field.shares[v] = 1;
    if (known[v] != KnownShare::unknown) continue;
    const std::size_t row = v / grid.count[0];
    points.push_back(grid.centre(v % grid.count[0], row % grid.count[1], row / grid.count[1]));
    voxels.push_back(v);
    if (points.size() == kPortion) look(v);
  }
  look(known.size());
  progress.finish();
  return field;
}

}  // namespace vantage
