// Tables of points: what their columns mean, and what is written beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/row_reader.h"
#include "vantage/error.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"
#include "vantage/query.h"

namespace vantage::cli {

struct TableOptions {
  bool lonlat = false;      ///< longitude and latitude, not x and y
  bool json = false;        ///< write objects, not rows
  bool fraction = false;    ///< write which part of the target is seen, too
  bool target = false;      ///< write the target's name, too
  std::optional<double> z;  ///< of all points; then the table has no such column
};

/// What the third coordinate of points is measured from.
enum class HeightColumn {
  z,    ///< the scene's zero
  alt,  ///< mean sea level
  agl,  ///< the ground at that place
};

/// What moves points of a table into the scene frame.
struct PointFrame {
  std::optional<Georeference> place;        ///< for longitudes and latitudes
  Box bounds;                               ///< of the scene
  std::optional<double> sea_level_m = {};   ///< scene z of it; for HeightColumn::alt
  std::optional<GroundLevels> ground = {};  ///< for HeightColumn::agl
};

/// A table whose first row is read. Where that holds words it is a header; the columns named x, y and z are taken, or
/// lon, lat and z, in any order and case. In the place of z may be alt or agl. Else the first three columns are taken.
class PointTable {
 public:
  /// Throws Error(input), with the line, for a header that lacks a column or has one that contradicts the options.
  PointTable(const RowReader& reader, const Row& first, const TableOptions& options);

  /// Whether the first row holds no point.
  bool has_header() const { return has_header_; }
  bool is_lonlat() const { return is_lonlat_; }
  HeightColumn height() const { return height_; }
  /// Other columns of heights that the header has and that are not used.
  const std::vector<std::string>& unused_heights() const { return unused_heights_; }

  bool has_fraction() const { return options_.fraction; }

  /// Columns of the points' table that the answers' replace: those of an earlier run, for example.
  const std::vector<std::string>& replaced() const { return replaced_; }
  /// Whether the header has x, y as well as lon, lat.
  bool is_ambiguous() const { return is_ambiguous_; }

  /// The coordinates in a row: x and y, or longitude and latitude, and the height as it stands there. Throws
  /// Error(input), with the line.
  Vec3 coordinates(const Row& row);

  /// The point of the scene frame. Throws Error(input), with the line, for what is not a place on the earth, or far
  /// away, and for heights above a ground that is not there.
  Vec3 scene_point(const Vec3& coordinates, const PointFrame& frame, const Row& row);

  /// How many of those lay outside of the scene, and inside with longitude and latitude the other way round.
  std::size_t swapped() const { return swapped_; }

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
  void take_height(const Row& row);
  void check_only_one(const std::vector<std::size_t>& columns, const Row& row) const;
  Vec3 placed(const Vec3& coordinates, const PointFrame& frame) const;
  double scene_height(const Vec3& coordinates, const Eigen::Vector2d& at, const PointFrame& frame,
                      const Row& row) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& problem, const Row& row, const std::string& fix) const;

  const RowReader& reader_;
  TableOptions options_;
  bool has_header_ = false, is_lonlat_ = false, is_ambiguous_ = false, is_first_ = true;
  std::vector<std::string> names_;                    // of the columns
  std::vector<bool> is_kept_;                         // of the columns
  std::array<std::optional<std::size_t>, 3> column_;  // of each coordinate
  HeightColumn height_ = HeightColumn::z;
  std::vector<std::string> replaced_, unused_heights_;
  std::size_t swapped_ = 0;
  std::vector<Field> fields_;  // of the row in hand
};

}  // namespace vantage::cli
