// The regions of a certificate in whole numbers, and the parts that planes cut them into.
//
// Lengths are in units of 2^-bits m, and no coordinate has a finer part. Corners of cut polygons are quotients; what is
// asked of them is rounded down to a unit, which Cell::least takes off again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flight/judge/big_integer.h"

namespace vantage::internal::flight::judge {

/// The certificate does not prove what it says.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void demand(bool holds, const char* problem) {
  if (!holds) throw Refusal(problem);
}

inline constexpr std::int64_t kUnit = std::int64_t{1} << 30;  // of vectors: 1

/// Whole, in units of 1 / kUnit: of certificates none is longer than 1, so that sums of four stay far from overflowing.
using Direction = std::array<std::int64_t, 3>;

using WholePoint = std::array<BigInteger, 3>;

BigInteger dot(const Direction& direction, const WholePoint& point);

/// Corners that cells share.
class Corners {
 public:
  explicit Corners(int bits) : bits_(bits) {}

  struct Corner {
    WholePoint over;  ///< with `under` > 0: the point over / under
    BigInteger under = 1;
    WholePoint rounded;                        ///< down
    std::array<double, 3> near_m = {0, 0, 0};  ///< rounded, to a relative 2^-52
  };

  std::uint32_t add(WholePoint over, BigInteger under);
  const Corner& operator[](std::uint32_t corner) const { return corners_[corner]; }

 private:
  int bits_;
  std::vector<Corner> corners_;
};

/// What of a region lies on some sides of planes: convex polygons, whose hull is meant.
class Cell {
 public:
  /// `polygons`: corners one after the other; `ends`: of each the place behind its last one.
  Cell(Corners& corners, std::size_t region, std::vector<std::uint32_t> polygons, std::vector<std::uint32_t> ends,
       bool is_cut);

  std::size_t region() const { return region_; }
  bool is_empty() const { return points_.empty(); }

  /// Not more than direction . point of any point of it, in units of lengths times those of vectors; of a cell that was
  /// not cut exactly the least. Throws Refusal for an empty cell.
  const BigInteger& least(const Direction& direction);

  /// What is above the plane normal . x = offset, and below it; both with what lies in it. Kept: the same again for the
  /// same plane. Throws std::length_error where all cells together would take too much memory.
  std::array<Cell*, 2> cut(const std::array<int, 3>& normal, const BigInteger& offset);

 private:
  std::unique_ptr<Cell> side(const std::array<int, 3>& normal, const BigInteger& offset, int side);

  Corners& corners_;
  std::size_t region_;
  std::vector<std::uint32_t> polygons_, ends_, points_;
  bool is_cut_;
  std::map<Direction, BigInteger> known_;
  std::map<std::pair<std::array<int, 3>, BigInteger>, std::array<std::unique_ptr<Cell>, 2>> parts_;
};

}  // namespace vantage::internal::flight::judge
