#include <map>
#include <string>
#include <utility>

#include "vantage/city.h"

namespace vantage {

const char* name_of(Fate fate) {
  switch (fate) {
    case Fate::written:
      return "written";
    case Fate::repaired:
      return "repaired";
    case Fate::open_surface:
      return "open_surface";
    case Fate::skipped:
      return "skipped";
  }
  return "unknown";
}

std::map<std::string, CityTally> tally_by_kind(const CityReport& report) {
  std::map<std::string, CityTally> by_kind;
  for (const CityRecord& record : report.records) {
    CityTally& tally = by_kind[name_of(record.object.kind)];
    ++tally.read;
    ++tally.fates[record.fate];
  }
  return by_kind;
}

std::map<std::pair<Fate, std::string>, std::pair<std::size_t, std::string>> reasons(const CityReport& report) {
  std::map<std::pair<Fate, std::string>, std::pair<std::size_t, std::string>> found;
  for (const CityRecord& record : report.records) {
    if (record.fate == Fate::written) continue;
    auto& [number, first] = found[{record.fate, record.reason}];
    if (number++ == 0) first = record.object.source_id;
  }
  return found;
}

}  // namespace vantage
