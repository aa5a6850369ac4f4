// read_areas: the areas of a map that can be targets.
#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "common/input.h"
#include "maps/city/footprint.h"
#include "maps/city/interruption.h"
#include "maps/city/region.h"
#include "maps/city/structures.h"
#include "maps/osm/extract.h"
#include "vantage/city.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::city::Footprint;
using internal::city::Vec2;
using internal::geo::LocalFrame;
namespace osm = internal::osm;

bool has_tag(const osm::Tags& tags, const AreaTag& wanted) {
  if (!tags.has(wanted.key)) return false;
  const std::string_view value = tags.get(wanted.key);
  return wanted.value.empty() ? value != "no" : value == wanted.value;
}

bool has_name(const osm::Tags& tags) { return !tags.get("name").empty(); }

bool is_wanted(const osm::Tags& tags, const AreaFilter& filter) {
  return (!filter.named || has_name(tags)) &&
         std::all_of(filter.tags.begin(), filter.tags.end(), [&](const AreaTag& tag) { return has_tag(tags, tag); });
}

AreaPolygon::Ring ring_of(const osm::Ring& ring) {
  AreaPolygon::Ring positions;
  for (const osm::LonLat& at : ring) positions.push_back({at.longitude_deg, at.latitude_deg});
  return positions;
}

/// Nothing where it bounds nothing, or nobody knows what, or nothing in the region.
std::optional<MapArea> area_of(const osm::Area& source, const osm::RegionFilter& region) {
  MapArea area;
  area.source_id = osm::text(source.id);
  area.name = source.tags.get("name");
  area.tags = source.tags.all;
  for (const osm::Polygon& polygon : source.polygons) {
    area.polygons.push_back({ring_of(polygon.outer), {}});
    for (const osm::Ring& hole : polygon.holes) area.polygons.back().holes.push_back(ring_of(hole));
  }
  // About one of its own corners: distances are good wherever the map lies.
  const LocalFrame frame(source.polygons.front().outer.front());
  internal::city::Repairs repairs;
  const std::vector<Footprint> footprints = internal::city::footprints_of(source, frame, repairs);
  if (footprints.empty() || repairs.enclosed || source.partial) return std::nullopt;
  if (!internal::city::reaches_into(region, footprints, frame)) return std::nullopt;
  area.area_m2 = internal::city::area_m2(footprints);
  Vec2 min = footprints.front().outer.front(), max = min;
  for (const Footprint& footprint : footprints) {
    for (const Vec2& corner : footprint.outer) {
      min = min.cwiseMin(corner);
      max = max.cwiseMax(corner);
    }
  }
  const osm::LonLat middle = frame.to_lonlat((min + max) / 2);
  area.center_deg = {middle.latitude_deg, middle.longitude_deg};
  return area;
}

std::string text_of(const AreaTag& tag) { return tag.key + "=" + (tag.value.empty() ? "*" : tag.value); }

std::string count_text(std::size_t count) { return std::to_string(count) + (count == 1 ? " area" : " areas"); }

/// The nearest of some names, with how many areas have it.
std::string nearest_text(const std::string& word, const std::map<std::string, std::size_t>& counts) {
  std::vector<std::string_view> names;
  for (const auto& entry : counts) names.push_back(entry.first);
  const std::string nearest(nearest_name(word, names));
  return in_quotes(nearest) + " (" + count_text(counts.at(nearest)) + ")";
}

/// What the areas of the whole map have, to say why none is as wanted.
class Census {
 public:
  Census(const osm::Extract& extract, const AreaFilter& filter) : filter_(filter), with_(filter.tags.size()) {
    for (const osm::Area& area : extract.areas) {
      ++areas_;
      named_ += has_name(area.tags);
      matching_ += is_wanted(area.tags, filter);
      for (const auto& tag : area.tags.all) ++keys_[tag.first];
      for (std::size_t i = 0; i < with_.size(); ++i) {
        with_[i] += has_tag(area.tags, filter.tags[i]);
        if (area.tags.has(filter.tags[i].key)) ++values_[i][std::string(area.tags.get(filter.tags[i].key))];
      }
    }
  }

  /// What to do instead.
  std::string advice() const {
    if (areas_ == 0) return "give a map with areas: this one has none";
    if (matching_ > 0 && (filter_.region.center_deg || filter_.region.bbox_deg)) {
      return "choose a larger region: " + count_text(matching_) + " of the map " + (matching_ == 1 ? "lies" : "lie") +
             " outside of it";
    }
    if (matching_ > 0) return "choose others: the outlines of these bound nothing";
    for (std::size_t i = 0; i < with_.size(); ++i) {
      if (with_[i] == 0) return advice_on(i);
    }
    std::string text = "ask for less: ";
    for (std::size_t i = 0; i < with_.size(); ++i) {
      text += count_text(with_[i]) + " with " + text_of(filter_.tags[i]) + ", ";
    }
    if (filter_.named) text += std::to_string(named_) + " with a name, ";
    return text + "none with all of it";
  }

 private:
  std::string advice_on(std::size_t tag) const {
    const std::string& key = filter_.tags[tag].key;
    const auto values = values_.find(tag);
    if (values == values_.end()) {
      return "no area has the key " + in_quotes(key) + "; the nearest is " + nearest_text(key, keys_);
    }
    return "areas have other values of " + in_quotes(key) + "; the nearest is " +
           nearest_text(filter_.tags[tag].value, values->second);
  }

  const AreaFilter& filter_;
  std::size_t areas_ = 0, named_ = 0, matching_ = 0;
  std::vector<std::size_t> with_;  // areas with each tag
  std::map<std::string, std::size_t> keys_;
  std::map<std::size_t, std::map<std::string, std::size_t>> values_;  // of the key of each tag
};

[[noreturn]] void fail_none(const std::filesystem::path& file, const AreaFilter& filter, const Progress& progress) {
  std::string wanted;
  for (const AreaTag& tag : filter.tags) wanted += (wanted.empty() ? "" : " and ") + text_of(tag);
  if (filter.named) wanted += wanted.empty() ? "a name" : " and a name";
  const bool is_part = filter.region.center_deg || filter.region.bbox_deg;
  const Census census(osm::read_extract(file, {}, progress), filter);
  throw Error(ErrorCode::map_object_missing,
              std::string("no area of the ") + (is_part ? "region" : "map") +
                  (wanted.empty() ? " can be listed" : " has " + wanted),
              file.string(), census.advice());
}

}  // namespace

AreaTag area_tag(const std::string& text, const std::string& where) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size()) {
    throw Error(ErrorCode::value_syntax, in_quotes(text) + " is not a tag", where,
                "write key=value, such as amenity=parking, or key=* for any value");
  }
  const std::string value = text.substr(sign + 1);
  return {text.substr(0, sign), value == "*" ? "" : value};
}

std::vector<MapArea> read_areas(const std::filesystem::path& file, const AreaFilter& filter, const Progress& progress) {
  const auto wanted = [&filter](const osm::Tags& tags) { return is_wanted(tags, filter); };
  const std::optional<osm::Region> region = internal::city::checked_region(filter.region);
  const osm::RegionFilter in_region(region);
  const osm::Extract extract = osm::read_extract(file, {region, wanted}, progress);
  internal::city::check_complete(extract, file);
  internal::city::check_overlap(filter.region, extract, file);
  const internal::core::ProgressReporter reporter(progress);
  reporter.begin("outlines");
  const internal::city::Interruption interruption(reporter);
  std::vector<MapArea> areas;
  for (const osm::Area& source : extract.areas) {
    if (auto area = area_of(source, in_region)) areas.push_back(std::move(*area));
  }
  if (areas.empty()) fail_none(file, filter, progress);
  return areas;
}

}  // namespace vantage
