// The tables of b3dm and i3dm (3D Tiles 1.0, sections "Feature table" and "Batch table"): JSON, whose values may be in
// a binary part behind it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "io/feature_identity.h"
#include "tiles/bounds.h"

namespace vantage::internal::tiles {

/// A table. Its members throw std::string, what is wrong.
class Table {
 public:
  Table(std::string_view json, std::string_view binary, const core::ProgressReporter& progress,
        const core::ReadLimits& limits);

  const Json& json() const { return json_; }
  bool is_empty() const { return is_empty_; }  ///< without any JSON
  /// Values of a global property, as RTC_CENTER; nothing without it.
  std::optional<std::vector<double>> global(const char* name, std::size_t count) const;
  std::uint64_t whole(const char* name) const;  ///< throws without it

  /// A property that has `components` numbers for each of `count` instances: the numbers of all. `type`: as in a
  /// batch table ("FLOAT"), where the property does not say.
  std::optional<std::vector<double>> per_instance(const char* name, std::size_t components, std::size_t count,
                                                  const char* type) const;

 private:
  Json json_;
  bool is_empty_ = true;
  std::string_view binary_;
};

/// Who the features of a tile are.
class BatchTable {
 public:
  /// Throws std::string.
  BatchTable(std::string_view json, std::string_view binary, std::string tile, const core::ProgressReporter& progress,
             const core::ReadLimits& limits);

  SceneObject identity(std::uint64_t feature) const;

 private:
  std::string value(const std::string& property, std::uint64_t feature) const;

  std::optional<Table> table_;  ///< nothing where the tile has none
  std::string_view binary_;
  std::string tile_;
  io::IdentityProperties known_;
};

}  // namespace vantage::internal::tiles
