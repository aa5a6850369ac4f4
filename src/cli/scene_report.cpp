#include "cli/scene_report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "cli/text_table.h"

namespace vantage::cli {
namespace {

constexpr std::array<std::pair<Fate, const char*>, 4> kFates = {{{Fate::written, "written"},
                                                                 {Fate::repaired, "repaired"},
                                                                 {Fate::open_surface, "open_surface"},
                                                                 {Fate::skipped, "skipped"}}};

const char* name_of(Fate fate) {
  for (const auto& [value, name] : kFates) {
    if (value == fate) return name;
  }
  return "";
}

struct Tally {
  std::size_t read = 0;
  std::map<Fate, std::size_t> fates;
};

std::map<std::string, Tally> tallies(const CityReport& report) {
  std::map<std::string, Tally> by_kind;
  for (const CityRecord& record : report.records) {
    Tally& tally = by_kind[name_of(record.object.kind)];
    ++tally.read;
    ++tally.fates[record.fate];
  }
  return by_kind;
}

/// (fate, reason) -> how many, and the first one's name.
std::map<std::pair<Fate, std::string>, std::pair<std::size_t, std::string>> reasons(const CityReport& report) {
  std::map<std::pair<Fate, std::string>, std::pair<std::size_t, std::string>> found;
  for (const CityRecord& record : report.records) {
    if (record.fate == Fate::written) continue;
    auto& [number, first] = found[{record.fate, record.reason}];
    if (number++ == 0) first = record.object.source_id;
  }
  return found;
}

void add_tally(TextTable& table, const std::string& kind, const Tally& tally) {
  std::string remark;
  for (const auto& [fate, name] : kFates) {
    const auto entry = tally.fates.find(fate);
    if (entry == tally.fates.end()) continue;
    const std::string word = fate == Fate::open_surface ? "written open" : name;
    remark += (remark.empty() ? "" : ", ") + count(entry->second) + " " + word;
  }
  table.row(kind, count(tally.read), remark);
}

/// A remark without the value that it quotes and without numbers, so that remarks of a kind can be counted.
std::string kind_of_remark(const std::string& remark) {
  const std::size_t value = remark.find('=');
  const std::size_t end = remark.find(": ", value == std::string::npos ? 0 : value);
  std::string kind = remark;
  if (value != std::string::npos && end != std::string::npos) kind = remark.substr(0, value) + remark.substr(end);
  kind.erase(std::remove_if(kind.begin(), kind.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
             kind.end());
  return kind;
}

std::map<std::string, std::pair<std::size_t, std::string>> remarks(const CityReport& report) {
  std::map<std::string, std::pair<std::size_t, std::string>> found;
  for (const CityRecord& record : report.records) {
    for (const std::string& remark : record.remarks) {
      auto& [number, first] = found[kind_of_remark(remark)];
      if (number++ == 0) first = record.object.source_id + ", " + remark;
    }
  }
  return found;
}

nlohmann::ordered_json record_json(const CityRecord& record) {
  nlohmann::ordered_json json;
  json["object"] = record.object.source_id;
  if (!record.object.name.empty()) json["name"] = record.object.name;
  json["kind"] = name_of(record.object.kind);
  json["fate"] = name_of(record.fate);
  if (!record.reason.empty()) json["reason"] = record.reason;
  if (!record.remarks.empty()) json["remarks"] = record.remarks;
  if (record.fate != Fate::skipped) {
    json["ground_m"] = record.ground_m;
    json["base_m"] = record.base_m;
    json["top_m"] = record.top_m;
    json["footprint_m2"] = record.footprint_m2;
  }
  return json;
}

void add_city(TextTable& table, const CityReport& report) {
  table.row("read", duration(report.read_seconds), "built and checked in " + duration(report.build_seconds));
  const auto& [west, south, east, north] = report.bounds_deg;
  table.row("the map holds", "latitude " + fixed(south, 5) + " to " + fixed(north, 5), "");
  table.row("", "longitude " + fixed(west, 5) + " to " + fixed(east, 5), west > east ? "across the antimeridian" : "");
  table.heading("what was read");
  for (const auto& [kind, tally] : tallies(report)) add_tally(table, kind, tally);
  if (report.outside > 0) table.row("outside the area", count(report.outside), "left out");
  const auto why = reasons(report);
  if (!why.empty()) table.heading("what was not simply written");
  for (const auto& [key, found] : why) {
    table.row(name_of(key.first), count(found.first), key.second + ", first " + found.second);
  }
  const auto said = remarks(report);
  if (!said.empty()) table.heading("tags that are not as they should be");
  for (const auto& [kind, found] : said) table.row("", count(found.first), found.second);
}

void add_city(nlohmann::ordered_json& json, const CityReport& report) {
  for (const auto& [kind, tally] : tallies(report)) {
    nlohmann::ordered_json counts;
    counts["read"] = tally.read;
    for (const auto& [fate, name] : kFates) {
      const auto entry = tally.fates.find(fate);
      counts[name] = entry == tally.fates.end() ? 0 : entry->second;
    }
    json["kinds"][kind] = counts;
  }
  for (const auto& [key, found] : reasons(report)) json["reasons"][name_of(key.first)][key.second] = found.first;
  json["outside"] = report.outside;
  json["map_bounds_deg"] = report.bounds_deg;  // west, south, east, north
  json["seconds"] = {{"read", report.read_seconds}, {"build", report.build_seconds}};
  json["records"] = nlohmann::ordered_json::array();
  for (const CityRecord& record : report.records) json["records"].push_back(record_json(record));
}

void add_raster(TextTable& table, const RasterReport& report) {
  table.row("posts", count(report.columns * report.rows), count(report.columns) + " x " + count(report.rows));
  table.row("voids", count(report.voids), "posts without a height, filled from their neighbours");
  table.row("heights", fixed(report.lowest_m, 2) + " to " + fixed(report.highest_m, 2), "metres");
  table.row("error", fixed(report.largest_error_m, 3), "metres, vertical, at most, measured at every post");
}

void add_raster(nlohmann::ordered_json& json, const RasterReport& report) {
  json["raster"] = {{"columns", report.columns},     {"rows", report.rows},
                    {"voids", report.voids},         {"lowest_m", report.lowest_m},
                    {"highest_m", report.highest_m}, {"largest_error_m", report.largest_error_m}};
}

}  // namespace

std::vector<std::string> notes_of(const LoadedScene& loaded) {
  std::vector<std::string> notes = loaded.scene.notes;
  if (loaded.city) notes.insert(notes.end(), loaded.city->notes.begin(), loaded.city->notes.end());
  return notes;
}

void add_source(TextTable& table, const LoadedScene& loaded) {
  if (loaded.city) add_city(table, *loaded.city);
  if (loaded.raster) add_raster(table, *loaded.raster);
}

void add_source(nlohmann::ordered_json& json, const LoadedScene& loaded) {
  if (loaded.city) add_city(json, *loaded.city);
  if (loaded.raster) add_raster(json, *loaded.raster);
}

std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file) {
  TextTable table;
  table.heading(file.string());
  if (const auto& place = loaded.scene.georeference) {
    char origin[96];
    std::snprintf(origin, sizeof origin, "%.6f, %.6f", place->latitude_deg, place->longitude_deg);
    table.row("origin", origin, "latitude, longitude; x east, y north, metres");
    if (!place->vertical.empty()) table.row("z from", place->vertical, "");
  }
  table.row("triangles", count(loaded.scene.mesh.triangles.size()), count(loaded.scene.objects.size()) + " objects");
  const Box box = bounding_box(loaded.scene.mesh);
  table.row("from", vector(box.min), "metres");
  table.row("to", vector(box.max), "");
  add_source(table, loaded);
  const std::vector<std::string> notes = notes_of(loaded);
  if (!notes.empty()) table.heading("notes");
  for (const std::string& note : notes) table.heading("  " + note);
  return table.text();
}

std::string scene_json(const LoadedScene& loaded) {
  nlohmann::ordered_json json;
  json["source"] = loaded.scene.source.string();
  if (const auto& place = loaded.scene.georeference) {
    json["georeference"] = {{"latitude_deg", place->latitude_deg},
                            {"longitude_deg", place->longitude_deg},
                            {"vertical", place->vertical},
                            {"source_crs", place->source_crs},
                            {"projection", projection_text(*place)}};
  }
  json["triangles"] = loaded.scene.mesh.triangles.size();
  json["objects"] = loaded.scene.objects.size();
  const Box box = bounding_box(loaded.scene.mesh);
  json["bounds"] = {{"min", {box.min.x(), box.min.y(), box.min.z()}}, {"max", {box.max.x(), box.max.y(), box.max.z()}}};
  json["notes"] = notes_of(loaded);
  add_source(json, loaded);
  // A name is bytes from a file, and JSON takes UTF-8 only: others are replaced rather than refused.
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace vantage::cli
