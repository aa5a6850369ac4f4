// Lengths, levels and directions as people write them in tags.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "maps/city/building_form.h"

namespace vantage::internal::city {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_decimal(char c) { return c == '.' || c == ','; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// "1,250" and the like, which may be a thousand and more or one and a quarter.
bool groups_thousands(std::string_view text, char separator = ',') {
  const auto comma = std::min(text.find(separator), text.size());
  const auto is_digits = [](std::string_view part) { return std::all_of(part.begin(), part.end(), is_digit); };
  return comma > 0 && comma <= 3 && text[0] != '0' && comma + 4 <= text.size() && is_digits(text.substr(0, comma)) &&
         is_digits(text.substr(comma + 1, 3)) && (comma + 4 == text.size() || !is_digit(text[comma + 4]));
}

/// A number at the front of `text`, which is shortened by it: "12", "-3", "+4", "2.5", ".5", "2,5"; no exponents.
std::optional<double> take_number(std::string_view& text) {
  std::string digits;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) {
    if (text[i] == '-') digits = "-";
    ++i;
  }
  bool any = false, point = false;
  if (groups_thousands(text.substr(i))) return std::nullopt;
  for (; i < text.size(); ++i) {
    const bool separator = text[i] == '.' || text[i] == ',';
    if (separator ? point : !is_digit(text[i])) break;
    point = point || separator;
    any = any || !separator;
    digits += separator ? '.' : text[i];
  }
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (!any || error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  text.remove_prefix(i);
  return value;
}

/// A number and nothing more.
std::optional<double> plain_number(std::string_view text) {
  const std::optional<double> value = take_number(text);
  return value && text.empty() ? value : std::nullopt;
}

constexpr double kFoot = 0.3048, kInch = 0.0254;

/// Metres in a unit.
std::optional<double> unit_m(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 29> units = {
      {{"", 1},        {"m", 1},         {"m.", 1},         {"meter", 1},       {"meters", 1},
       {"metre", 1},   {"metres", 1},    {"mi", 1609.344},  {"mile", 1609.344}, {"miles", 1609.344},
       {"yd", 0.9144}, {"yard", 0.9144}, {"yards", 0.9144}, {"mm", 0.001},      {"cm", 0.01},
       {"km", 1000},   {"ft", kFoot},    {"ft.", kFoot},    {"feet", kFoot},    {"foot", kFoot},
       {"'", kFoot},   {"in", kInch},    {"inch", kInch},   {"\"", kInch},      {"dam", 10},
       {"hm", 100},    {"nm", 1852},     {"nmi", 1852},     {"nautical", 1852}}};
  const auto found = std::find_if(units.begin(), units.end(), [&](const auto& known) { return known.first == unit; });
  if (found == units.end()) return std::nullopt;
  return found->second;
}

/// The typographer's marks for feet and inches and spaces as plain ones, two apostrophes as one inch mark.
std::string plain_marks(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 10> marks = {{{"\u2032", "'"},
                                                                                           {"\u2018", "'"},
                                                                                           {"\u2019", "'"},
                                                                                           {"\u00b4", "'"},
                                                                                           {"\u2033", "\""},
                                                                                           {"\u201d", "\""},
                                                                                           {"''", "\""},
                                                                                           {"\u00a0", " "},
                                                                                           {"\u2009", " "},
                                                                                           {"\u202f", " "}}};
  std::string result(text);
  for (const auto& [from, to] : marks) {
    for (std::size_t at = 0; (at = result.find(from, at)) != std::string::npos; at += to.size()) {
      result.replace(at, from.size(), to);
    }
  }
  return result;
}

std::optional<double> one_length_m(std::string_view text) {
  const std::string value = plain_marks(lower(text));
  std::string_view rest = value;
  const std::optional<double> number = take_number(rest);
  if (!number || groups_thousands(value, '\'')) return std::nullopt;
  if (!rest.empty() && rest.front() == '\'' && rest.size() > 1) {  // 5'11": feet and inches
    rest = trimmed(rest.substr(1));
    const bool digit = !rest.empty() && is_digit(rest.front());
    const std::optional<double> inches = digit ? take_number(rest) : std::nullopt;
    if (!inches || *inches >= 12 || (!rest.empty() && rest != "\"")) return std::nullopt;
    return (*number * kFoot) + std::copysign(*inches * kInch, *number);
  }
  const std::optional<double> unit = unit_m(trimmed(rest));
  if (!unit || (*unit < 1 && groups_thousands(value, '.'))) return std::nullopt;  // "1.250 ft"
  return *number * *unit;
}

/// The largest of the values between semicolons, all of which must be values; empty ones are passed over. Or that which
/// is `better` than the others.
template <typename Parse, typename Better = std::greater<>>
std::optional<double> largest(std::string_view list, const Parse& parse, const Better& better = {}) {
  std::optional<double> result;
  while (true) {
    const std::size_t end = list.find(';');
    const std::string_view item = trimmed(list.substr(0, end));
    if (!item.empty()) {
      const std::optional<double> value = parse(item);
      if (!value) return std::nullopt;
      if (!result || better(*value, *result)) result = *value;
    }
    if (end == std::string_view::npos) return result;
    list.remove_prefix(end + 1);
  }
}

/// In lower case, with plain marks and digits, and fractions as decimals: also "2 1/2". Full-width digits are U+FF10 to
/// U+FF19.
std::string plain_text(std::string_view text) {
  std::string result = plain_marks(lower(text));
  for (char digit = '0'; digit <= '9'; ++digit) {
    const std::string wide = {'\xEF', '\xBC', static_cast<char>('\x90' + (digit - '0'))};
    for (std::size_t at = 0; (at = result.find(wide, at)) != std::string::npos; ++at) result.replace(at, 3, 1, digit);
  }
  static constexpr std::array<std::array<std::string_view, 3>, 3> fractions = {
      {{"\u00bc", "1/4", ".25"}, {"\u00bd", "1/2", ".5"}, {"\u00be", "3/4", ".75"}}};
  for (const auto& [sign, words, decimals] : fractions) {
    for (const std::string_view fraction : {sign, words}) {
      for (std::size_t at = 0; (at = result.find(fraction, at)) != std::string::npos;) {
        std::size_t begin = at;
        while (begin > 0 && is_space(result[begin - 1])) --begin;
        const bool follows = begin > 0 && is_digit(result[begin - 1]);
        if (fraction == words && (begin == at) == follows) {  // "11/2", or no number before it
          ++at;
          continue;
        }
        if (!follows) begin = at;
        result.replace(begin, at + fraction.size() - begin, decimals);
        at = begin + decimals.size();
      }
    }
  }
  return result;
}

/// A number of a text, and the word or mark that follows it.
struct Term {
  double number = 0;
  std::string_view unit;
  bool is_last = false;  ///< nothing follows the word
  char sign = ' ';       ///< that joins it to the next one: '/', '*' (also a cross)
};

/// The numbers of a text, exponents too: also "10-storey", "10 (storeys)". What may be thousands ("1,250", "1'000",
/// "1 250") is one of them as well; of "1,2,3" each is one. `text`: as plain_text() gives it.
std::vector<Term> terms_of(const std::string& text) {
  std::vector<Term> terms;
  const char *const end = text.data() + text.size(), *at = text.data();
  const auto is_mark = [](char c) { return c == '\'' || c == '"'; };
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; };
  const auto digits_at = [&](const char* from) { return std::find_if_not(from, end, is_digit) - from; };
  while (at != end) {
    const bool is_fraction = *at == '.' && digits_at(at + 1) > 0 && (at == text.data() || at[-1] != '.');
    if (!is_digit(*at) && !is_fraction) {
      ++at;
      continue;
    }
    // Groups of digits, and what is between them.
    std::vector<std::string> groups;
    std::string between;
    const char* next = at;
    while (true) {
      const char* const group = next;
      next += digits_at(next);
      groups.emplace_back(group, next);
      const bool is_point = next != end && is_decimal(*next);
      const bool is_gap = next != end && (*next == ' ' || *next == '\'' || *next == '_') && digits_at(next + 1) == 3 &&
                          groups.front().size() <= 3 && (between.empty() || between.back() == *next);
      if (!(is_gap || (is_point && digits_at(next + 1) > 0))) break;
      between += *next++;
    }
    // Only the last of several points begins a fraction.
    const std::size_t count = groups.size();
    const bool has_fraction = count > 2 && between.back() != between.front() && is_decimal(between.back());
    bool is_thousands = count > 1 && !groups[0].empty() && groups[0].size() <= 3 && groups[0][0] != '0';
    std::string joined;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_last = has_fraction && i + 1 == count;
      is_thousands &= i == 0 || is_last || (groups[i].size() == 3 && between[i - 1] == between[0]);
      joined += (is_last ? "." : "") + groups[i];
    }
    std::vector<std::string> readings;
    if (is_thousands) readings.push_back(joined);
    if (count <= 2 && (count == 1 || is_decimal(between[0]))) {
      readings.push_back(groups[0] + (count == 2 ? "." + groups[1] : ""));
      const char* const exponent = next != end && *next == 'e' ? next + 1 : end;
      const char* const power = exponent != end && (*exponent == '-' || *exponent == '+') ? exponent + 1 : exponent;
      if (digits_at(power) > 0) {
        readings.back().append(next, power + digits_at(power));
        next = power + digits_at(power);
      }
    } else if (!is_thousands || between[0] == ' ') {
      readings.insert(readings.end(), groups.begin(), groups.end());
    }
    const char* unit = std::find_if_not(next, end, [](char c) { return is_space(c) || c == '-' || c == '('; });
    if (unit == end || !(is_letter(*unit) || is_mark(*unit))) unit = next;
    at = std::find_if_not(unit, end, [&](char c) { return is_letter(c) || is_mark(c); });
    const std::string_view word(unit, static_cast<std::size_t>(at - unit));
    const char* const follows = std::find_if_not(at, end, is_space);
    const bool is_last = follows == end, is_times = word == "x" || word == "\u00d7" || (!is_last && *follows == '*');
    const char sign = is_times ? '*' : !is_last && *follows == '/' ? '/' : ' ';
    // A point is one of thousands where it would be absurd else: "1.250 ft".
    const bool is_odd = count == 2 && between[0] == '.' && unit_m(word).value_or(1) >= 1;
    for (const std::string& reading : readings) {
      double value = 0;
      if (is_odd && &reading != &readings.back()) continue;
      const auto parsed = std::from_chars(reading.data(), reading.data() + reading.size(), value);
      if (parsed.ec == std::errc()) terms.push_back({value, word, is_last, sign});
    }
  }
  return terms;
}

/// Floors of "R+5" or "P+5+Pk" that have no number: the words between the signs, where the first is one; else 0.
int floors_in_words(std::string_view text) {
  int words = 0;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('+', at), text.size());
    const std::string_view part = text.substr(at, end - at);
    const bool is_word = std::any_of(part.begin(), part.end(), [](char c) { return c >= 'a' && c <= 'z'; }) &&
                         std::none_of(part.begin(), part.end(), is_digit);
    if (at == 0 && (!is_word || end == text.size())) return 0;
    words += is_word ? 1 : 0;
    at = end + 1;
  }
  return words;
}

/// The largest of `values` that is no more than `most`, or the sum of these and `more`. Where none is, the least that
/// is more: nothing else is said.
std::optional<double> largest_up_to(double most, const std::vector<double>& values, bool adds, double more = 0) {
  double result = 0, sum = more;
  std::optional<double> beyond;
  for (const double value : values) {
    if (value <= most) {
      result = std::max(result, value);
      sum += value;
    } else if (std::isfinite(value)) {
      beyond = std::min(beyond.value_or(value), value);
    }
  }
  if (result == 0) return values.empty() || beyond ? beyond : std::optional(0.0);
  return adds ? std::max(result, sum) : result;
}

bool counts_levels(std::string_view unit) {
  static constexpr std::array<std::string_view, 35> words = {"stor",
                                                             "level",
                                                             "lvl",
                                                             "floor",
                                                             "fl",
                                                             "stock",
                                                             "etage",
                                                             "\u00e9tage",
                                                             "\u00c9tage",
                                                             "gescho",
                                                             "piso",
                                                             "piano",
                                                             "piani",
                                                             "planta",
                                                             "niveau",
                                                             "verdiep",
                                                             "kerro",
                                                             "pi\u0119tr",
                                                             "\u044d\u0442\u0430\u0436",
                                                             "\u5c42",
                                                             "\u5c64",
                                                             "\u968e",
                                                             "\uce35",
                                                             "andar",
                                                             "etasj",
                                                             "etaj",
                                                             "eta\u017e",
                                                             "emelet",
                                                             "kat",
                                                             "v\u00e5n",
                                                             "v\u00c5n",
                                                             "patro",
                                                             "poschod",
                                                             "sprat",
                                                             "lantai"};
  return unit == "f" ||
         std::any_of(words.begin(), words.end(), [&](std::string_view w) { return unit.starts_with(w); });
}

}  // namespace

std::optional<double> parse_length_m(std::string_view text) { return largest(text, one_length_m); }

std::optional<double> parse_lowest_length_m(std::string_view text) {
  return largest(text, one_length_m, std::less<>());
}

std::optional<double> parse_levels(std::string_view text) { return largest(text, plain_number); }

std::optional<double> parse_lowest_levels(std::string_view text) { return largest(text, plain_number, std::less<>()); }

std::optional<double> any_length_m(std::string_view text, double level_m) {
  if (text.empty()) return std::nullopt;
  if (const std::optional<double> length = parse_length_m(text)) return length;
  constexpr double kMost = 1500;  // metres: what is higher was a year, or no thousand
  const std::string plain = plain_text(text);
  const double floors = floors_in_words(plain);
  bool has_feet = false, has_inches = false;
  std::vector<double> lengths;
  const Term* before = nullptr;  // what joins itself to it: "2x15", "1/50 mi"
  const std::vector<Term> terms = terms_of(plain);
  for (const Term& term : terms) {
    const std::string_view unit = term.unit;
    const bool is_kilometres = unit.starts_with("km") || unit.starts_with("kilo");
    const bool is_word = unit == "in" && !term.is_last;  // "12 in height"
    has_feet |= unit == "'" || unit.starts_with("f");
    has_inches |= unit == "\"" || unit.starts_with("in");
    const double unit_length = is_kilometres ? 1000 : is_word ? 1 : unit_m(unit).value_or(1);
    const double metres = floors > 0 || counts_levels(unit) ? level_m : unit_length;
    lengths.push_back(term.number * metres);
    if (before)
      lengths.push_back(metres * (before->sign == '*' ? before->number * term.number : before->number / term.number));
    before = term.sign == ' ' ? nullptr : &term;
  }
  const auto says = [&](std::string_view word) { return plain.find(word) != std::string::npos; };
  const bool adds = says("+") || says("\u00b1") || says("plus") || (has_feet && has_inches);
  return largest_up_to(kMost, lengths, adds, floors * level_m);
}

std::optional<double> any_length_m(std::string_view text) {
  static const double level_m = BuildingDefaults{}.level_m;
  return any_length_m(text, level_m);
}

std::optional<double> roughly_levels(std::string_view text) {
  constexpr double kMost = 300;
  const std::string plain = plain_text(text);
  std::vector<double> levels;
  for (const Term& term : terms_of(plain)) levels.push_back(term.number);
  return largest_up_to(kMost, levels, plain.find('+') != std::string::npos, floors_in_words(plain));
}

std::optional<double> parse_angle_deg(std::string_view text) {
  return largest(text, [](std::string_view item) -> std::optional<double> {
    static constexpr std::array<std::string_view, 5> units = {"", "\u00b0", "deg", "degree", "degrees"};
    const std::string value = lower(item);
    std::string_view rest = value;
    const std::optional<double> number = take_number(rest);
    return std::find(units.begin(), units.end(), trimmed(rest)) == units.end() ? std::nullopt : number;
  });
}

std::optional<double> parse_direction_deg(std::string_view text) {
  static constexpr std::array<std::string_view, 16> winds = {"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                                             "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};
  std::string value = lower(trimmed(text));
  constexpr std::string_view degree = "\u00b0";
  if (value.ends_with(degree)) value.resize(value.size() - degree.size());
  if (const std::optional<double> number = plain_number(trimmed(value))) {
    const double turned = std::fmod(*number, 360);
    return turned < 0 ? turned + 360 : turned;
  }
  // "north-north-east" and the like by their initials.
  std::string initials;
  std::string_view rest = value;
  while (!rest.empty()) {
    static constexpr std::array<std::string_view, 4> words = {"north", "east", "south", "west"};
    const auto word = std::find_if(words.begin(), words.end(), [&](std::string_view w) { return rest.starts_with(w); });
    if (word == words.end()) break;
    initials += word->front();
    rest.remove_prefix(word->size());
    while (!rest.empty() && (rest.front() == '-' || rest.front() == '_' || rest.front() == ' ')) rest.remove_prefix(1);
  }
  const std::string_view name = rest.empty() ? std::string_view{initials} : std::string_view{value};
  const auto wind = std::find(winds.begin(), winds.end(), name);
  if (wind == winds.end()) return std::nullopt;
  return 22.5 * static_cast<double>(wind - winds.begin());
}

}  // namespace vantage::internal::city
