#include "arrangement/subdivision.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/parallel.h"

namespace vantage::internal::arrangement {
namespace {

/// Whether a meeting's half-edges run from its begin to its end. For one who stands on b, a meeting begins at its end.
constexpr std::array<bool, 4> kRunsAlong{true, false, false, true};

}  // namespace

class SubdivisionBuilder {
 public:
  SubdivisionBuilder(const Soup& soup, const Meetings& meetings, const Lines& lines)
      : soup_(soup), meetings_(meetings), lines_(lines) {}

  std::optional<Subdivision> build();

 private:
  std::uint32_t edges() const { return static_cast<std::uint32_t>(soup_.edges().size()); }
  std::uint32_t pieces_of_meeting(std::uint32_t m) const {
    return static_cast<std::uint32_t>(lines_.on_meetings[m].size()) + 1;
  }
  std::uint32_t pieces_of_edge(std::uint32_t e) const {
    return static_cast<std::uint32_t>(lines_.on_edges[e].size()) + 1;
  }
  void number();
  void find_places();
  void fill_edge(std::uint32_t e);
  void fill_meeting(std::uint32_t m);
  std::uint32_t node_on_meeting(std::uint32_t m, std::uint32_t place) const;
  std::uint32_t first_on_edge(std::uint32_t facet, std::uint32_t side) const;
  std::uint32_t from_crossing_into(const Crossing& crossing, std::uint32_t which) const;
  std::uint32_t after_end(std::uint32_t m, std::uint32_t crossing, std::uint32_t facet) const;
  std::uint32_t after_triple(std::uint32_t m, std::uint32_t triple, std::uint32_t facet, bool is_inside) const;
  std::uint32_t meeting_half(std::uint32_t m, std::uint32_t piece, std::uint32_t side) const {
    return out_.first_of_line_[edges() + m] + 4 * piece + side;
  }

  const Soup& soup_;
  const Meetings& meetings_;
  const Lines& lines_;
  Subdivision out_;
  std::uint32_t first_crossing_ = 0, first_triple_ = 0;         // nodes
  std::vector<std::uint32_t> place_on_edge_;                    // of a crossing among those on its edge
  std::vector<std::array<std::uint32_t, 3>> place_on_meeting_;  // of a triple point among those on its meetings
};

void SubdivisionBuilder::number() {
  std::uint32_t count = 0;
  for (std::uint32_t e = 0; e < edges(); ++e) {
    out_.first_of_line_.push_back(count);
    count += 2 * pieces_of_edge(e);
  }
  out_.first_of_meetings_ = count;
  for (std::uint32_t m = 0; m < meetings_.meetings.size(); ++m) {
    out_.first_of_line_.push_back(count);
    count += 4 * pieces_of_meeting(m);
  }
  for (auto* list : {&out_.next_, &out_.head_, &out_.line_, &out_.facet_}) list->resize(count, kNone);
  first_crossing_ = static_cast<std::uint32_t>(soup_.points().size());
  first_triple_ = first_crossing_ + static_cast<std::uint32_t>(meetings_.crossings.size());
  out_.nodes_ = first_triple_ + lines_.triples.size();
}

void SubdivisionBuilder::find_places() {
  place_on_edge_.resize(meetings_.crossings.size());
  for (std::uint32_t e = 0; e < edges(); ++e) {
    const std::span<const std::uint32_t> list = lines_.on_edges[e];
    for (std::uint32_t i = 0; i < list.size(); ++i) place_on_edge_[list[i]] = i;
  }
  place_on_meeting_.resize(lines_.triples.size());
  for (std::uint32_t m = 0; m < meetings_.meetings.size(); ++m) {
    const std::span<const std::uint32_t> list = lines_.on_meetings[m];
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      const auto& of = lines_.triples[list[i]].meetings;
      const auto which = static_cast<std::size_t>(std::find(of.begin(), of.end(), m) - of.begin());
      place_on_meeting_[list[i]][which] = i;
    }
  }
}

/// The first half-edge of a facet's side, from its corner of the same number.
std::uint32_t SubdivisionBuilder::first_on_edge(std::uint32_t facet, std::uint32_t side) const {
  const std::uint32_t e = soup_.facets()[facet].edges[side];
  if (soup_.edges()[e].facets[0] == facet) return out_.first_of_line_[e];
  return out_.first_of_line_[e] + 2 * (pieces_of_edge(e) - 1) + 1;
}

/// From a crossing into the facet on one side of its edge, along the meeting that begins or ends there.
std::uint32_t SubdivisionBuilder::from_crossing_into(const Crossing& crossing, std::uint32_t which) const {
  const std::uint32_t m = crossing.meetings[which];
  // The facet on this side is the meeting's a, or its b.
  const bool is_a = meetings_.meetings[m].b == crossing.facet;
  const bool is_begin = crossing.is_begin[which];
  const std::uint32_t piece = is_begin ? 0 : pieces_of_meeting(m) - 1;
  for (std::uint32_t side = is_a ? 0 : 2;; ++side) {
    if (kRunsAlong[side] == is_begin) return meeting_half(m, piece, side);
  }
}

void SubdivisionBuilder::fill_edge(std::uint32_t e) {
  const Edge& edge = soup_.edges()[e];
  const std::span<const std::uint32_t> list = lines_.on_edges[e];
  const std::uint32_t pieces = pieces_of_edge(e), first = out_.first_of_line_[e];
  const auto after = [&](std::uint32_t facet) {
    const Triangle& sides = soup_.facets()[facet].edges;
    const auto side = static_cast<std::uint32_t>(std::find(sides.begin(), sides.end(), e) - sides.begin());
    return first_on_edge(facet, (side + 1) % 3);
  };
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    const std::uint32_t forth = first + 2 * piece, back = forth + 1;
    out_.line_[forth] = out_.line_[back] = e;
    out_.facet_[forth] = edge.facets[0];
    out_.facet_[back] = edge.facets[1];
    if (piece + 1 == pieces) {
      out_.head_[forth] = edge.to;
      out_.next_[forth] = after(edge.facets[0]);
    } else {
      out_.head_[forth] = first_crossing_ + list[piece];
      out_.next_[forth] = from_crossing_into(meetings_.crossings[list[piece]], 0);
    }
    if (piece == 0) {
      out_.head_[back] = edge.from;
      out_.next_[back] = after(edge.facets[1]);
    } else {
      out_.head_[back] = first_crossing_ + list[piece - 1];
      out_.next_[back] = from_crossing_into(meetings_.crossings[list[piece - 1]], 1);
    }
  }
}

/// `place`: 0 where the meeting begins.
std::uint32_t SubdivisionBuilder::node_on_meeting(std::uint32_t m, std::uint32_t place) const {
  const std::uint32_t pieces = pieces_of_meeting(m);
  if (place == 0) return first_crossing_ + meetings_.meetings[m].ends[0];
  if (place == pieces) return first_crossing_ + meetings_.meetings[m].ends[1];
  return first_triple_ + lines_.on_meetings[m][place - 1];
}

/// What follows on a facet where a meeting comes to one of its ends: the facet's own edge, or, where an edge of the
/// other facet passes through this one, the meeting with what lies beyond that edge.
std::uint32_t SubdivisionBuilder::after_end(std::uint32_t m, std::uint32_t crossing, std::uint32_t facet) const {
  const Crossing& c = meetings_.crossings[crossing];
  const Edge& edge = soup_.edges()[c.edge];
  if (c.facet == facet) {
    const std::uint32_t other = c.meetings[0] == m ? 1 : 0, next = c.meetings[other];
    const bool is_a = meetings_.meetings[next].a == facet, is_begin = c.is_begin[other];
    const std::uint32_t piece = is_begin ? 0 : pieces_of_meeting(next) - 1;
    for (std::uint32_t side = is_a ? 0 : 2;; ++side) {
      if (kRunsAlong[side] == is_begin) return meeting_half(next, piece, side);
    }
  }
  const std::uint32_t first = out_.first_of_line_[c.edge], place = place_on_edge_[crossing];
  return edge.facets[0] == facet ? first + 2 * (place + 1) : first + 2 * place + 1;
}

/// What follows on a facet where another meeting crosses this one: `is_inside`: on the side of the operand that this
/// meeting is with.
std::uint32_t SubdivisionBuilder::after_triple(std::uint32_t m, std::uint32_t triple, std::uint32_t facet,
                                               bool is_inside) const {
  const TriplePoint& t = lines_.triples[triple];
  const auto index = [&](std::uint32_t f) {
    return static_cast<unsigned>(std::find(t.facets.begin(), t.facets.end(), f) - t.facets.begin());
  };
  const Meeting& meeting = meetings_.meetings[m];
  const unsigned x = index(facet), y = index(meeting.a == facet ? meeting.b : meeting.a), z = 3 - x - y;
  const unsigned which = x + z - 1;  // of the meetings of 0 and 1, 0 and 2, 1 and 2
  const bool is_even = (x + 1) % 3 == y;
  // On the facet, its meeting with z, which has z's operand to the left, leaves y's operand where the determinant of
  // the normals of x, y and z is negative.
  const bool leaves = is_even != t.is_positive;
  const bool goes_forward = leaves != is_inside;
  const std::uint32_t next = t.meetings[which], place = place_on_meeting_[triple][which];
  const std::uint32_t side = (x < z ? 0u : 2u) + (goes_forward ? 0u : 1u);
  return meeting_half(next, kRunsAlong[side] ? place + 1 : place, side);
}

void SubdivisionBuilder::fill_meeting(std::uint32_t m) {
  const Meeting& meeting = meetings_.meetings[m];
  const std::uint32_t pieces = pieces_of_meeting(m);
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    for (std::uint32_t side = 0; side < 4; ++side) {
      const std::uint32_t half = meeting_half(m, piece, side), facet = side < 2 ? meeting.a : meeting.b;
      const std::uint32_t place = kRunsAlong[side] ? piece + 1 : piece;
      out_.line_[half] = edges() + m;
      out_.facet_[half] = facet;
      out_.head_[half] = node_on_meeting(m, place);
      if (place == 0 || place == pieces) {
        out_.next_[half] = after_end(m, meeting.ends[place == 0 ? 0 : 1], facet);
      } else {
        out_.next_[half] = after_triple(m, lines_.on_meetings[m][place - 1], facet, side % 2 == 0);
      }
    }
  }
}

std::optional<Subdivision> SubdivisionBuilder::build() {
  number();
  find_places();
  constexpr std::size_t kGrain = 1024;
  parallel::for_ranges(edges(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) fill_edge(static_cast<std::uint32_t>(e));
  });
  parallel::for_ranges(meetings_.meetings.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) fill_meeting(static_cast<std::uint32_t>(m));
  });
  // Each follows one, on the same facet.
  std::vector<char> is_followed(out_.size(), 0);
  for (std::uint32_t half = 0; half < out_.size(); ++half) {
    const std::uint32_t next = out_.next_[half];
    if (next >= out_.size() || out_.facet_[next] != out_.facet_[half] || is_followed[next]++ != 0) return std::nullopt;
  }
  return std::move(out_);
}

std::optional<Subdivision> Subdivision::of(const Soup& soup, const Meetings& meetings, const Lines& lines) {
  return SubdivisionBuilder(soup, meetings, lines).build();
}

}  // namespace vantage::internal::arrangement
