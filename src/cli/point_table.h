// Tables of points: what their columns mean, and what is written beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/row_reader.h"
#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/query.h"

namespace vantage::cli {

struct TableOptions {
  bool lonlat = false;      ///< longitude and latitude, not x and y
  bool json = false;        ///< write objects, not rows
  bool fraction = false;    ///< write which part of the target is seen, too
  bool target = false;      ///< write the target's name, too
  std::optional<double> z;  ///< of all points; then the table has no such column
};

/// A table whose first row is read. Where that holds words it is a header; the columns named x, y and z are taken, or
/// lon, lat and z, in any order and case. Else the first three columns are.
class PointTable {
 public:
  /// Throws Error(input), with the line, for a header that lacks a column or has one that contradicts the options.
  PointTable(const RowReader& reader, const Row& first, const TableOptions& options);

  /// Whether the first row holds no point.
  bool has_header() const { return has_header_; }
  bool is_lonlat() const { return is_lonlat_; }

  bool has_fraction() const { return options_.fraction; }

  /// Columns of the points' table that the answers' replace: those of an earlier run, for example.
  const std::vector<std::string>& replaced() const { return replaced_; }
  /// Whether the header has x, y as well as lon, lat.
  bool is_ambiguous() const { return is_ambiguous_; }

  /// The coordinates in a row: x, y, z or longitude, latitude, z. Throws Error(input), with the line.
  Vec3 coordinates(const Row& row);

  /// The point of the scene frame. Throws Error(input), with the line, for what is not a place on the earth, or far
  /// away.
  Vec3 scene_point(const Vec3& coordinates, const std::optional<Georeference>& place, const Row& row) const;

  /// What stands in the row's column "id", in any case; nothing without one.
  std::optional<std::string> id(const Row& row);

  /// Before the first answer, and after the last.
  std::string beginning() const;
  std::string end() const { return options_.json ? (is_first_ ? "]\n" : "\n]\n") : ""; }
  /// The row with its answer; `fraction` where the options ask for it.
  void append(std::string& text, const Row& row, const Vec3& coordinates, const PointAnswer& answer,
              const std::optional<double>& fraction, const std::string& target);

 private:
  void take_header(const std::vector<Field>& fields, const Row& row);
  void take_columns(const std::vector<std::string>& names);
  bool is_answer(const std::string& column) const;
  void append_csv(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                  const std::optional<double>& fraction, const std::string& target) const;
  void append_json(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                   const std::optional<double>& fraction, const std::string& target);
  std::optional<std::size_t> axis_of(std::size_t column) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& problem, const Row& row, const std::string& fix) const;

  const RowReader& reader_;
  TableOptions options_;
  bool has_header_ = false, is_lonlat_ = false, is_ambiguous_ = false, is_first_ = true;
  std::vector<std::string> names_;                    // of the columns
  std::vector<bool> is_kept_;                         // of the columns
  std::array<std::optional<std::size_t>, 3> column_;  // of each coordinate
  std::vector<std::string> replaced_;
  std::vector<Field> fields_;  // of the row in hand
};

}  // namespace vantage::cli
