// The best point of a box by branch and bound: boxes are halved until no box can hold anything better (Land and Doig
// 1960; for Lipschitz functions Piyavskii 1972, Shubert 1972).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <queue>
#include <vector>

#include "core/progress_reporter.h"

namespace vantage::internal::flight {

/// A box of N numbers: middles and half widths. The number with the widest half, times its weight, is halved first.
template <std::size_t N>
struct SearchBox {
  SearchBox() { weight.fill(1); }

  std::array<double, N> middle{}, half{}, weight{};
  double bound = std::numeric_limits<double>::infinity();
};

struct SearchLimits {
  double tolerance = 0;        ///< > 0: the search ends where nothing can be better by more
  std::size_t most_boxes = 0;  ///< or after so many
};

struct SearchEnd {
  /// No point is better than this. At most the best value and the tolerance, where the search was not cut short.
  double bound = -std::numeric_limits<double>::infinity();
  bool is_cut = false;  ///< by most_boxes
  std::size_t boxes = 0;
};

/// `Problem` has two functions. bound_of(box) gives an upper bound of the value in a box, minus infinity where it holds
/// nothing that counts; it may also look at points in it and remember the best. best() is the value of the best one so
/// far, minus infinity before there is any. Values are maximised. Deterministic.
template <std::size_t N, typename Problem>
SearchEnd search_box(Problem& problem, const SearchBox<N>& root, const SearchLimits& limits,
                     const core::ProgressReporter& progress) {
  struct Entry {
    SearchBox<N> box;
    std::size_t number = 0;
    bool operator<(const Entry& other) const {
      return box.bound != other.box.bound ? box.bound < other.box.bound : number > other.number;
    }
  };
  std::priority_queue<Entry> queue;
  SearchEnd end;
  const auto add = [&](SearchBox<N> box) {
    ++end.boxes;
    box.bound = std::min(box.bound, problem.bound_of(box));
    if (box.bound > problem.best() + limits.tolerance) {
      queue.push({box, end.boxes});
    } else {
      end.bound = std::max(end.bound, box.bound);
    }
  };
  add(root);
  while (!queue.empty() && queue.top().box.bound > problem.best() + limits.tolerance) {
    if (end.boxes >= limits.most_boxes) {
      end.is_cut = true;
      break;
    }
    progress.tick(end.boxes, limits.most_boxes);
    SearchBox<N> part = queue.top().box;
    queue.pop();
    std::size_t longest = 0;
    for (std::size_t a = 1; a < N; ++a) {
      if (part.half[a] * part.weight[a] > part.half[longest] * part.weight[longest]) longest = a;
    }
    part.half[longest] /= 2;
    const double middle = part.middle[longest];
    for (const double side : {-1.0, 1.0}) {
      part.middle[longest] = middle + side * part.half[longest];
      add(part);
    }
  }
  if (!queue.empty()) end.bound = std::max(end.bound, queue.top().box.bound);
  end.bound = std::max(end.bound, problem.best());
  return end;
}

/// For the weights of lengths of so many metres: flat volumes are thin in one of them, and what bounds their depth is
/// found there.
inline double flatness(double length_m, double longest_m) {
  constexpr double kMost = 64;
  return length_m > 0 ? std::clamp(longest_m / length_m, 1.0, kMost) : 1;
}

/// Walks from a point to better ones beside it, along an axis or two at once, with steps that are halved (a pattern
/// search, after Hooke and Jeeves 1961; two at once, since the least of several depths has ridges). `value(point)` is
/// minus infinity where a point does not count; `start` has the value `from`.
template <std::size_t N, typename Value>
double climb(std::array<double, N>& point, double from, const std::array<double, N>& steps, double least,
             const Value& value) {
  const auto moves = [&](std::size_t a, double along_a, std::size_t b, double along_b) {
    std::array<double, N> next = point;
    next[a] += along_a * steps[a];
    next[b] += along_b * steps[b];
    const double found = value(next);
    if (!(found > from)) return false;
    from = found;
    point = next;
    return true;
  };
  const auto is_better_beside = [&](double scale) {
    for (std::size_t a = 0; a < N; ++a) {
      if (!(steps[a] > 0)) continue;
      if (moves(a, scale, a, 0) || moves(a, -scale, a, 0)) return true;
    }
    for (std::size_t a = 0; a < N; ++a) {
      for (std::size_t b = a + 1; b < N; ++b) {
        if (!(steps[a] > 0) || !(steps[b] > 0)) continue;
        for (const double side : {scale, -scale}) {
          if (moves(a, side, b, side) || moves(a, side, b, -side)) return true;
        }
      }
    }
    return false;
  };
  constexpr int kMostMoves = 16;  // of one size
  for (double scale = 1; scale >= least; scale /= 2) {
    for (int moved = 0; moved < kMostMoves && is_better_beside(scale); ++moved) {
    }
  }
  return from;
}

}  // namespace vantage::internal::flight
