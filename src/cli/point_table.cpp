#include "cli/point_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "common/input.h"
#include "common/json.h"
#include "vantage/earth.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

constexpr std::array<const char*, 6> kAnswers = {"inside",       "margin_m",      "blocked_by",
                                                 "out_of_range", "behind_target", "outside_of"};
constexpr const char* kFraction = "fraction";
constexpr const char* kTarget = "target";

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// Begins like a name and is not a spelling of infinity or not-a-number, which is a point's mistake, not a header.
bool is_word(const std::string& field) {
  if (field.empty() || parse_number(field).fault != NumberFault::not_a_number) return false;
  const auto c = static_cast<unsigned char>(field.front());
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c >= 0x80;
}

void append_number(std::string& text, double value) {
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

/// Nine significant digits: a micrometre in a kilometre.
/// Nothing for a number that is not known.
void append_metres(std::string& text, double value) {
  if (std::isnan(value)) return;
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 9);
  text.append(digits.data(), end);
}

/// In double quotes where the text would break the row; RFC 4180.
void append_field(std::string& text, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char c : field) text.append(c == '"' ? 2 : 1, c);
  text += '"';
}

/// Joined by semicolons; one within a name, and a backslash, has a backslash before it.
void append_names(std::string& text, const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) {
    if (&name != &names.front()) joined += ';';
    for (const char c : name) {
      if (c == ';' || c == '\\') joined += '\\';
      joined += c;
    }
  }
  text += csv_field(joined);
}

/// Bytes that are not UTF-8 are replaced rather than refused.
const char* truth(bool value) { return value ? "true" : "false"; }

/// A height with a unit is told in metres, which is what its column has.
std::string advice_for(std::string_view text, NumberFault fault, TableColumn column) {
  const bool is_height = column == TableColumn::height || column == TableColumn::z;
  const ParsedNumber metres = parse_length(text);
  const bool is_plain = parse_number(text).fault == NumberFault::none;
  const bool is_length =
      is_height && !is_plain && fault == NumberFault::not_a_number && metres.fault == NumberFault::none;
  return is_length ? "write metres, without a unit: " + shortest(metres.value) : table_advice(text, column, fault);
}

}  // namespace

PointTable::PointTable(const RowReader& reader, const Row& first, const TableOptions& options)
    : reader_(reader), options_(options), is_lonlat_(options.lonlat), numbers_(reader.separator()) {
  reader_.split(first.text, fields_);
  const std::size_t looked_at = std::min<std::size_t>(fields_.size(), 3);
  has_header_ = std::any_of(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(looked_at),
                            [](const Field& field) { return is_word(field.plain()); });
  if (has_header_) {
    take_header(fields_, first);
  } else {
    for (std::size_t axis = 0; axis < (options.z ? 2 : 3); ++axis) column_[axis] = axis;
    names_ = {is_lonlat_ ? "lon" : "x", is_lonlat_ ? "lat" : "y"};
    if (!options.z) names_.emplace_back(options.heights ? "height" : "z");
    height_ = options.heights.value_or(HeightDatum::scene_z);
    height_name_ = options.z ? "" : names_.back();
    while (names_.size() < fields_.size()) names_.push_back("column_" + std::to_string(names_.size() + 1));
  }
  for (const std::string& name : names_) {
    is_kept_.push_back(!is_answer(name));
    if (!is_kept_.back()) replaced_.push_back(name);
  }
  if (!options.json) return;
  std::set<std::string> seen;
  for (const std::string& name : names_) {
    if (seen.insert(name).second) continue;
    fail(ErrorCode::duplicate_key, "two columns are named " + in_quotes(name) + ", which JSON cannot hold", first,
         "give each a name of its own");
  }
}

bool PointTable::is_answer(const std::string& column) const {
  return std::find(kAnswers.begin(), kAnswers.end(), column) != kAnswers.end() ||
         (options_.fraction && column == kFraction) || (options_.target && column == kTarget);
}

std::optional<std::string> PointTable::id(const Row& row) {
  const auto found =
      std::find_if(names_.begin(), names_.end(), [](const std::string& name) { return lower_case(name) == "id"; });
  if (!has_header_ || found == names_.end()) return std::nullopt;
  const auto column = static_cast<std::size_t>(found - names_.begin());
  reader_.split(row.text, fields_);
  return column < fields_.size() ? fields_[column].plain() : "";
}

std::vector<std::size_t> PointTable::columns_of(TableColumn column) const {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (known_[i] && known_[i]->column == column) columns.push_back(i);
  }
  return columns;
}

void PointTable::take_header(const std::vector<Field>& fields, const Row& row) {
  for (const Field& field : fields) {
    names_.push_back(field.plain());
    known_.push_back(known_column(names_.back()));
  }
  const std::vector<std::size_t> x = columns_of(TableColumn::x), y = columns_of(TableColumn::y),
                                 lon = columns_of(TableColumn::longitude), lat = columns_of(TableColumn::latitude);
  const bool has_xy = !x.empty() && !y.empty(), has_lonlat = !lon.empty() && !lat.empty();
  is_lonlat_ = options_.lonlat || (has_lonlat && !has_xy);
  is_ambiguous_ = !options_.lonlat && has_lonlat && has_xy;
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    const std::vector<std::size_t>& columns = axis == 0 ? (is_lonlat_ ? lon : x) : (is_lonlat_ ? lat : y);
    check_only_one(columns, row);
    if (!columns.empty()) column_[axis] = columns.front();
  }
  take_height(row);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!column_[axis]) continue;
    factor_[static_cast<Eigen::Index>(axis)] = known_[*column_[axis]]->factor;
    if (!is_lonlat_) names_[*column_[axis]] = lower_case(names_[*column_[axis]]);
  }
  const std::array<const char*, 3> axes = {is_lonlat_ ? "lon" : "x", is_lonlat_ ? "lat" : "y", "z, amsl or agl"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (column_[axis] || (axis == 2 && options_.z)) continue;
    const std::string form = is_lonlat_
                                 ? "begin with the header 'lon,lat,z', or with a point such as 11.57,48.14,30"
                                 : "begin with the header 'x,y,z' or 'lon,lat,z', or with a point such as 1.5,2,30";
    fail(ErrorCode::table_syntax,
         "the first row is neither a point nor a header with a column " + std::string(axes[axis]), row,
         axis == 2 ? form + "; --z gives one height for all points" : form);
  }
}

/// Which of two is meant, nobody knows.
void PointTable::check_only_one(const std::vector<std::size_t>& columns, const Row& row) const {
  if (columns.size() < 2) return;
  fail(ErrorCode::conflicting_keys, "the points have the columns " + names_[columns[0]] + " and " + names_[columns[1]],
       row, "leave one of them out, or give another name to it");
}

std::vector<std::string> PointTable::unused_heights() const {
  std::vector<std::string> names;
  for (const std::size_t column : unused_heights_) names.push_back(names_[column]);
  return names;
}

/// z comes first, then heights that say what they are measured from, then others. Of these only one can be meant.
void PointTable::take_height(const Row& row) {
  std::vector<std::size_t> meant = columns_of(TableColumn::z), without_level;
  const bool has_z = !meant.empty();
  for (const std::size_t column : columns_of(TableColumn::height)) {
    const bool is_known = known_[column]->datum != HeightDatum::unknown;
    (!is_known ? without_level : has_z ? unused_heights_ : meant).push_back(column);
  }
  if (meant.empty() && options_.heights) meant.swap(without_level);
  unused_heights_.insert(unused_heights_.end(), without_level.begin(), without_level.end());
  if (options_.z && !meant.empty()) {
    fail(ErrorCode::conflicting_keys,
         "the points have a column " + names_[meant.front()] + ", and --z gives another height", row,
         "leave one of them out");
  }
  check_only_one(meant, row);
  if (!meant.empty()) {
    column_[2] = meant.front();
    height_name_ = names_[meant.front()];
    const HeightDatum said = known_[meant.front()]->datum;
    if (!has_z) height_ = said == HeightDatum::unknown ? *options_.heights : said;
  } else if (!unused_heights_.empty() && !options_.z) {
    fail(ErrorCode::height_unknown,
         names_[unused_heights_.front()] + " of the points does not say what it is measured from", row,
         "say it with --heights sea, ellipsoid, ground, home or scene, or name it such as height_amsl or height_agl");
  }
}

Vec3 PointTable::coordinates(const Row& row) {
  reader_.split(row.text, fields_);
  while (fields_.size() > names_.size() && fields_.back().text.empty()) fields_.pop_back();
  if (fields_.size() > names_.size()) {
    fail(ErrorCode::table_syntax,
         "the row has " + std::to_string(fields_.size()) + " columns, but the first row has " +
             std::to_string(names_.size()),
         row, "write the same columns in every row; put a text that holds the separator in double quotes");
  }
  Vec3 point(0, 0, options_.z.value_or(0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!column_[axis]) continue;  // --z
    const std::size_t column = *column_[axis];
    const std::string& name = names_[column];
    if (column >= fields_.size()) {
      fail(ErrorCode::table_syntax,
           "the row has " + std::to_string(fields_.size()) + " columns, but " + name + " is column " +
               std::to_string(column + 1),
           row, "write all coordinates in every row, separated like the first row");
    }
    const std::string plain = fields_[column].is_quoted ? fields_[column].plain() : std::string();
    const std::string_view text = fields_[column].is_quoted ? std::string_view{plain} : fields_[column].text;
    const TableColumn meaning = meaning_of(axis);
    const ParsedNumber parsed = numbers_.parse(text, meaning);
    if (parsed.fault != NumberFault::none) {
      fail(ErrorCode::not_a_number,
           name + (parsed.fault == NumberFault::not_finite ? " is not finite: " : " is not a number: ") +
               in_quotes(text),
           row, advice_for(text, parsed.fault, meaning));
    }
    point[static_cast<Eigen::Index>(axis)] = parsed.value;
  }
  return point;
}

/// What the numbers of a coordinate mean.
TableColumn PointTable::meaning_of(std::size_t axis) const {
  if (axis == 2) return TableColumn::height;
  if (is_lonlat_) return axis == 0 ? TableColumn::longitude : TableColumn::latitude;
  return axis == 0 ? TableColumn::x : TableColumn::y;
}

/// Of longitude and latitude; z is right but for heights above the ground.
Vec3 PointTable::placed(const Vec3& coordinates, const PointFrame& frame) const {
  const double longitude = coordinates.x(), latitude = coordinates.y(), height = coordinates.z();
  const auto in_plan = [&](const Eigen::Vector2d& at) { return Vec3(at.x(), at.y(), height); };
  switch (height_) {
    case HeightDatum::sea_level:
    case HeightDatum::ellipsoid:
    case HeightDatum::home:
      return vantage::scene_point(*frame.place, longitude, latitude, height + frame.zero_m);
    case HeightDatum::ground:
      return in_plan(
          scene_position(*frame.place, longitude, latitude, [&](const Eigen::Vector2d& at) -> std::optional<double> {
            const auto ground = frame.ground->at(at.x(), at.y());
            return ground ? std::optional(ground->highest_m + height) : std::nullopt;
          }));
    default:
      return in_plan(scene_position(*frame.place, longitude, latitude, height));
  }
}

Vec3 PointTable::scene_point(const Vec3& stated, const PointFrame& frame, const Row& row) {
  const Vec3 coordinates = stated.cwiseProduct(factor_);
  if (!is_lonlat_) {
    const Eigen::Vector2d at = coordinates.head<2>();
    return {at.x(), at.y(), scene_height(coordinates, at, frame, row)};
  }
  if (!frame.place) {
    fail(ErrorCode::not_georeferenced,
         "the points are longitudes and latitudes, but the scene does not say where on the earth it lies", row,
         "give x, y and z in the scene frame, or a scene with a place: a map, CityJSON with a reference system, a "
         "raster, or a mesh with 'crs' or written by 'vantage scene'");
  }
  Vec3 point;
  try {
    point = placed(coordinates, frame);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    fail(error.code(), error.problem(), row, error.fix());
  }
  const Eigen::Array2d at = point.head<2>(), low = frame.bounds.min.head<2>(), high = frame.bounds.max.head<2>();
  const bool is_outside = (at < low).any() || (at > high).any();
  if (is_outside && seems_swapped(*frame.place, frame.bounds, coordinates.x(), coordinates.y())) ++swapped_;
  if (height_ == HeightDatum::ground) point.z() = scene_height(coordinates, point.head<2>(), frame, row);
  return point;
}

namespace {

/// z of a point with a height above the zero of the scene's heights.
double z_of_height(double height, const Eigen::Vector2d& at, const PointFrame& frame) {
  double z = height;
  if (!frame.place || is_map(*frame.place)) return z;
  constexpr int kSteps = 3;  // each divides what is off by (R / d)^2
  for (int i = 0; i < kSteps; ++i) z += height - height_m(*frame.place, {at.x(), at.y(), z});
  return z;
}

}  // namespace

double PointTable::scene_height(const Vec3& coordinates, const Eigen::Vector2d& at, const PointFrame& frame,
                                const Row& row) const {
  if (height_ == HeightDatum::scene_z) return coordinates.z();
  if (height_ != HeightDatum::ground) return z_of_height(coordinates.z() + frame.zero_m, at, frame);
  constexpr double kSameM = 1e-3;
  const auto ground = frame.ground->at(at.x(), at.y());
  if (!ground) {
    fail(ErrorCode::ground_missing, "there is no ground under the point, so its " + height_name_ + " says nothing", row,
         "give z or amsl, or leave the point out");
  }
  if (ground->highest_m - ground->lowest_m > kSameM) {
    fail(ErrorCode::ground_missing,
         "pieces of the ground lie over each other at the point, at z " + shortest(ground->lowest_m) + " and " +
             shortest(ground->highest_m),
         row, "give z or amsl");
  }
  return coordinates.z() + ground->highest_m;
}

std::string PointTable::beginning() const {
  if (options_.json) return "[";
  std::string text;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!is_kept_[i]) continue;
    append_field(text, names_[i]);
    text += ',';
  }
  for (const char* name : kAnswers) text += std::string(name) + (name == kAnswers.back() ? "" : ",");
  if (options_.fraction) text.append(",").append(kFraction);
  if (options_.target) text.append(",").append(kTarget);
  return text + "\n";
}

std::optional<std::size_t> PointTable::axis_of(std::size_t column) const {
  const auto found = std::find(column_.begin(), column_.end(), std::optional(column));
  if (found == column_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - column_.begin());
}

void PointTable::append(std::string& text, const Row& row, const Vec3& coordinates, const PointAnswer& answer,
                        const std::optional<double>& fraction, const std::string& target) {
  reader_.split(row.text, fields_);
  if (options_.json) {
    append_json(text, coordinates, answer, fraction, target);
  } else {
    append_csv(text, coordinates, answer, fraction, target);
  }
  is_first_ = false;
}

void PointTable::append_csv(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                            const std::optional<double>& fraction, const std::string& target) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!is_kept_[i]) continue;
    if (const auto axis = axis_of(i)) {
      append_number(text, coordinates[static_cast<Eigen::Index>(*axis)]);
    } else if (i < fields_.size()) {
      if (fields_[i].is_quoted) {
        text += fields_[i].text;
      } else {
        append_field(text, fields_[i].text);
      }
    }
    text += ',';
  }
  text.append(truth(answer.inside)).append(",");
  append_metres(text, answer.margin_m);
  text += ',';
  append_names(text, answer.blocked_by);
  text.append(",").append(truth(answer.out_of_range)).append(",").append(truth(answer.behind_target)).append(",");
  append_names(text, answer.outside_of);
  if (fraction) {
    text += ',';
    append_number(text, *fraction);  // all digits: what is nearly 1 must not become 1
  }
  if (options_.target) {
    text += ',';
    text += csv_field(target);
  }
  text += '\n';
}

void PointTable::append_json(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                             const std::optional<double>& fraction, const std::string& target) {
  text += is_first_ ? "\n{" : ",\n{";
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!is_kept_[i]) continue;
    const auto axis = axis_of(i);
    text += json_text(names_[i]) + ": ";
    if (axis) {
      append_number(text, coordinates[static_cast<Eigen::Index>(*axis)]);
    } else {
      text += i < fields_.size() ? json_text(fields_[i].plain()) : "\"\"";
    }
    text += ", ";
  }
  text.append("\"inside\": ").append(truth(answer.inside)).append(", \"margin_m\": ");
  text += std::isfinite(answer.margin_m) ? shortest(answer.margin_m) : "null";
  text.append(", \"blocked_by\": ").append(json_text(answer.blocked_by));
  text.append(", \"out_of_range\": ").append(truth(answer.out_of_range));
  text.append(", \"behind_target\": ").append(truth(answer.behind_target));
  text.append(", \"outside_of\": ").append(json_text(answer.outside_of));
  if (fraction) text.append(", \"fraction\": ").append(shortest(*fraction));
  if (options_.target) text.append(", \"target\": ").append(json_text(std::string_view{target}));
  text += "}";
}

void PointTable::fail(ErrorCode code, const std::string& problem, const Row& row, const std::string& fix) const {
  throw Error(code, problem, reader_.file() + ":" + std::to_string(row.line), fix);
}

}  // namespace vantage::cli
