#include "cli/picture_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "cli/text_table.h"
#include "common/input.h"
#include "common/output.h"
#include "common/shown_address.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

[[noreturn]] void refuse_view(ErrorCode code, const std::string& problem) {
  throw Error(code, problem, "command line, --view",
              "write --view top, --view oblique, --view oblique AZIMUTH,ELEVATION or --view from X,Y,Z");
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  for (const std::string_view part : split_at_commas(text)) {
    const ParsedNumber parsed = parse_number(part);
    if (parsed.fault != NumberFault::none) {
      refuse_view(ErrorCode::not_a_number, "the view's " + in_quotes(part) + " is not a number");
    }
    values.push_back(parsed.value);
  }
  return values;
}

/// "from 1,2,3" in two words, for those who quote it as one.
std::vector<std::string> split_once(const std::string& text) {
  const std::size_t end = text.find(' ');
  const std::size_t next = text.find_first_not_of(' ', std::min(end, text.size()));
  if (next == std::string::npos) return {text.substr(0, end)};
  return {text.substr(0, end), text.substr(next)};
}

/// "12,345": groups of three digits.
std::string grouped(double value) {
  std::string digits = fixed(value, value < 100 ? 1 : 0);
  const std::size_t end = std::min(digits.find('.'), digits.size());
  for (std::size_t at = end; at > 3 && digits[at - 4] != '-'; at -= 3) digits.insert(at - 3, 1, ',');
  return digits;
}

}  // namespace

PictureView parse_view(const std::vector<std::string>& given) {
  PictureView view;
  if (given.empty()) return view;
  const std::vector<std::string> words = given.size() == 1 ? split_once(given[0]) : given;
  const std::string& kind = words[0];
  const std::vector<double> values = words.size() > 1 ? numbers(words[1]) : std::vector<double>{};
  if (kind == "top") {
    if (!values.empty()) refuse_view(ErrorCode::value_syntax, "the view from the top takes no numbers");
    view.kind = PictureView::Kind::top;
  } else if (kind == "oblique") {
    if (values.size() > 2) refuse_view(ErrorCode::value_syntax, "an oblique view takes two numbers at most");
    if (!values.empty()) view.azimuth_deg = values[0];
    if (values.size() > 1) view.elevation_deg = values[1];
    if (std::abs(view.elevation_deg) > 90)
      refuse_view(ErrorCode::value_out_of_range, "the view's elevation is beyond 90 degrees");
  } else if (kind == "from") {
    if (values.size() != 3)
      refuse_view(ErrorCode::value_syntax, "the view from a point needs its three coordinates, joined by commas");
    view.kind = PictureView::Kind::from;
    view.from = {values[0], values[1], values[2]};
  } else {
    refuse_view(ErrorCode::unknown_choice, "no view is called " + in_quotes(kind));
  }
  return view;
}

std::array<int, 2> parse_size(const std::string& text) {
  std::array<int, 2> size{};
  const char *at = text.data(), *end = text.data() + text.size();
  const auto first = std::from_chars(at, end, size[0]);
  const bool is_cross = first.ec == std::errc() && first.ptr != end && (*first.ptr == 'x' || *first.ptr == 'X');
  const auto second = is_cross ? std::from_chars(first.ptr + 1, end, size[1]) : first;
  const auto in_range = [](int pixels) { return pixels >= kSmallestPicture && pixels <= kLargestPicture; };
  if (is_cross && second.ec == std::errc() && second.ptr == end && in_range(size[0]) && in_range(size[1])) return size;
  throw Error(ErrorCode::value_syntax, in_quotes(text) + " is not a size of a picture", "command line, --size",
              "write WIDTHxHEIGHT in pixels, " + std::to_string(kSmallestPicture) + " to " +
                  std::to_string(kLargestPicture) + " each: 1600x1200");
}

void check_picture_file(const std::string& file) {
  std::error_code error;
  if (format_extension(file) != ".png" && !std::filesystem::is_directory(file, error)) {
    throw Error(ErrorCode::output_format_unknown, "pictures are written as PNG, not as " + in_quotes(file), file,
                "give the output a name that ends in .png");
  }
  check_can_write(file);
}

std::string picture_subtitle(const Mission& mission, const Volume* volume) {
  const std::string dot = " \u00b7 ";
  std::string range = fixed(range_limit_m(mission.sensor), 1);
  if (range.ends_with(".0")) range.resize(range.size() - 2);
  std::string text = "range " + range + "\u2009m";
  if (volume != nullptr && volume->outcome != Outcome::computed) {
    text += dot + "no volume: " + volume->reason;
  } else if (volume != nullptr) {
    text += dot + grouped(enclosed_volume(volume->mesh)) + "\u2009m\u00b3";
  }
  return text + dot + shown_address(mission.as_written.scene.file).filename().string();
}

}  // namespace vantage::cli
