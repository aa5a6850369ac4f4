#include "cli/plan_output.h"

#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/output.h"
#include "common/time_text.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

DjiAircraft aircraft_of(const std::string& text) {
  std::vector<int> numbers;
  bool is_right = true;
  for (const std::string_view part : split_at_commas(text)) {
    int& number = numbers.emplace_back();
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    is_right = is_right && error == std::errc() && end == part.data() + part.size() && number >= 0;
  }
  if (!is_right || numbers.size() < 2 || numbers.size() > 3) {
    throw Error(
        ErrorCode::value_syntax, in_quotes(text) + " does not name an aircraft of DJI", "command line, --aircraft",
        "give the numbers of its type and subtype in DJI's documents, and of its camera: 77,0,66 for the Mavic 3E");
  }
  DjiAircraft aircraft;
  aircraft.drone = numbers[0];
  aircraft.drone_sub_type = numbers[1];
  if (numbers.size() > 2) aircraft.payload = numbers[2];
  return aircraft;
}

}  // namespace

void check_can_write_like(const std::string& file, const std::string& example) {
  try {
    check_can_write(file);
  } catch (const Error& error) {
    std::error_code unknown;
    const bool is_folder = std::filesystem::is_directory(file, unknown);
    if (!is_folder && error.code() != ErrorCode::output_name_missing) throw;
    throw error.with_fix("name a file, such as " + (std::filesystem::path(file) / example).string());
  }
}

void add_plan_output(CLI::App& command, PlanOutput& output) {
  command
      .add_option("--aircraft", output.aircraft,
                  "For .kmz: type, subtype and camera, as DJI numbers them: 77,0,66 is the Mavic 3E")
      ->option_text("TYPE,SUBTYPE[,CAMERA]");
  command
      .add_option("--undulation", output.undulation,
                  "How high the mean sea level lies above the ellipsoid there, for heights above the ellipsoid")
      ->option_text("METRES");
  command
      .add_option("--start", output.start,
                  "For .czml: when the flight begins, such as 2026-06-21T16:00Z; else 2026-01-01T00:00Z")
      ->option_text("TIME");
}

FlightOut with_output(FlightOut plan, const PlanOutput& output) {
  if (!output.aircraft.empty()) plan.aircraft = aircraft_of(output.aircraft);
  if (output.undulation) plan.levels.undulation_m = output.undulation;
  if (!output.start.empty()) plan.start_unix_s = unix_time_of(output.start, "command line, --start");
  return plan;
}

}  // namespace vantage::cli
