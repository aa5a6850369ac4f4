// Tables of points: what their columns mean, and what is written beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/row_reader.h"
#include "common/table_columns.h"
#include "vantage/error.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/ground.h"
#include "vantage/query.h"

namespace vantage::cli {

struct TableOptions {
  bool lonlat = false;                 ///< longitude and latitude, not x and y
  bool json = false;                   ///< write objects, not rows
  bool fraction = false;               ///< write which part of the target is seen, too
  bool target = false;                 ///< write the target's name, too
  std::optional<double> z;             ///< of all points; then the table has no such column
  std::optional<HeightDatum> heights;  ///< what heights are measured from where the table does not say
};

/// What moves points of a table into the scene frame.
struct PointFrame {
  std::optional<Georeference> place;  ///< for longitudes and latitudes
  Box bounds;                         ///< of the scene
  double zero_m = 0;  ///< height of what heights are measured from, if that is neither z of the scene nor the ground
  std::optional<GroundLevels> ground = {};  ///< for HeightDatum::ground
};

/// A table whose first row is read. Where that holds words it is a header, with titles as known_column has them: x, y
/// and z are taken, or lon, lat and z, or in the place of z another height. Else the first three columns are taken.
/// Heights that say nothing of their level need that of the options.
class PointTable {
 public:
  /// Throws Error(input), with the line, for a header that lacks a column or has one that contradicts the options.
  PointTable(const RowReader& reader, const Row& first, const TableOptions& options);

  /// Whether the first row holds no point.
  bool has_header() const { return has_header_; }
  bool is_lonlat() const { return is_lonlat_; }
  /// What the third coordinate is measured from: scene_z, sea_level, ellipsoid, ground or home.
  HeightDatum height() const { return height_; }
  const std::string& height_name() const { return height_name_; }  ///< of its column
  /// Other columns of heights that the header has and that are not used.
  std::vector<std::string> unused_heights() const;

  bool has_fraction() const { return options_.fraction; }

  /// Columns of the points' table that the answers' replace: those of an earlier run, for example.
  const std::vector<std::string>& replaced() const { return replaced_; }
  /// Whether the header has x, y as well as lon, lat.
  bool is_ambiguous() const { return is_ambiguous_; }

  /// The coordinates in a row: x and y, or longitude and latitude, and the height as it stands there. Throws
  /// Error(input), with the line.
  Vec3 coordinates(const Row& row);

  /// The point of the scene frame that has these coordinates. Throws Error(input), with the line, for what is not a
  /// place on the earth, or far away, and for heights above a ground that is not there.
  Vec3 scene_point(const Vec3& stated, const PointFrame& frame, const Row& row);

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
  bool is_answer(const std::string& column) const;
  void append_csv(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                  const std::optional<double>& fraction, const std::string& target) const;
  void append_json(std::string& text, const Vec3& coordinates, const PointAnswer& answer,
                   const std::optional<double>& fraction, const std::string& target);
  std::optional<std::size_t> axis_of(std::size_t column) const;
  TableColumn meaning_of(std::size_t axis) const;
  std::vector<std::size_t> columns_of(TableColumn column) const;
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
  std::vector<std::optional<KnownColumn>> known_;     // of the columns, what their titles say
  std::array<std::optional<std::size_t>, 3> column_;  // of each coordinate
  Vec3 factor_ = Vec3::Ones();                        // from the unit of each coordinate to metres or degrees
  TableNumbers numbers_;
  HeightDatum height_ = HeightDatum::scene_z;
  std::string height_name_;
  std::vector<std::string> replaced_;
  std::vector<std::size_t> unused_heights_;
  std::size_t swapped_ = 0;
  std::vector<Field> fields_;  // of the row in hand
};

}  // namespace vantage::cli
