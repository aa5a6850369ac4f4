// The files and the table of a mission with a volume for each target.
#include <algorithm>
#include <set>

#include "common/input.h"
#include "common/output.h"
#include "io/written_marks.h"
#include "vantage/result.h"

namespace vantage {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

/// Long names are cut: file systems take 255 bytes.
std::string file_text(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  std::string text = name.substr(0, kLongest);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !is_plain(c); }, '_');
  return text;
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace

std::vector<std::filesystem::path> volume_files(const std::filesystem::path& file,
                                                const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files;
  std::set<std::string> taken;  // some file systems take upper and lower case for one
  for (const std::string& name : names) {
    const std::string text = file_text(name);
    std::string free = text;
    for (int number = 2; !taken.insert(lower_case(free)).second; ++number) free = text + "-" + std::to_string(number);
    std::filesystem::path path = volume_output(file);
    path.replace_filename(path.stem().string() + "." + free + path.extension().string());
    files.push_back(std::move(path));
  }
  return files;
}

std::filesystem::path table_file(const std::filesystem::path& file) {
  return volume_output(file).replace_extension(".table.csv");
}

std::string table_csv(const std::vector<TableRow>& rows) {
  std::string text = std::string(internal::io::kVolumeTableHeader) + "\n";
  for (const TableRow& row : rows) {
    const Volume& volume = *row.volume;
    const bool has_volume = volume.outcome == Outcome::computed;
    const double lift = volume.lift_m.empty() ? 0 : *std::max_element(volume.lift_m.begin(), volume.lift_m.end());
    text += csv_field(row.target) + "," + name_of(volume.outcome) + "," + csv_field(volume.reason) + ",";
    text += shortest(row.measures->volume_m3) + "," + shortest(row.measures->area_m2) + ",";
    text += std::to_string(row.measures->facets) + "," + std::to_string(row.measures->pieces) + ",";
    text += shortest(lift) + "," + shortest(volume.seconds.total) + ",";
    text += (has_volume ? csv_field(row.file.filename().string()) : "") + "\n";
  }
  return text;
}

}  // namespace vantage
