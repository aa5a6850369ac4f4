// What is known of a key of a mission file. Each struct of a request is described once, by a function
// `describe(settings, visit)` in describe_<struct>.h: it calls `visit` for every key, in the order in which they are
// written. What reads, writes, checks and documents a request are such visitors. The function names all members of the
// struct: one that is added does not compile before it is described.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "vantage/mission_keys.h"

namespace vantage::internal::request {

struct Key {
  /// With the keys of the maps round it, from its section on: "view.dwell" in "tour".
  std::string_view path;
  /// What it means, as docs/mission-file.md has it: its range follows, then `more`, then the default.
  std::string_view says;
  std::string_view more = "";
  /// The default, where it is no value: "none; the flight begins anywhere".
  std::string_view without = "";
  /// The map round it must have it. `form`: what to write then.
  bool is_required = false;
  std::string_view form = "";
  /// A number of 0, or an infinite one, says the same as no key, which does not take it.
  bool is_none_at_zero = false, is_none_at_infinity = false;
  /// Another name has taken its place.
  bool is_old = false;
};

enum class Unit {
  none,
  metres,
  millimetres,
  degrees,
  seconds,
  metres_per_second,
  metres_per_second_squared,
  degrees_per_second,
  gigahertz
};

using Kind = MissionKey::Kind;

/// A key that its section reads and writes in a way of its own.
struct Own {
  Key key;
  Kind kind;
  Unit unit = Unit::none;
};

/// "m/s"; nothing without a unit.
std::string_view symbol_of(Unit unit);
/// What names of members end with: "_m_s".
std::string_view suffix_of(Unit unit);

/// Metres: no key takes longer lengths (ValueReader::length), and lists of keys do not say so.
inline constexpr double kLongest = 1e9;

/// Which numbers a key takes.
struct Bounds {
  enum class Ends { both, without_least, without_most, neither };  ///< which of the two are numbers that it takes

  double least, most;
  Unit unit = Unit::none;
  std::string_view fix = "";        ///< for errors: "give metres"
  std::string_view most_word = "";  ///< what `most` is: "a day"
  Ends ends = Ends::both;

  bool takes_least() const;
  bool takes_most() const;
  /// False for NaN, too.
  bool hold(double value) const;
  /// "0.01 to 1000"; "> 0, at most 604,800, a week".
  std::string text() const;
};

/// Throws Error(value_out_of_range) for a number that the bounds exclude; `where`: the key with its section.
void check_within(const Bounds& bounds, double value, const std::string& where);

/// For which settings a key counts.
struct Only {
  bool holds = true;
  std::string_view otherwise = "";  ///< what does not have it: "fixed_wing"
};

/// The name of a struct's section: "tour". Each describe_<struct>.h has a specialisation.
template <typename Settings>
inline constexpr std::string_view kSection = "";

/// What visits a description derives from it, so that describe() is found.
struct Visitor {};

template <typename Value>
struct Choice {
  Value value;
  std::string_view word;
};

/// Of a value that is among the choices.
template <typename Choices, typename Value>
constexpr std::string_view word_of(const Choices& choices, Value value) {
  for (const auto& [one, word] : choices) {
    if (one == value) return word;
  }
  return "";
}

}  // namespace vantage::internal::request
