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
#include "tiles/hierarchy.h"

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

/// Value `index` of a property of a batch table as text: empty for what is neither a text nor a number, and beyond the
/// end of an array. `binary`: of the table. Throws std::string.
std::string property_text(const Json& values, std::string_view binary, std::uint64_t index);

/// `count` whole numbers, of an array of that length or in the binary part, as UNSIGNED_SHORT where it does not say.
/// Throws std::string.
std::vector<std::uint32_t> whole_numbers(const Json& values, const std::string& name, std::uint64_t count,
                                         std::string_view binary);

/// Who the features of a tile are.
class BatchTable {
 public:
  /// A table, or a hierarchy, that is garbled is taken as missing (unreadable()).
  BatchTable(std::string_view json, std::string_view binary, std::string tile, const core::ProgressReporter& progress,
             const core::ReadLimits& limits);

  /// By its own properties, and where these do not say by the hierarchy.
  SceneObject identity(std::uint64_t feature);

  const io::UnreadableProperties& unreadable() const { return unreadable_; }

 private:
  std::string value(const std::string& property, std::uint64_t feature);
  void read_hierarchy(const core::ProgressReporter& progress);

  Table table_;
  std::string_view binary_;
  std::string tile_;
  io::IdentityProperties known_;
  std::optional<Hierarchy> hierarchy_;
  io::UnreadableProperties unreadable_;
  std::size_t inherited_bytes_ = 0;  ///< of all texts that the hierarchy gave
};

}  // namespace vantage::internal::tiles
