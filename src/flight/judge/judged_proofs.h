// The two proofs of bounds: docs/theory.md, "Tours".
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/judge/judged_cells.h"

namespace vantage::internal::flight::judge {

using Json = nlohmann::json;

/// What a certificate is about.
struct JudgedTour {
  bool closed = true;
  std::vector<std::unique_ptr<Cell>> cells;  ///< the regions
  std::vector<BigInteger> dwell;             ///< of each
  std::vector<bool> is_place;                ///< of each: flights begin and end there, in any direction
  BigInteger turn_radius;                    ///< the track over ground curves no tighter elsewhere; 0: it may
  std::vector<std::size_t> ends;             ///< of an open tour, the first one and then the last one: regions
  int bits = 0;                              ///< units of lengths are 2^-bits m
};

/// A list of a certificate, of `count` entries where that is given. Throws Refusal for anything else.
const Json& list_of(const Json& json, std::optional<std::size_t> count = std::nullopt);

/// A finite number, at most 1e15, in units of 2^-bits. Throws Refusal for anything else, and for a finer one.
BigInteger whole_of(const Json& json, int bits);

/// Throws Refusal unless it is a whole number of 0 to end - 1.
std::size_t index_of(const Json& json, std::size_t end);

/// Three whole numbers each, in units of 1 / kUnit. Throws Refusal for a vector that is longer than 1, or no vector.
std::vector<Direction> vectors_of(const Json& numbers);

/// Throws Refusal unless these are the keys.
void demand_keys(const Json& json, std::span<const char* const> keys, const char* problem);

/// How far over ground it is at least from one cell to another along a vector, in units of lengths times those of
/// vectors; less than 0 where they are not apart.
BigInteger room_between(Cell& from, Cell& to, const Direction& direction);

/// What turning adds at a stop whose legs have these vectors and such rooms; in the same units, rounded down.
BigInteger turning_at(const BigInteger& radius, const Direction& before, const Direction& behind,
                      const BigInteger& room_before, const BigInteger& room_behind);

/// What no tour is shorter than, in units of lengths times those of vectors; nothing: there is no tour. Throws Refusal
/// for a proof that is none, nlohmann's exceptions for one that is no list of what it should be, Error(cancelled), and
/// std::length_error.
std::optional<BigInteger> proved_by_insertion(JudgedTour& tour, const Json& proof,
                                              const core::ProgressReporter& progress);
std::optional<BigInteger> proved_by_pairs(JudgedTour& tour, const Json& proof, const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::judge
