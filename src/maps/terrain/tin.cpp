#include "maps/terrain/tin.h"

#include <CDTUtils.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage::internal::terrain {
namespace {

double orientation(const Vec3& a, const Vec3& b, const Vec3& c) {
  return predicates::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
}

/// Which side of the line from a through b; rounded.
double side(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

Tin::Tin(const std::array<Vec3, 4>& corners) : points_(corners.begin(), corners.end()) {
  facets_.resize(2);
  facets_[0].corner = {0, 1, 2};
  facets_[0].neighbour = {kNone, 1, kNone};
  facets_[1].corner = {0, 2, 3};
  facets_[1].neighbour = {kNone, kNone, 0};
}

std::uint32_t Tin::insert(const Vec3& point) {
  last_ = locate(point, last_);
  const std::uint32_t there = vertex_in_place(last_, point);
  if (there != kNone) return there;
  points_.push_back(point);
  const auto vertex = static_cast<std::uint32_t>(points_.size() - 1);
  insert_vertex(vertex, last_);
  return vertex;
}

std::uint32_t Tin::add_candidates(const std::vector<Vec3>& points) {
  const auto first = static_cast<std::uint32_t>(points_.size());
  add(points);
  return first;
}

void Tin::add_middles(std::vector<Middle> middles) {
  std::vector<Vec3> points;
  points.reserve(middles.size());
  for (const Middle& middle : middles) {
    points.emplace_back((points_[middle.candidates[0]] + points_[middle.candidates[1]]) / 2);
  }
  middles_ = std::move(middles);
  add(points);
}

void Tin::add(const std::vector<Vec3>& points) {
  const std::size_t first = points_.size();
  points_.insert(points_.end(), points.begin(), points.end());
  next_.resize(points_.size(), kNone);
  for (std::size_t i = first; i < points_.size(); ++i) {
    last_ = locate(points_[i], last_);
    const auto candidate = static_cast<std::uint32_t>(i);
    give(candidate, last_, error_over(candidate, facets_[last_].corner));
  }
}

void Tin::refine(double max_error, const std::function<void(double)>& progress) {
  constexpr unsigned kFirst = 1024, kQuiet = 64;  // insertions; each of the first ones may move a million candidates
  queue_ = {};
  for (std::uint32_t f = 0; f < facets_.size(); ++f) queue_.push({facets_[f].error, f, facets_[f].worst});
  for (unsigned count = 0; !queue_.empty() && queue_.top().error > max_error; ++count) {
    const Worst worst = queue_.top();
    queue_.pop();
    if (count < kFirst || count % kQuiet == 0) progress(worst.error);
    const auto facet_of = [&]() -> const Facet& { return facets_[worst.facet]; };
    if (facet_of().worst != worst.candidate || facet_of().error != worst.error) continue;  // replaced since
    if (!insert_for(worst, max_error)) drop(worst.candidate, worst.facet);
    if (facet_of().error > max_error) queue_.push({facet_of().error, worst.facet, facet_of().worst});
  }
}

/// Inserts a candidate, or for a middle the first of its own that is not a vertex yet. False if there is nothing to
/// insert.
bool Tin::insert_for(const Worst& worst, double max_error) {
  const std::size_t first_middle = points_.size() - middles_.size();
  if (worst.candidate < first_middle) return insert_candidate(worst.candidate, worst.facet, max_error);
  const Middle& middle = middles_[worst.candidate - first_middle];
  return std::any_of(middle.candidates.begin(), middle.candidates.end(), [&](std::uint32_t candidate) {
    return candidate != kNone && insert_candidate(candidate, worst.facet, max_error);
  });
}

bool Tin::insert_candidate(std::uint32_t candidate, std::uint32_t start, double max_error) {
  const std::uint32_t over = locate(points_[candidate], start);
  if (vertex_in_place(over, points_[candidate]) != kNone) return false;
  insert_vertex(candidate, over);
  for (const std::uint32_t f : fan_) {
    if (facets_[f].error > max_error) queue_.push({facets_[f].error, f, facets_[f].worst});
  }
  return true;
}

/// The facet that a point lies in, or on the border of: a walk that crosses edges towards it, which ends in a Delaunay
/// triangulation.
std::uint32_t Tin::locate(const Vec3& point, std::uint32_t start) const {
  std::uint32_t facet = start;
  for (;;) {
    const Facet& f = facets_[facet];
    std::uint32_t to = kNone;
    for (std::size_t i = 0; i < 3 && to == kNone; ++i) {
      if (f.neighbour[i] == kNone) continue;
      if (orientation(points_[f.corner[(i + 1) % 3]], points_[f.corner[(i + 2) % 3]], point) < 0) to = f.neighbour[i];
    }
    if (to == kNone) return facet;
    facet = to;
  }
}

std::uint32_t Tin::vertex_in_place(std::uint32_t facet, const Vec3& point) const {
  for (const std::uint32_t corner : facets_[facet].corner) {
    if (points_[corner].x() == point.x() && points_[corner].y() == point.y()) return corner;
  }
  return kNone;
}

bool Tin::in_circle(std::uint32_t facet, const Vec3& point) const {
  const Vec3& a = points_[facets_[facet].corner[0]];
  const Vec3& b = points_[facets_[facet].corner[1]];
  const Vec3& c = points_[facets_[facet].corner[2]];
  return predicates::incircle(a.x(), a.y(), b.x(), b.y(), c.x(), c.y(), point.x(), point.y()) > 0;
}

void Tin::insert_vertex(std::uint32_t vertex, std::uint32_t facet) {
  find_cavity(points_[vertex], facet);
  fill_cavity(vertex);
  share_out(vertex);
  last_ = fan_.front();
}

/// The facets whose circumcircle holds the point, and their rim, counter-clockwise.
void Tin::find_cavity(const Vec3& point, std::uint32_t facet) {
  mark_.resize(facets_.size(), 0);
  ++round_;
  cavity_.assign(1, facet);
  rim_.clear();
  mark_[facet] = round_;
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    const Facet& f = facets_[cavity_[i]];
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t beyond = f.neighbour[side];
      if (beyond != kNone && mark_[beyond] == round_) continue;
      if (beyond != kNone && in_circle(beyond, point)) {
        mark_[beyond] = round_;
        cavity_.push_back(beyond);
      } else {
        rim_.push_back({f.corner[(side + 1) % 3], f.corner[(side + 2) % 3], beyond});
      }
    }
  }
}

/// Joins the rim with the new vertex. Where that lies on the border of the rectangle, the edge that it splits gets no
/// facet. The new facets take the places of the old ones; `fan_` lists them in turn.
void Tin::fill_cavity(std::uint32_t vertex) {
  starting_at_.resize(points_.size(), kNone);
  ending_at_.resize(points_.size(), kNone);
  const auto on_border = [&](const Edge& edge) {
    return edge.outside == kNone && orientation(points_[edge.from], points_[edge.to], points_[vertex]) == 0;
  };
  // The candidates of the old facets, in one chain that begins at the first of the cavity.
  std::uint32_t chain = kNone;
  for (const std::uint32_t f : cavity_) {
    for (std::uint32_t c = facets_[f].candidates; c != kNone;) {
      const std::uint32_t after = next_[c];
      next_[c] = chain;
      chain = c;
      c = after;
    }
  }
  std::size_t used = 0;
  std::uint32_t first = kNone;
  for (const Edge& edge : rim_) {
    std::uint32_t f = kNone;
    if (!on_border(edge)) {
      if (used < cavity_.size()) {
        f = cavity_[used++];
      } else {
        f = static_cast<std::uint32_t>(facets_.size());
        facets_.emplace_back();
      }
      facets_[f] = Facet{{vertex, edge.from, edge.to}, {edge.outside, kNone, kNone}, kNone, kNone, -1};
      if (edge.outside != kNone) {
        Facet& outside = facets_[edge.outside];
        for (std::size_t i = 0; i < 3; ++i) {
          if (outside.corner[(i + 1) % 3] == edge.to && outside.corner[(i + 2) % 3] == edge.from)
            outside.neighbour[i] = f;
        }
      }
    }
    starting_at_[edge.from] = f;
    ending_at_[edge.to] = f;
  }
  for (const Edge& edge : rim_) {
    const std::uint32_t f = starting_at_[edge.from];
    if (f == kNone) continue;
    facets_[f].neighbour[1] = starting_at_[edge.to];
    facets_[f].neighbour[2] = ending_at_[edge.from];
    if (first == kNone || ending_at_[edge.from] == kNone) first = f;  // of an open fan the first
  }
  fan_.clear();
  for (std::uint32_t f = first; f != kNone && (fan_.empty() || f != first); f = facets_[f].neighbour[1])
    fan_.push_back(f);
  facets_[first].candidates = chain;
}

/// Gives each candidate of the cavity to the facet of the fan that it lies over. Candidates follow each other in space
/// more often than not, and fans may have hundreds of facets: the search starts where the last one ended.
void Tin::share_out(std::uint32_t vertex) {
  const Vec3& hub = points_[vertex];
  std::uint32_t candidate = facets_[fan_.front()].candidates;
  facets_[fan_.front()].candidates = kNone;
  std::size_t last = 0;
  while (candidate != kNone) {
    const std::uint32_t after = next_[candidate];
    if (candidate != vertex) {
      const Vec3& point = points_[candidate];
      std::uint32_t over = kNone;
      double from = side(hub, points_[facets_[fan_[last]].corner[1]], point);
      for (std::size_t tried = 0; tried < fan_.size(); ++tried) {
        const Facet& facet = facets_[fan_[last]];
        if (last == 0) from = side(hub, points_[facet.corner[1]], point);  // an open fan does not close
        const double to = side(hub, points_[facet.corner[2]], point);
        if (from >= 0 && to < 0) {
          over = fan_[last];
          break;
        }
        from = to;
        last = last + 1 < fan_.size() ? last + 1 : 0;
      }
      if (over == kNone) over = locate(point, fan_.front());  // on the last spoke, or lost to rounding
      give(candidate, over, error_over(candidate, facets_[over].corner));
    }
    candidate = after;
  }
}

void Tin::give(std::uint32_t candidate, std::uint32_t facet, double error) {
  Facet& f = facets_[facet];
  next_[candidate] = f.candidates;
  f.candidates = candidate;
  if (error > f.error) {
    f.error = error;
    f.worst = candidate;
  }
}

double Tin::error_over(std::uint32_t candidate, const std::array<std::uint32_t, 3>& corner) const {
  const Vec3& a = points_[corner[0]];
  const Vec3 b = points_[corner[1]] - a, c = points_[corner[2]] - a;
  const Vec3 p = points_[candidate] - a;
  const double area = b.x() * c.y() - b.y() * c.x();
  const double along_b = (p.x() * c.y() - p.y() * c.x()) / area, along_c = (b.x() * p.y() - b.y() * p.x()) / area;
  return std::abs(along_b * b.z() + along_c * c.z() - p.z());
}

void Tin::drop(std::uint32_t candidate, std::uint32_t facet) {
  std::uint32_t chain = facets_[facet].candidates;
  facets_[facet].candidates = facets_[facet].worst = kNone;
  facets_[facet].error = -1;
  while (chain != kNone) {
    const std::uint32_t after = next_[chain];
    if (chain != candidate) give(chain, facet, error_over(chain, facets_[facet].corner));
    chain = after;
  }
}

}  // namespace vantage::internal::terrain
