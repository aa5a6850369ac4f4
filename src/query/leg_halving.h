// Legs that are halved where nothing is sure of them as a whole.
#pragma once

#include <deque>

#include "query/leg_intervals.h"

namespace vantage::internal::query {

/// Calls look(piece, is_last) with these parts of a leg, and with both halves of each piece for which it returns true:
/// longer ones first. A leg along a border is on neither side of it at any length. So there are at most so many pieces
/// that may be halved, and of those of a whole leg that are left then none is longer than an 8192nd of it.
template <typename Look>
void halve(const LegIntervals& parts, const Look& look) {
  constexpr int kMostPieces = 20'000;
  std::deque<LegInterval> waiting(parts.begin(), parts.end());
  for (int pieces = 0; !waiting.empty(); ++pieces) {
    const LegInterval piece = waiting.front();
    waiting.pop_front();
    const bool is_last = pieces >= kMostPieces;
    if (!look(piece, is_last) || is_last) continue;
    const double middle = 0.5 * (piece.begin + piece.end);
    waiting.push_back({piece.begin, middle});
    waiting.push_back({middle, piece.end});
  }
}

}  // namespace vantage::internal::query
