#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <vector>

#include "cli/command.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "vantage/camera.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

constexpr const char* kCamerasExamples =
    "EXAMPLES\n"
    "  vantage cameras\n"
    "  vantage cameras mavic thermal                # those with both words in their name, maker or model\n"
    "  vantage cameras CameraMetaData.json          # a list of QGroundControl, and what is wrong in it\n"
    "  vantage cameras sensor_data.json | grep DJI  # a list of OpenSfM: widths of sensors\n"
    "  vantage cameras --json | jq -r '.cameras[] | .name + \": \" + .source'\n";

struct CamerasArguments {
  CommonOptions common;
  std::vector<std::string> words;  // one of them may be a file
  bool json = false;
};

/// A name with a folder, or one with an ending that is there or ends as lists do; "-", which is refused as a file. A
/// word may have a dot too: "27.4".
bool is_list_file(const std::string& word) {
  const std::filesystem::path path(word);
  std::error_code error;
  return word == "-" || path.has_parent_path() || path.extension() == ".json" ||
         (path.has_extension() && std::filesystem::exists(path, error));
}

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// Whether each word is a part of the name, the maker or the model; small and capital letters are the same.
bool has_all(const Camera& camera, const std::vector<std::string>& words) {
  const std::string text = lower_case(camera.name + "\n" + camera.maker + "\n" + camera.model);
  return std::all_of(words.begin(), words.end(),
                     [&](const std::string& word) { return text.find(lower_case(word)) != std::string::npos; });
}

/// Takes the file out of the words; empty where there is none.
std::string file_among(std::vector<std::string>& words) {
  const auto first = std::find_if(words.begin(), words.end(), is_list_file);
  if (first == words.end()) return "";
  std::string file = *first;
  words.erase(first);
  if (const auto second = std::find_if(words.begin(), words.end(), is_list_file); second != words.end()) {
    throw Error(ErrorCode::conflicting_keys, "two files are named, " + in_quotes(file) + " and " + in_quotes(*second),
                "command line", "name one list, and words without slashes");
  }
  return file;
}

/// A list without an ending is taken for a word.
std::string advice_without_matches(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    std::error_code error;
    if (std::filesystem::is_regular_file(word, error)) return "to read the list in that file, name it ./" + word;
  }
  return "use fewer words, or none: then all cameras are listed; name a list with its folder: ./list";
}

std::vector<ListedCamera> listed_cameras(const std::string& file) {
  if (!file.empty()) return read_cameras(file);
  std::vector<ListedCamera> cameras;
  for (const Camera& camera : known_cameras()) cameras.push_back({camera, {}});
  return cameras;
}

/// The name, then numbers. What is not known is "-".
using CameraCells = std::array<std::string, 6>;

std::string two_sides(const std::string& width, const std::string& height) { return width + " x " + height; }

std::string side_or_dash(double number) { return number > 0 ? shortest(number) : "-"; }

CameraCells cells_of(const ListedCamera& listed) {
  const Camera& camera = listed.camera;
  CameraCells cells = {camera.name.empty() ? "-" : camera.name, "-", "-", "-", "-", "-"};
  if (camera.width_px > 0 || camera.height_px > 0)
    cells[1] = two_sides(side_or_dash(camera.width_px), side_or_dash(camera.height_px));
  if (camera.sensor_width_mm > 0 || camera.sensor_height_mm > 0) {
    cells[2] = two_sides(side_or_dash(camera.sensor_width_mm), side_or_dash(camera.sensor_height_mm));
  }
  cells[3] = side_or_dash(camera.focal_length_mm);
  if (const std::optional<Pinhole> pinhole = pinhole_if_known(listed)) {
    const auto [horizontal, vertical] = pinhole->fov_deg();
    cells[4] = two_sides(fixed(horizontal, 1), fixed(vertical, 1));
  }
  if (const auto& pitch = camera.carrier.pitch_deg) cells[5] = shortest((*pitch)[0]) + " to " + shortest((*pitch)[1]);
  return cells;
}

std::size_t characters_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Names to the left, numbers to the right.
std::string aligned_cells(const std::vector<CameraCells>& rows) {
  std::array<std::size_t, std::tuple_size_v<CameraCells>> widths{};
  for (const CameraCells& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], characters_of(row[i]));
  }
  std::string text;
  for (const CameraCells& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - characters_of(row[i]), ' ');
      text += i == 0 ? row[i] + blanks : "  " + blanks + row[i];
    }
    text += "\n";
  }
  return text;
}

std::string cameras_table(const std::vector<ListedCamera>& cameras) {
  std::vector<CameraCells> rows = {
      {"name", "picture px", "sensor mm", "focal mm", "field of view deg", "gimbal pitch deg"}};
  std::string problems;
  std::size_t bad = 0;
  for (const ListedCamera& listed : cameras) {
    rows.push_back(cells_of(listed));
    if (listed.problem.empty()) continue;
    ++bad;
    problems += "  " + listed.camera.source;
    if (!listed.camera.name.empty()) problems += ", " + in_quotes(listed.camera.name);
    problems += ": " + printable(listed.problem) + "\n";
  }
  std::string text = aligned_cells(rows);
  if (bad > 0) text += "\n" + count(bad) + " of " + count(cameras.size()) + " cannot be used:\n" + problems;
  return text;
}

int run_cameras(const CamerasArguments& options) {
  std::vector<std::string> words = options.words;
  const std::string file = file_among(words);
  std::vector<ListedCamera> cameras = listed_cameras(file);
  std::erase_if(cameras, [&](const ListedCamera& listed) { return !has_all(listed.camera, words); });
  if (cameras.empty() && !words.empty()) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : " and ") + in_quotes(word);
    throw Error(ErrorCode::unknown_choice, "no camera has " + all + " in its name, maker or model",
                file.empty() ? "command line" : file, advice_without_matches(words));
  }
  print(options.json ? json_text(cameras) : cameras_table(cameras));
  return kSuccess;
}

}  // namespace

void add_cameras(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<CamerasArguments>();
  CLI::App* command = app.add_subcommand(
      "cameras", "List the cameras that vantage knows by name, or those of a list of QGroundControl or OpenSfM");
  command
      ->add_option(
          "words", options->words,
          "List to read instead: CameraMetaData.json of QGroundControl or sensor_data.json of OpenSfM; and words "
          "that the name, maker or model of a camera must have")
      ->option_text("[FILE] [WORD...]");
  command->add_flag("--json", options->json,
                    "Print JSON instead of a table, with gimbal and aircraft, and the sources");
  finish<CamerasArguments>(*command, options, kCamerasExamples, chosen, run_cameras);
}

}  // namespace vantage::cli
