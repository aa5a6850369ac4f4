// libFuzzer target: any bytes as a table of points; the first says how it is to be read. It may be refused with an
// input error; what is written beside it must be a row for each of its own, or JSON.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/point_table.h"
#include "cli/row_reader.h"
#include "fuzz/bytes.h"
#include "fuzz/files.h"

namespace vantage::fuzzing {
namespace {

struct Written {
  std::string text;
  std::size_t rows = 0;
};

PointAnswer some_answer(std::size_t row) {
  PointAnswer answer;
  answer.inside = row % 2 == 0;
  answer.margin_m = row % 3 == 0 ? std::numeric_limits<double>::infinity() : 0.1 * static_cast<double>(row);
  answer.blocked_by = {"a \"house\", and more", "\x1b[31m"};
  answer.outside_of = {"altitude"};
  return answer;
}

Written answered(const std::filesystem::path& file, const cli::TableOptions& options, bool has_place) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const struct Closing {
    int descriptor;
    ~Closing() { ::close(descriptor); }
  } closing{descriptor};
  cli::RowReader reader(descriptor, "points.csv", [] {});
  Written written;
  std::optional<cli::PointTable> table;
  cli::PointFrame frame{.bounds = {Vec3(-500, -500, 0), Vec3(500, 500, 90)}};
  if (has_place) {
    frame.place = Georeference{48, 11, "", ""};
    frame.zero_m = -520;
    frame.ground.emplace(Ground{1.5});
  }
  for (const std::vector<cli::Row>* rows = &reader.next(); !rows->empty(); rows = &reader.next()) {
    std::size_t first = 0;
    if (!table) {
      table.emplace(reader, rows->front(), options);
      first = table->has_header() ? 1 : 0;
      written.text = table->beginning();
    }
    for (std::size_t i = first; i < rows->size(); ++i) {
      const cli::Row& row = (*rows)[i];
      const Vec3 coordinates = table->coordinates(row);
      require(coordinates.allFinite(), "coordinates are finite");
      require(table->scene_point(coordinates, frame, row).allFinite(), "points are finite");
      (void)table->id(row);
      table->append(written.text, row, coordinates, some_answer(written.rows), 0.5, "target");
      ++written.rows;
    }
  }
  if (table) written.text += table->end();
  return written;
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::fuzzing;
  if (size == 0) return 0;
  const unsigned how = data[0];
  vantage::cli::TableOptions options;
  options.lonlat = how & 1U;
  options.json = how & 2U;
  options.fraction = how & 4U;
  options.target = how & 8U;
  if (how & 16U) options.z = 12.5;
  const auto file = folder().write("points.csv", text_of(data + 1, size - 1));
  try {
    const Written written = answered(file, options, (how & 32U) != 0);
    if (options.json && !written.text.empty()) {
      const auto json = nlohmann::json::parse(written.text, nullptr, false);
      require(json.is_array() && json.size() == written.rows, "what is written is JSON");
    }
  } catch (const vantage::Error& error) {
    check_refusal(error);
  }
  return 0;
}
