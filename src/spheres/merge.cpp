#include "spheres/merge.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace vantage::internal::spheres {
namespace {

/// Vertices [left, right] x [bottom, top] of a face, both ends included.
struct Rectangle {
  int left, bottom, right, top;

  int width() const { return right - left; }
  int height() const { return top - bottom; }
  bool is_cell() const { return width() == 1 && height() == 1; }
};

/// Halves one face until nothing but flat rectangles and single cells is left, then joins cells in a row: along upright
/// edges of buildings depth jumps in one column of cells after another, always in the same way.
class FaceSplitter {
 public:
  FaceSplitter(const StarMesh& star, const FaceGrid& grid, double tolerance)
      : grid_(grid), side_(grid.cells + 1), tolerance_(tolerance) {
    inverse_.reserve(grid.vertex.size());
    at_range_.reserve(grid.vertex.size());
    for (const std::uint32_t v : grid.vertex) {
      inverse_.push_back(1 / star.rays[v].lpNorm<Eigen::Infinity>());
      at_range_.push_back(star.at_range[v]);
    }
  }

  void split(const Rectangle& r) {
    const bool at_range = is_at_range(r), flat = has_middle(r) && !at_range && is_flat(r);
    if (r.is_cell() || flat || (at_range && may_follow_range(r))) {
      whole_.push_back(r);
      if (flat) flat_.push_back(r);
    } else {
      halve(r);
    }
  }

  void join_cells() {
    std::vector<Rectangle> joined;
    single_.assign(static_cast<std::size_t>(grid_.cells) * grid_.cells, 0);
    for (const Rectangle& r : whole_) {
      if (r.is_cell() && !is_at_range(r)) {
        single(r.left, r.bottom) = 1;
      } else {
        joined.push_back(r);
      }
    }
    for (const Rectangle& r : whole_) {
      if (r.is_cell() && single(r.left, r.bottom)) joined.push_back(longest_strip(r));
    }
    whole_ = std::move(joined);
  }

  const std::vector<Rectangle>& whole() const { return whole_; }  ///< all
  const std::vector<Rectangle>& flat() const { return flat_; }    ///< of these, what was joined because it is flat

 private:
  std::uint8_t& single(int column, int row) { return single_[static_cast<std::size_t>(row) * grid_.cells + column]; }

  /// From a cell on to the right or upwards; takes its cells from those that are still single.
  Rectangle longest_strip(const Rectangle& cell) {
    Rectangle wide = cell, high = cell;
    while (wide.right < grid_.cells && single(wide.right, wide.bottom) &&
           is_flat({wide.left, wide.bottom, wide.right + 1, wide.top}))
      ++wide.right;
    while (high.top < grid_.cells && single(high.left, high.top) &&
           is_flat({high.left, high.bottom, high.right, high.top + 1}))
      ++high.top;
    const Rectangle strip = wide.width() >= high.height() ? wide : high;
    for (int row = strip.bottom; row < strip.top; ++row)
      for (int column = strip.left; column < strip.right; ++column) single(column, row) = 0;
    if (!strip.is_cell()) flat_.push_back(strip);
    return strip;
  }

  double at(int column, int row) const { return inverse_[static_cast<std::size_t>(row) * side_ + column]; }

  void halve(const Rectangle& r) {
    const int column = r.left + r.width() / 2, row = r.bottom + r.height() / 2;
    const bool wide = r.width() > 1, high = r.height() > 1;
    split({r.left, r.bottom, wide ? column : r.right, high ? row : r.top});
    if (wide) split({column, r.bottom, r.right, high ? row : r.top});
    if (high) split({r.left, row, wide ? column : r.right, r.top});
    if (wide && high) split({column, row, r.right, r.top});
  }

  // A fan needs a vertex inside.
  static bool has_middle(const Rectangle& r) { return r.width() >= 2 && r.height() >= 2; }

  bool is_at_range(const Rectangle& r) const {
    for (int row = r.bottom; row <= r.top; ++row) {
      for (int column = r.left; column <= r.right; ++column)
        if (!at_range_[static_cast<std::size_t>(row) * side_ + column]) return false;
    }
    return true;
  }

  /// Chords of the range ball lie inside it, and the one that leaves it farthest spans the diagonal. The point of a
  /// rectangle nearest to the middle of the face must be a vertex: there the ball reaches deepest, and what is seen up
  /// to the range is known of vertices.
  bool may_follow_range(const Rectangle& r) const {
    const double diagonal = grid_.step * std::hypot(r.width(), r.height());
    const auto straddles = [&](int low, int high) {
      return grid_.cells % 2 && 2 * low < grid_.cells && 2 * high > grid_.cells;
    };
    return has_middle(r) && diagonal * diagonal <= 8 * tolerance_ && !straddles(r.left, r.right) &&
           !straddles(r.bottom, r.top);
  }

  bool is_flat(const Rectangle& r) const {
    const double a = at(r.left, r.bottom), b = at(r.right, r.bottom), c = at(r.left, r.top), d = at(r.right, r.top);
    const double along_u = 0.5 * (b - a + d - c) / r.width(), along_v = 0.5 * (c - a + d - b) / r.height();
    const double start = 0.25 * (a + b + c + d) - 0.5 * (along_u * r.width() + along_v * r.height());
    double least = std::min({a, b, c, d});
    const auto fits = [&](int column, int row) {
      const double w = at(column, row);
      least = std::min(least, w);
      return std::abs(w - (start + along_u * (column - r.left) + along_v * (row - r.bottom))) <=
             0.5 * tolerance_ * least;
    };
    // The least may yet fall after a vertex was taken: those are looked at again.
    const auto all_fit = [&] {
      for (int row = r.bottom; row <= r.top; ++row) {
        for (int column = r.left; column <= r.right; ++column)
          if (!fits(column, row)) return false;
      }
      return true;
    };
    return fits((r.left + r.right) / 2, (r.bottom + r.top) / 2) && all_fit() && all_fit();
  }

  const FaceGrid& grid_;
  std::size_t side_;
  double tolerance_;
  std::vector<double> inverse_;
  std::vector<std::uint8_t> at_range_;
  std::vector<std::uint8_t> single_;  // per cell: not joined with any other yet
  std::vector<Rectangle> whole_, flat_;
};

/// The vertices on the border of a rectangle that some facet uses, counter-clockwise as (column, row).
void border_of(const Rectangle& r, const FaceGrid& grid, const std::vector<std::uint8_t>& is_used,
               std::vector<std::uint32_t>& border) {
  const std::size_t side = static_cast<std::size_t>(grid.cells) + 1;
  border.clear();
  const auto take = [&](int column, int row) {
    const std::uint32_t v = grid.vertex[static_cast<std::size_t>(row) * side + column];
    if (is_used[v]) border.push_back(v);
  };
  for (int i = r.left; i < r.right; ++i) take(i, r.bottom);
  for (int j = r.bottom; j < r.top; ++j) take(r.right, j);
  for (int i = r.right; i > r.left; --i) take(i, r.top);
  for (int j = r.top; j > r.bottom; --j) take(r.left, j);
}

/// Where the four corners are in the border.
std::array<std::size_t, 4> corner_places(const Rectangle& r, const FaceGrid& grid,
                                         const std::vector<std::uint32_t>& border) {
  const std::size_t side = static_cast<std::size_t>(grid.cells) + 1;
  const auto place = [&](int column, int row) {
    return static_cast<std::size_t>(
        std::find(border.begin(), border.end(), grid.vertex[static_cast<std::size_t>(row) * side + column]) -
        border.begin());
  };
  return {place(r.left, r.bottom), place(r.right, r.bottom), place(r.right, r.top), place(r.left, r.top)};
}

/// A strip one cell wide: triangles between the vertices of its two long sides.
void add_strip(const Rectangle& r, const std::vector<std::uint32_t>& border, const std::array<std::size_t, 4>& corner,
               std::vector<Triangle>& facets) {
  // `near` runs from one short side to the other, `far` beside it, the other way round the border.
  const std::size_t count = border.size(), first = r.height() == 1 ? corner[0] : corner[1],
                    last = r.height() == 1 ? corner[1] : corner[2];
  std::vector<std::uint32_t> near, far;
  for (std::size_t k = first;; k = (k + 1) % count) {
    near.push_back(border[k]);
    if (k == last) break;
  }
  for (std::size_t k = (first + count - 1) % count; k != last; k = (k + count - 1) % count) far.push_back(border[k]);
  std::size_t i = 0, j = 0;
  while (i + 1 < near.size() || j + 1 < far.size()) {
    // In step, by the share of each chain that is done: on which of the two a triangle stands is a matter of shape
    // only.
    const bool on_near =
        j + 1 == far.size() || (i + 1 < near.size() && (i + 1) * (far.size() - 1) <= (j + 1) * (near.size() - 1));
    if (on_near) {
      facets.push_back({near[i], far[j], near[i + 1]});
      ++i;
    } else {
      facets.push_back({near[i], far[j], far[j + 1]});
      ++j;
    }
  }
}

// right x up = -forward: counter-clockwise on the face is clockwise from outside.
void add_facets(const StarMesh& star, const Rectangle& r, const FaceGrid& grid, bool is_inward,
                const std::vector<std::uint32_t>& border, std::vector<Triangle>& facets) {
  if (border.size() == 4) {
    const auto inverse = [&](int k) { return 1 / star.rays[border[k]].lpNorm<Eigen::Infinity>(); };
    // As in the plain grids (sphere_mesh.cpp): always the same diagonal, or the one whose ends are farther away.
    const int k = !is_inward || inverse(0) + inverse(2) <= inverse(1) + inverse(3) ? 0 : 1;
    facets.push_back({border[k], border[k + 2], border[k + 1]});
    facets.push_back({border[k], border[(k + 3) % 4], border[k + 2]});
    return;
  }
  if (r.width() == 1 || r.height() == 1) return add_strip(r, border, corner_places(r, grid, border), facets);
  const std::size_t side = static_cast<std::size_t>(grid.cells) + 1;
  const std::uint32_t middle =
      grid.vertex[static_cast<std::size_t>((r.bottom + r.top) / 2) * side + (r.left + r.right) / 2];
  for (std::size_t k = 0; k < border.size(); ++k)
    facets.push_back({middle, border[(k + 1) % border.size()], border[k]});
}

void mark_used(const FaceGrid& grid, const std::vector<Rectangle>& rectangles, bool keeps_border,
               std::vector<std::uint8_t>& is_used) {
  const std::size_t side = static_cast<std::size_t>(grid.cells) + 1;
  const auto mark = [&](int column, int row) {
    is_used[grid.vertex[static_cast<std::size_t>(row) * side + column]] = 1;
  };
  for (const Rectangle& r : rectangles) {
    mark(r.left, r.bottom);
    mark(r.right, r.bottom);
    mark(r.left, r.top);
    mark(r.right, r.top);
  }
  if (!keeps_border) return;
  for (int i = 0; i <= grid.cells; ++i) {
    mark(i, 0);
    mark(i, grid.cells);
    mark(0, i);
    mark(grid.cells, i);
  }
}

/// Draws in every vertex of the rectangles by the tolerance, once: what a facet between them may rise over those that
/// it replaces.
void tighten(StarMesh& star, const std::vector<FaceGrid>& faces, const std::vector<FaceSplitter>& splits,
             double tolerance) {
  std::vector<std::uint8_t> is_drawn_in(star.rays.size(), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const Rectangle& r : splits[f].flat()) {
      for (int row = r.bottom; row <= r.top; ++row) {
        for (int column = r.left; column <= r.right; ++column)
          is_drawn_in[faces[f].vertex[static_cast<std::size_t>(row) * (faces[f].cells + 1) + column]] = 1;
      }
    }
  }
  for (std::size_t v = 0; v < star.rays.size(); ++v)
    if (is_drawn_in[v]) star.rays[v] *= 1 - tolerance;
}

}  // namespace

void add_merged_facets(StarMesh& star, const std::vector<FaceGrid>& faces, const MergeRules& rules) {
  std::vector<FaceSplitter> splits;
  for (const FaceGrid& grid : faces) splits.emplace_back(star, grid, rules.tolerance);
  parallel::for_ranges(faces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (faces[f].cells > 0) {
        splits[f].split({0, 0, faces[f].cells, faces[f].cells});
        splits[f].join_cells();
      }
    }
  });
  std::vector<std::uint8_t> is_used(star.rays.size(), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) mark_used(faces[f], splits[f].whole(), rules.keeps_borders, is_used);
  if (rules.is_inward) tighten(star, faces, splits, rules.tolerance);

  std::vector<std::vector<Triangle>> facets(faces.size());
  parallel::for_ranges(faces.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> border;
    for (std::size_t f = begin; f < end; ++f) {
      for (const Rectangle& r : splits[f].whole()) {
        border_of(r, faces[f], is_used, border);
        add_facets(star, r, faces[f], rules.is_inward, border, facets[f]);
      }
    }
  });
  for (const std::vector<Triangle>& of_face : facets)
    star.triangles.insert(star.triangles.end(), of_face.begin(), of_face.end());
}

void drop_unused_vertices(StarMesh& star) {
  std::vector<std::uint32_t> index(star.rays.size(), 0);
  for (const Triangle& t : star.triangles)
    for (const std::uint32_t v : t) index[v] = 1;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (!index[v]) continue;
    star.rays[kept] = star.rays[v];
    star.at_range[kept] = star.at_range[v];
    index[v] = kept++;
  }
  star.rays.resize(kept);
  star.at_range.resize(kept);
  for (Triangle& t : star.triangles)
    for (std::uint32_t& v : t) v = index[v];
}

}  // namespace vantage::internal::spheres
