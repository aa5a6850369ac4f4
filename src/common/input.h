// What people write in mission files, tables and command lines: numbers, names, files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/export.h"

namespace vantage {

enum class NumberFault {
  none,
  not_a_number,
  not_finite,    ///< infinity or not-a-number, in any spelling that YAML or C knows
  out_of_range,  ///< written as a decimal, but no double holds it (1e400, 1e-400)
  unknown_unit,  ///< a number, and after it something without digits that is no unit of what is meant
};

struct ParsedNumber {
  double value = 0.0;  ///< 0 unless `fault` is none
  NumberFault fault = NumberFault::not_a_number;
};

/// The number that the whole of `text` spells: an optional sign, decimal digits with at most one point, an optional
/// exponent. No blanks, no 0x10, no 1_000, no 1,5, no 1:30. Never throws.
VANTAGE_API ParsedNumber parse_number(std::string_view text);

/// A length in metres: a number as parse_number reads it, and then its unit, with blanks before it or none. Units are
/// mm, cm, m, km, ft (0.3048 m) and mi (1609.344 m), in upper or lower case. Two spellings are refused, since they mean
/// something else to many: "M" (nautical miles) and "Mm" (a million metres). A number alone is metres. 400 ft is the
/// double nearest to 121.92. Never throws.
VANTAGE_API ParsedNumber parse_length(std::string_view text);

/// An angle in degrees, likewise: with "deg" or "°" after the number, or without.
VANTAGE_API ParsedNumber parse_angle(std::string_view text);

/// The parts of `text` between commas, without the blanks round them: of "51.5, -0.09" two.
VANTAGE_API std::vector<std::string_view> split_at_commas(std::string_view text);

/// What to write instead of `text`, which parse_number refused for `fault`: one sentence, without a full stop.
VANTAGE_API std::string number_advice(std::string_view text, NumberFault fault);

/// The same of parse_length and of parse_angle.
VANTAGE_API std::string length_advice(std::string_view text, NumberFault fault);
VANTAGE_API std::string angle_advice(std::string_view text, NumberFault fault);

/// `text` in single quotes, fit for one line of an error message: control characters shown as '?', cut after 60 bytes.
VANTAGE_API std::string in_quotes(std::string_view text);

/// `text` as it may be shown to people, in one line: names come from files, and a terminal obeys some bytes. Control
/// characters, newlines among them, become blanks; U+2028 to U+202E and U+2066 to U+2069, which break lines or turn the
/// order of what follows, become U+FFFD. Bytes that are no UTF-8 are taken as Latin-1. All else stays as it is.
VANTAGE_API std::string printable(std::string_view text);

/// `text` as a field of a table that commas separate: in double quotes where it would break the row (RFC 4180). A ' is
/// put before = + - @ ' and control characters at its begin, since spreadsheets run what begins so, and names come from
/// files of others; so a first ' is never of the text.
VANTAGE_API std::string csv_field(std::string_view text);

/// The shortest decimal that reads back as `value`; independent of the locale.
VANTAGE_API std::string shortest(double value);

// ---- names ----

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string
/// alignment distance), upper and lower case taken as equal. Cost: O(|a| |b|).
VANTAGE_API int edit_distance(std::string_view a, std::string_view b);

/// The entry of `names` with the smallest edit distance to `word`, the first one on a tie; empty for no names. Those
/// that hold all of a word of three letters or more come before all others.
VANTAGE_API std::string_view nearest_name(std::string_view word, const std::vector<std::string_view>& names);

// ---- files ----

/// Throws Error(input), with `where` and the file as the place, unless `file` exists, is neither a folder nor a device,
/// and may be read. `what` begins the message: "the scene's mesh".
VANTAGE_API void check_readable(const std::filesystem::path& file, const std::string& what,
                                const std::string& where = {});

/// Whether the name ends in .obj or .obj.gz, whatever the case of the letters.
VANTAGE_API bool is_obj(const std::filesystem::path& file);

}  // namespace vantage
