// Pieces of a volume that may be left out whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/pieces.h"
#include "simplify/surface.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

/// Knows of each piece how large it is by now. Never to go: cavities, which would become full; pieces with a cavity in
/// them; the last one.
class WholePieces {
 public:
  WholePieces(const Mesh& mesh, const core::Pieces& pieces);

  /// What is lost for each two facets that go, by the piece of which it is least; nothing where none may go.
  std::optional<double> cheapest_m3() const;

  /// The facets of that piece, if there is a point on the inner side of all of them, exactly: taking out the piece then
  /// takes away what was inside once, and nothing else. Otherwise the piece waits until it has fewer facets.
  std::optional<std::vector<std::uint32_t>> take_cheapest(const Surface& surface);

  /// The piece that was taken stays after all: it does not come again.
  void keep_taken() {
    ++left_;
    ++solid_left_;
  }

  /// An edge of the piece was collapsed.
  void collapsed(std::uint32_t piece, double loss_m3);

  std::size_t left() const { return left_; }  ///< pieces

 private:
  struct State {
    double volume_m3 = 0;
    std::size_t facets = 0;
    std::size_t wait_for = 0;  ///< facets: it is not tried with more
    bool may_go = false;
  };

  double cost(std::uint32_t piece) const;

  std::vector<State> pieces_;
  std::vector<std::vector<std::uint32_t>> facets_;
  std::set<std::pair<double, std::uint32_t>> waiting_;  ///< cost and piece, of those that may go and need not wait
  std::size_t left_, solid_left_ = 0;
};

}  // namespace vantage::internal::simplify
