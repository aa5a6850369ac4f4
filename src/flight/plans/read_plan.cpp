// Which format a plan is of, and what it is packed in.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include "common/input.h"
#include "core/progress_reporter.h"
#include "flight/plans/plan_source.h"
#include "flight/plans/text_lines.h"
#include "io/zip.h"
#include "vantage/error.h"
#include "vantage/flight.h"

namespace vantage {
namespace {

namespace plans = internal::flight::plans;
using internal::io::ZipProblem;

constexpr const char* kPlanAdvice =
    "give a .plan of QGroundControl, a table of waypoints, KML, KMZ, GPX, GeoJSON, or a CSV table with a header";

/// What is in a KMZ archive: the one KML or WPML. DJI's waylines have the template that they were made from beside
/// them.
std::string unpacked(const plans::PlanSource& source) {
  const auto fail = [&](const ZipProblem& problem) {
    const bool is_too_large = problem.kind == ZipProblem::Kind::too_large;
    source.fail(is_too_large ? ErrorCode::file_too_large : ErrorCode::plan_syntax, "",
                "the file is a zip archive, as KMZ is, and " + problem.text,
                "give a KMZ file, or the .kml or .wpml that is in it");
  };
  try {
    std::vector<std::string> names = internal::io::names_in_zip(source.text, ".wpml");
    std::vector<std::string> drawn = internal::io::names_in_zip(source.text, ".kml");
    const char* const kind = names.empty() ? ".kml" : ".wpml";
    const auto is_template = [](const std::string& name) {
      return name == "template.kml" || name.ends_with("/template.kml");
    };
    const auto made_from = names.empty() ? drawn.end() : std::find_if(drawn.begin(), drawn.end(), is_template);
    if (made_from != drawn.end()) drawn.erase(made_from);
    names.insert(names.end(), drawn.begin(), drawn.end());
    for (const char* other : {".kmz", ".gpx", ".plan", ".waypoints", ".geojson"}) {
      const std::vector<std::string> more = internal::io::names_in_zip(source.text, other);
      if (!names.empty()) names.insert(names.end(), more.begin(), more.end());
    }
    if (names.size() > 1) {
      constexpr std::size_t kMostNamed = 5;
      std::string list;
      for (std::size_t i = 0; i < names.size() && i < kMostNamed; ++i) {
        list += (list.empty() ? "" : ", ") + in_quotes(names[i]);
      }
      source.fail(ErrorCode::value_unsupported, "",
                  "the archive holds " + std::to_string(names.size()) +
                      " files of plans, and which of them is flown is "
                      "not said: " +
                      list + (names.size() > kMostNamed ? ", ..." : ""),
                  "unpack it, and give the one that is to be flown");
    }
    return internal::io::unzipped(source.text, names.empty() ? "" : names.front(), kind, kMostPlanBytes);
  } catch (const ZipProblem& problem) {
    fail(problem);
  }
  return {};
}

/// The name of the first element, without its name space.
std::string_view root_element(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    if (text.substr(at, 4) == "<!--") {  // a comment may hold what looks like elements
      at = text.find("-->", at);
      if (at == std::string_view::npos) return {};
      continue;
    }
    if (at + 1 < text.size() && (text[at + 1] == '?' || text[at + 1] == '!')) continue;
    const std::string_view name = text.substr(at + 1, text.find_first_of(" \t\r\n/>", at + 1) - at - 1);
    return name.substr(name.rfind(':') + 1);
  }
  return {};
}

bool is_utf16(std::string_view text) {
  constexpr std::string_view kBegins[] = {"\xFF\xFE", "\xFE\xFF", std::string_view("<\0", 2),
                                          std::string_view("\0<", 2)};
  return std::find(std::begin(kBegins), std::end(kBegins), text.substr(0, 2)) != std::end(kBegins);
}

/// Half a pair of surrogates becomes U+FFFD.
std::string utf8_of_utf16(std::string_view text) {
  const bool is_big = text[0] == '\xFE' || text[0] == '\0';
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
    return static_cast<unsigned>(is_big ? first << 8 | second : second << 8 | first);
  };
  std::string utf8;
  utf8.reserve(text.size());
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    unsigned code = unit(i);
    const bool is_pair = code >= 0xD800 && code < 0xDC00 && i + 3 < text.size() && unit(i + 2) >> 10 == 0xDC00 >> 10;
    if (is_pair) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    const auto add = [&](unsigned byte) { utf8 += static_cast<char>(byte); };
    const auto add_rest = [&](unsigned shift) { add(0x80 | (code >> shift & 0x3F)); };
    if (code < 0x80) {
      add(code);
    } else if (code < 0x800) {
      add(0xC0 | code >> 6);
      add_rest(0);
    } else if (code < 0x10000) {
      add(0xE0 | code >> 12);
      add_rest(6);
      add_rest(0);
    } else {
      add(0xF0 | code >> 18);
      add_rest(12);
      add_rest(6);
      add_rest(0);
    }
  }
  return utf8;
}

FlightPlan parse_text(const plans::PlanSource& source) {
  const std::string_view text = plans::without_blanks(source.text);
  if (text.empty()) source.fail(ErrorCode::file_empty, "", "the plan is empty", kPlanAdvice);
  if (text.front() == '<') {
    const std::string_view root = root_element(text);
    if (root == "gpx") return plans::read_gpx(source);
    if (root == "kml") return plans::read_kml(source);
    source.fail(ErrorCode::plan_syntax, "", "not a plan: XML about <" + printable(root.substr(0, 60)) + ">",
                kPlanAdvice);
  }
  if (text.front() == '{') return plans::read_json(source);
  if (text.substr(0, 7) == "QGC WPL") return plans::read_waypoints(source);
  const bool is_text = std::none_of(text.begin(), text.begin() + std::min<std::size_t>(text.size(), 1000), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 0x20 && c != '\t' && c != '\r' && c != '\n';
  });
  if (!is_text) source.fail(ErrorCode::plan_syntax, "", "not a plan: the file is not text", kPlanAdvice);
  return plans::read_csv(source);
}

FlightPlan parse_bytes(std::string_view bytes, const std::string& name, const ReadPlanOptions& options) {
  plans::PlanSource source;
  source.text = bytes;
  source.name = name;
  source.track = options.track;
  source.progress = internal::core::ProgressReporter(options.progress, name);
  source.progress.begin("read the plan");
  if (bytes.size() > kMostPlanBytes) {
    source.fail(
        ErrorCode::file_too_large, "",
        "the plan is too large: " + std::to_string(bytes.size()) + " bytes, at most " + std::to_string(kMostPlanBytes),
        "take a part of it");
  }
  std::string made;
  if (internal::io::is_zip(bytes)) {
    made = unpacked(source);
    source.text = made;
    if (internal::io::is_zip(made)) {
      source.fail(ErrorCode::plan_syntax, "", "the file is a zip archive in a zip archive", "unpack it");
    }
  }
  std::string recoded;
  if (is_utf16(source.text)) {
    recoded = utf8_of_utf16(source.text);
    source.text = recoded;
    source.was_utf16 = true;
  }
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (source.text.substr(0, kMark.size()) == kMark) source.text.remove_prefix(kMark.size());
  FlightPlan plan = parse_text(source);
  source.progress.finish();
  return plan;
}

std::string read_bytes(const std::filesystem::path& file) {
  check_readable(file, "the plan");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(ErrorCode::file_unreadable, std::string("the plan cannot be read: ") + std::strerror(errno),
                file.string(), "check its permissions");
  }
  // In portions: what a pipe holds is not known before.
  std::string bytes;
  constexpr std::size_t kPortion = 1 << 20;
  while (stream.good() && bytes.size() <= kMostPlanBytes) {
    const std::size_t read = bytes.size();
    bytes.resize(read + kPortion);
    stream.read(bytes.data() + read, static_cast<std::streamsize>(kPortion));
    bytes.resize(read + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw Error(ErrorCode::file_unreadable, "the plan cannot be read to its end", file.string(),
                "check the disk that it lies on");
  }
  return bytes;
}

}  // namespace

const char* name_of(HeightDatum datum) {
  constexpr std::array kNames = {"z of the scene", "sea level", "the WGS 84 ellipsoid",
                                 "the ground",     "the home",  "an unknown level"};
  return kNames.at(static_cast<std::size_t>(datum));
}

const char* name_of(PlanFormat format) {
  constexpr std::array kNames = {
      "a plan of QGroundControl", "a table of waypoints", "KML", "WPML", "GPX", "GeoJSON", "CSV", "CZML"};
  return kNames.at(static_cast<std::size_t>(format));
}

FlightPlan parse_flight_plan(std::string_view bytes, const std::string& name, const ReadPlanOptions& options) {
  return parse_bytes(bytes, name, options);
}

FlightPlan read_flight_plan(const std::filesystem::path& file, const ReadPlanOptions& options) {
  return parse_bytes(read_bytes(file), file.string(), options);
}

}  // namespace vantage
